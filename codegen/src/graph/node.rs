//! Nodes of the graph.

use serde::{Deserialize, Serialize};

/// Index of a node in its graph.
pub type NodeId = usize;

/// An input of the passivity torque; joints from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Variable {
    /// Joint position q_j, rad or m.
    Q(usize),
    /// Joint velocity q̇_j.
    Qd(usize),
    /// Reference velocity v_r,j.
    Vr(usize),
    /// Reference acceleration a_r,j.
    Ar(usize),
}

/// One operation or leaf. Constants are kept by their bits, so that nodes can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Node {
    /// An input.
    Input(Variable),
    /// sin q_j, or that of a part of q_j: [`super::Graph::parts`].
    Sin(usize),
    /// cos q_j, likewise.
    Cos(usize),
    /// A finite constant, by its bits.
    Constant(u64),
    /// a + b.
    Add(NodeId, NodeId),
    /// a − b.
    Sub(NodeId, NodeId),
    /// a · b.
    Mul(NodeId, NodeId),
    /// −a.
    Neg(NodeId),
}

impl Node {
    /// The operands, none to two.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> + use<> {
        let (first, second) = match *self {
            Node::Add(a, b) | Node::Sub(a, b) | Node::Mul(a, b) => (Some(a), Some(b)),
            Node::Neg(a) => (Some(a), None),
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => (None, None),
        };
        first.into_iter().chain(second)
    }

    /// False for a constant that is no finite number.
    pub(super) fn is_finite(&self) -> bool {
        match *self {
            Node::Constant(bits) => f64::from_bits(bits).is_finite(),
            _ => true,
        }
    }

    /// The same node over renumbered operands.
    pub(super) fn renumbered(self, new: impl Fn(NodeId) -> NodeId) -> Self {
        match self {
            Node::Add(a, b) => Node::Add(new(a), new(b)),
            Node::Sub(a, b) => Node::Sub(new(a), new(b)),
            Node::Mul(a, b) => Node::Mul(new(a), new(b)),
            Node::Neg(a) => Node::Neg(new(a)),
            leaf => leaf,
        }
    }
}

/// The name of a node in generated code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Name {
    /// An identifier.
    pub text: String,
    /// True where the node gets a line of its own even if it is used once.
    pub own_line: bool,
}
