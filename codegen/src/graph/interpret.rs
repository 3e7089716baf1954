//! Running a graph without compiling it, with the same bits as the generated code.

use gramforge_runtime::step;

use super::{Graph, Node, Variable};
use crate::trig::{Angle, Trig};

impl Graph {
    /// Sine and cosine of each joint's angle, or of the part of it that the graph takes them of.
    pub(super) fn turned<T: Angle>(&self, q: &[T]) -> Vec<(T, T)> {
        turned(q, &self.parts, &self.sines)
    }

    /// The outputs for given inputs, in the arithmetic of `T`; inputs beyond a slice's end count as 0.
    ///
    /// Every operation is rounded as the generated code rounds it; sines and cosines are those of
    /// [`Graph::sines`].
    pub fn interpret<T: Angle>(&self, q: &[T], qd: &[T], v_r: &[T], a_r: &[T]) -> Vec<T> {
        self.evaluate(q, |variable| of_model(variable, q, qd, v_r, a_r))
    }

    /// The outputs of a control step, likewise; `desired` are q_d, q̇_d and q̈_d, `theta` what the law has learnt.
    pub fn interpret_step<T: Angle>(&self, q: &[T], qd: &[T], desired: [&[T]; 3], theta: &[T]) -> Vec<T> {
        self.evaluate(q, |variable| of_step(variable, q, qd, desired, theta))
    }

    fn evaluate<'a, T: Angle>(&self, q: &[T], read: impl Fn(Variable) -> Option<&'a T>) -> Vec<T> {
        let trig = self.turned(q);
        let mut values: Vec<T> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match *node {
                Node::Input(variable) => read(variable).copied().unwrap_or(T::ZERO),
                Node::Sin(j) => trig.get(j).map_or(T::ZERO, |pair| pair.0),
                Node::Cos(j) => trig.get(j).map_or(T::ONE, |pair| pair.1),
                Node::Constant(bits) => T::from_f64(f64::from_bits(bits)),
                Node::Add(a, b) => values[a] + values[b],
                Node::Sub(a, b) => values[a] - values[b],
                Node::Mul(a, b) => values[a] * values[b],
                Node::MulAdd(signs, a, b, c) => {
                    let (first, added) = signs.given(values[a], values[c]);
                    first.mul_add(values[b], added)
                }
                Node::Neg(a) => -values[a],
                Node::Abs(a) => values[a].abs(),
                Node::Clamp(a, low, high) => step::clamp(values[a], values[low], values[high]),
                Node::Select(a, above, below, otherwise) => {
                    step::select(values[a], values[above], values[below], values[otherwise])
                }
            };
            values.push(value);
        }
        self.outputs.iter().map(|&output| values[output]).collect()
    }
}

/// Sine and cosine of each joint's angle, or of the part of it that `parts` says.
pub(super) fn turned<T: Angle>(q: &[T], parts: &[u8], sines: &Trig) -> Vec<(T, T)> {
    let part = |(j, &q): (usize, &T)| match parts.get(j) {
        Some(&part) if part != 1 => q * T::from_f64(1.0 / f64::from(part)),
        _ => q,
    };
    q.iter().enumerate().map(part).map(|q| q.sin_cos_by(sines)).collect()
}

/// An input of the passivity torque.
pub(super) fn of_model<'a, T>(
    variable: Variable,
    q: &'a [T],
    qd: &'a [T],
    v_r: &'a [T],
    a_r: &'a [T],
) -> Option<&'a T> {
    match variable {
        Variable::Q(j) => q.get(j),
        Variable::Qd(j) => qd.get(j),
        Variable::Vr(j) => v_r.get(j),
        Variable::Ar(j) => a_r.get(j),
        _ => None,
    }
}

/// An input of a control step.
pub(super) fn of_step<'a, T>(
    variable: Variable,
    q: &'a [T],
    qd: &'a [T],
    [q_d, qd_d, qdd_d]: [&'a [T]; 3],
    theta: &'a [T],
) -> Option<&'a T> {
    match variable {
        Variable::Q(j) => q.get(j),
        Variable::Qd(j) => qd.get(j),
        Variable::DesiredQ(j) => q_d.get(j),
        Variable::DesiredQd(j) => qd_d.get(j),
        Variable::DesiredQdd(j) => qdd_d.get(j),
        Variable::Theta(k) => theta.get(k),
        Variable::Vr(_) | Variable::Ar(_) => None,
    }
}
