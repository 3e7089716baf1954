//! Running a graph without compiling it, with the same bits as the generated code.

use super::{Graph, Node, Variable};
use crate::sines::Angle;

impl Graph {
    /// The outputs for given inputs, in the arithmetic of `T`; inputs beyond a slice's end count as 0.
    ///
    /// Every operation is rounded as the generated code rounds it; sines and cosines are those of
    /// [`Graph::sines`].
    pub fn interpret<T: Angle>(&self, q: &[T], qd: &[T], v_r: &[T], a_r: &[T]) -> Vec<T> {
        let read = |slice: &[T], joint: usize| slice.get(joint).copied().unwrap_or(T::ZERO);
        let trig: Vec<(T, T)> = q.iter().map(|&q| q.sin_cos_by(&self.sines)).collect();
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
