//! Derivatives of a graph's outputs, without differences of values.

use super::{Graph, Node, Variable};

impl Graph {
    /// ∂τ_i/∂x of every output i along one rate `x`, at positions `q` (rad or m) and rates `qd`, `v_r`, `a_r`; inputs beyond
    /// a slice's end count as 0.
    ///
    /// The passivity torque is linear in a_r and in v_r, so the slope along a_r,j is column j of D̂ and that along v_r,j
    /// column j of Ĉ: what the emitted code computes with, and no other model. A position has no slope here.
    pub fn slopes(&self, q: &[f64], qd: &[f64], v_r: &[f64], a_r: &[f64], x: Variable) -> Vec<f64> {
        let read = |slice: &[f64], joint: usize| slice.get(joint).copied().unwrap_or(0.0);
        let trig = self.turned(q);
        let mut all: Vec<(f64, f64)> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let pair = match *node {
                Node::Input(variable) => {
                    let value = match variable {
                        Variable::Q(j) => read(q, j),
                        Variable::Qd(j) => read(qd, j),
                        Variable::Vr(j) => read(v_r, j),
                        Variable::Ar(j) => read(a_r, j),
                        _ => 0.0,
                    };
                    (value, if variable == x { 1.0 } else { 0.0 })
                }
                Node::Sin(j) => (trig.get(j).map_or(0.0, |pair| pair.0), 0.0),
                Node::Cos(j) => (trig.get(j).map_or(1.0, |pair| pair.1), 0.0),
                Node::Constant(bits) => (f64::from_bits(bits), 0.0),
                Node::Add(a, b) => (all[a].0 + all[b].0, all[a].1 + all[b].1),
                Node::Sub(a, b) => (all[a].0 - all[b].0, all[a].1 - all[b].1),
                Node::Mul(a, b) => (all[a].0 * all[b].0, all[a].1 * all[b].0 + all[a].0 * all[b].1),
                Node::MulAdd(signs, a, b, c) => {
                    let (first, added) = signs.given(all[a].0, all[c].0);
                    let (first_slope, added_slope) = signs.given(all[a].1, all[c].1);
                    (first * all[b].0 + added, first_slope * all[b].0 + first * all[b].1 + added_slope)
                }
                Node::Neg(a) => (-all[a].0, -all[a].1),
                Node::Abs(a) if all[a].0 < 0.0 => (-all[a].0, -all[a].1),
                Node::Abs(a) => all[a],
                Node::Clamp(a, _, high) if all[a].0 > all[high].0 => all[high],
                Node::Clamp(a, low, _) if all[a].0 < all[low].0 => all[low],
                Node::Clamp(a, ..) => all[a],
                Node::Select(a, above, ..) if all[a].0 > 0.0 => all[above],
                Node::Select(a, _, below, _) if all[a].0 < 0.0 => all[below],
                Node::Select(_, _, _, otherwise) => all[otherwise],
            };
            all.push(pair);
        }
        self.outputs.iter().map(|&output| all[output].1).collect()
    }
}
