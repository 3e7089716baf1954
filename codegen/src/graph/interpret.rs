//! Running a graph without compiling it, with the same bits as the generated code.

use super::{Graph, Node, Variable};
use crate::trig::Angle;

impl Graph {
    /// Sine and cosine of each joint's angle, or of the part of it that the graph takes them of.
    pub(super) fn turned<T: Angle>(&self, q: &[T]) -> Vec<(T, T)> {
        let part = |(j, &q): (usize, &T)| match self.parts.get(j) {
            Some(&part) if part != 1 => q * T::from_f64(1.0 / f64::from(part)),
            _ => q,
        };
        q.iter().enumerate().map(part).map(|q| q.sin_cos_by(&self.sines)).collect()
    }

    /// The outputs for given inputs, in the arithmetic of `T`; inputs beyond a slice's end count as 0.
    ///
    /// Every operation is rounded as the generated code rounds it; sines and cosines are those of
    /// [`Graph::sines`].
    pub fn interpret<T: Angle>(&self, q: &[T], qd: &[T], v_r: &[T], a_r: &[T]) -> Vec<T> {
        let read = |slice: &[T], joint: usize| slice.get(joint).copied().unwrap_or(T::ZERO);
        let trig = self.turned(q);
        let mut values: Vec<T> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match *node {
                Node::Input(Variable::Q(j)) => read(q, j),
                Node::Input(Variable::Qd(j)) => read(qd, j),
                Node::Input(Variable::Vr(j)) => read(v_r, j),
                Node::Input(Variable::Ar(j)) => read(a_r, j),
                Node::Sin(j) => trig.get(j).map_or(T::ZERO, |pair| pair.0),
                Node::Cos(j) => trig.get(j).map_or(T::ONE, |pair| pair.1),
                Node::Constant(bits) => T::from_f64(f64::from_bits(bits)),
                Node::Add(a, b) => values[a] + values[b],
                Node::Sub(a, b) => values[a] - values[b],
                Node::Mul(a, b) => values[a] * values[b],
                Node::Neg(a) => -values[a],
            };
            values.push(value);
        }
        self.outputs.iter().map(|&output| values[output]).collect()
    }
}
