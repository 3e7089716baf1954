//! What computing a graph may be off by: running error analysis over intervals.

use super::{Graph, Node, Variable};
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
        Roundings {
            outputs: self.outputs.iter().map(|&output| all[output].error).collect(),
            sign: self.nodes.iter().map(sign).fold(0.0, f64::max),
        }
    }

    fn rounded_nodes(&self, inputs: &impl Inputs, format: Format) -> Vec<Rounded> {
        let sine = if format == Format::SINGLE { self.sines.single_error } else { self.sines.error };
        let turned = |j: usize| {
            // A part of an angle is a power of 2 less: exact.
            let part = self.parts.get(j).map_or(1.0, |&part| 1.0 / f64::from(part.max(1)));
            let (sin, cos) = (inputs.input(Variable::Q(j)) * Interval::point(part)).sin_cos();
            [sin, cos].map(|value| Rounded::within(value, sine, format))
        };
        let mut all: Vec<Rounded> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let number = match *node {
                Node::Input(variable) => Rounded::input(inputs.input(variable), format),
                Node::Sin(j) => turned(j)[0],
                Node::Cos(j) => turned(j)[1],
                Node::Constant(bits) => Rounded::constant(f64::from_bits(bits), format),
                Node::Add(a, b) => all[a] + all[b],
                Node::Sub(a, b) => self.difference(a, b, &all, inputs),
                Node::Mul(a, b) if a == b => all[a].square(),
                Node::Mul(a, b) => all[a] * all[b],
                Node::Neg(a) => -all[a],
                Node::Abs(a) => all[a].abs(),
                Node::Clamp(a, low, high) => all[a].clamp(all[low], all[high]),
                Node::Select(a, above, below, otherwise) => {
                    all[a].select(all[above], all[below], all[otherwise])
                }
            };
            all.push(number);
        }
        all
    }

    /// q − q_d is as small as the error, however large q and q_d are.
    fn difference(&self, a: usize, b: usize, all: &[Rounded], inputs: &impl Inputs) -> Rounded {
        let known = match (self.nodes[a], self.nodes[b]) {
            (Node::Input(measured), Node::Input(desired)) if measured.desired() == Some(desired) => {
                inputs.error(measured)
            }
            _ => None,
        };
        known.map_or_else(|| all[a] - all[b], |value| all[a].less(all[b], value))
    }
}

impl Variable {
    /// The desired value of a measured input; `None` for the other inputs.
    fn desired(self) -> Option<Self> {
        match self {
            Self::Q(j) => Some(Self::DesiredQ(j)),
            Self::Qd(j) => Some(Self::DesiredQd(j)),
            _ => None,
        }
    }
}
