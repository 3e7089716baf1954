//! How large the values of a graph may become, and how often they are rounded.

use super::{Graph, Node, Variable};

/// A value that is at most `size` with every sum taken over absolute values, after `roundings` in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Magnitude {
    /// Bound on the absolute value. The rounding of the value is at most γ_k of it, k = `roundings`.
    pub size: f64,
    /// Roundings along the longest way to the value.
    pub roundings: u32,
}

/// A sine or cosine errs by an ulp.
const TRIG_ROUNDINGS: u32 = 2;

impl Graph {
    /// Of the outputs, for inputs up to the given magnitudes; missing ones count as 0.
    pub fn magnitudes(&self, q: &[f64], qd: &[f64], v_r: &[f64], a_r: &[f64]) -> Vec<Magnitude> {
        let read = |slice: &[f64], joint: usize| Magnitude {
            size: slice.get(joint).copied().unwrap_or(0.0).abs(),
            roundings: 0,
        };
        let mut values: Vec<Magnitude> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match *node {
                Node::Input(Variable::Q(j)) => read(q, j),
                Node::Input(Variable::Qd(j)) => read(qd, j),
                Node::Input(Variable::Vr(j)) => read(v_r, j),
                Node::Input(Variable::Ar(j)) => read(a_r, j),
                Node::Sin(_) | Node::Cos(_) => Magnitude { size: 1.0, roundings: TRIG_ROUNDINGS },
                Node::Constant(bits) => Magnitude { size: f64::from_bits(bits).abs(), roundings: 0 },
                Node::Add(a, b) | Node::Sub(a, b) => sum(values[a], values[b]),
                Node::Mul(a, b) => product(values[a], values[b]),
                Node::Neg(a) => values[a],
            };
            values.push(value);
        }
        self.outputs.iter().map(|&output| values[output]).collect()
    }
}

/// What is zero is not rounded.
fn sum(a: Magnitude, b: Magnitude) -> Magnitude {
    match (a.size == 0.0, b.size == 0.0) {
        (true, _) => b,
        (_, true) => a,
        _ => Magnitude { size: (a.size + b.size).next_up(), roundings: a.roundings.max(b.roundings) + 1 },
    }
}

fn product(a: Magnitude, b: Magnitude) -> Magnitude {
    if a.size == 0.0 || b.size == 0.0 {
        return Magnitude::default();
    }
    Magnitude { size: (a.size * b.size).next_up(), roundings: a.roundings + b.roundings + 1 }
}
