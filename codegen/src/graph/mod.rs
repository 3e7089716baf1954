//! Straight-line expression graph: built with ordinary operators, folded and shared on the way, factored,
//! counted, interpreted.

mod build;
mod count;
mod expr;
mod factor;
mod fused;
mod interpret;
mod inverse;
mod node;
mod rounding;
mod sensitivity;
mod slopes;
mod tape;
#[cfg(test)]
mod tests;

pub use build::{Builder, Leaf};
pub use count::{Operations, TRIG_PAIR};
pub use expr::Expr;
pub use node::{Name, Node, NodeId, Signs, Variable};
pub use rounding::Inputs;
use serde::{Deserialize, Serialize};
pub use tape::Tape;

use crate::lagrangian::MAX_JOINTS;
use crate::trig::Trig;

/// A finished graph.
///
/// Holds: operands come before the nodes that use them; no two nodes are equal; no node is a constant
/// expression, a sum with 0, a product with 0, 1 or −1, or a double negation; every node is reachable
/// from an output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    /// The nodes in order of evaluation.
    pub nodes: Vec<Node>,
    /// Names of nodes, parallel to `nodes`.
    pub names: Vec<Option<Name>>,
    /// The results, in the order the caller gave them.
    pub outputs: Vec<NodeId>,
    /// How sines and cosines are taken; the builder leaves the default.
    #[serde(skip)]
    pub sines: Trig,
    /// By joint the power of 2 by which its angle is divided before its sine and cosine are taken; mostly 1.
    pub parts: [u8; MAX_JOINTS],
    /// True where products are computed together with the sums that they stand in: [`Graph::fused`].
    pub fma: bool,
}

impl Graph {
    /// The number, of a negative constant.
    fn negative(&self, id: NodeId) -> Option<f64> {
        match self.nodes[id] {
            Node::Constant(bits) => Some(f64::from_bits(bits)).filter(|x| *x < 0.0),
            _ => None,
        }
    }
}
