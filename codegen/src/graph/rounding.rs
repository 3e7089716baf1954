//! What computing a graph may be off by: running error analysis over intervals.

use super::{Graph, Node, Variable};
use crate::lagrangian::MAX_JOINTS;
use crate::numerics::affine::{Affine, UNKNOWNS};
use crate::numerics::interval::Interval;
use crate::numerics::rounded::{Format, Rounded};

/// Where the inputs of a graph lie. Every input is a number of the format.
pub trait Inputs {
    /// The interval of one input.
    fn input(&self, variable: Variable) -> Interval;

    /// The interval of a measured input less the desired one of the same joint, where it is known better than from the two.
    fn error(&self, measured: Variable) -> Option<Interval>;
}

/// What the outputs of a graph round by.
#[derive(Clone, Debug, PartialEq)]
pub struct Roundings {
    /// Bound by output on |computed − exact|; infinite or NaN where there is none. Where a choice by a sign is made for the number
    /// of the other sign, that choice is not counted.
    pub outputs: Vec<f64>,
    /// A number by whose sign something is chosen has the wrong sign only where it is no larger than this; 0 where every sign is
    /// right.
    pub sign: f64,
}

impl Graph {
    /// What the code rounds by in `format` where the inputs lie in `inputs`. The exact output is that of the graph in real
    /// numbers, with its constants as they are in f64.
    pub fn rounding(&self, inputs: &impl Inputs, format: Format) -> Roundings {
        let all = self.rounded_nodes(inputs, format);
        let sign = |node: &Node| match *node {
            Node::Select(by, ..) if all[by].sign_may_change() => all[by].error,
            _ => 0.0,
        };
        // In f64 the errors are so small that the first bound is enough.
        let bound = |&output: &usize| match format == Format::SINGLE {
            true => less(self.by_slopes(&all, output), all[output].error),
            false => all[output].error,
        };
        Roundings {
            outputs: self.outputs.iter().map(bound).collect(),
            sign: self.nodes.iter().map(sign).fold(0.0, f64::max),
        }
    }

    pub(super) fn rounded_nodes(&self, inputs: &impl Inputs, format: Format) -> Vec<Rounded> {
        let sine = if format == Format::SINGLE { self.sines.single_error } else { self.sines.error };
        let turned = |j: usize| {
            // A part of an angle is a power of 2 less: exact.
            let part = self.parts.get(j).map_or(1.0, |&part| 1.0 / f64::from(part.max(1)));
            let (sin, cos) = (inputs.input(Variable::Q(j)) * Interval::point(part)).sin_cos();
            [sin, cos].map(|value| Rounded::within(value, sine, format))
        };
        let mut all: Vec<Rounded> = Vec::with_capacity(self.nodes.len());
        let mut forms: Vec<Affine> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let alone = |number: Rounded| (number, Affine::alone(number.value));
            // A sum or a product lies in its interval and in the range of its form.
            let sum = |a: usize, b: usize, interval: Interval, form: Affine| {
                (all[a].sum(all[b], interval.meet(form.range())), form)
            };
            let product = |a: usize, b: usize| {
                let form = forms[a].times(&forms[b]);
                let Interval { low, high } = all[a].value * all[b].value;
                // A square is not negative.
                let low = if a == b { low.max(0.0) } else { low };
                (Interval { low, high }.meet(form.range()), form)
            };
            let (number, form) = match *node {
                Node::Input(variable) => {
                    (Rounded::input(inputs.input(variable), format), unknown(inputs, variable))
                }
                Node::Add(a, b) => sum(a, b, all[a].value + all[b].value, forms[a].plus(&forms[b])),
                Node::Sub(a, b) => sum(a, b, all[a].value - all[b].value, forms[a].plus(&forms[b].minus())),
                Node::Mul(a, b) => {
                    let (value, form) = product(a, b);
                    (all[a].product(all[b], value), form)
                }
                Node::MulAdd(signs, a, b, c) => {
                    let (value, form) = product(a, b);
                    let (value, added) = signs.given(value, all[c].value);
                    let (form, added_form) = signs.given(form, forms[c]);
                    let form = form.plus(&added_form);
                    (all[a].mul_add(all[b], all[c], (value + added).meet(form.range())), form)
                }
                Node::Neg(a) => (-all[a], forms[a].minus()),
                Node::Sin(j) => alone(turned(j)[0]),
                Node::Cos(j) => alone(turned(j)[1]),
                Node::Constant(bits) => alone(Rounded::constant(f64::from_bits(bits), format)),
                Node::Abs(a) => alone(all[a].abs()),
                Node::Clamp(a, low, high) => alone(all[a].clamp(all[low], all[high])),
                Node::Select(a, above, below, otherwise) => {
                    alone(all[a].select(all[above], all[below], all[otherwise]))
                }
            };
            forms.push(form);
            all.push(number);
        }
        all
    }
}

/// The smaller bound; `second` where the first is NaN.
fn less(first: f64, second: f64) -> f64 {
    if first < second { first } else { second }
}

/// An input as a sum of unknowns: a measured one is the desired one and its error.
fn unknown(inputs: &impl Inputs, variable: Variable) -> Affine {
    let place = |kind: usize, j: usize| if j < MAX_JOINTS { kind * MAX_JOINTS + j } else { UNKNOWNS };
    let (error, desired) = match variable {
        Variable::Q(j) => (place(0, j), Some(Variable::DesiredQ(j))),
        Variable::Qd(j) => (place(1, j), Some(Variable::DesiredQd(j))),
        Variable::DesiredQ(j) => (place(2, j), None),
        Variable::DesiredQd(j) => (place(3, j), None),
        Variable::DesiredQdd(j) | Variable::Ar(j) => (place(4, j), None),
        Variable::Vr(j) => (place(5, j), None),
        // There may be many of them.
        Variable::Theta(_) => (UNKNOWNS, None),
    };
    match (inputs.error(variable), desired) {
        (Some(range), Some(desired)) => Affine::unknown(range, error).plus(&unknown(inputs, desired)),
        _ => Affine::unknown(inputs.input(variable), error),
    }
}
