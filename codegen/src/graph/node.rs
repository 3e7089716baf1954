//! Nodes of the graph.

use std::ops::Neg;

use serde::{Deserialize, Serialize};

/// Index of a node in its graph.
pub type NodeId = usize;

/// An input of the passivity torque, or of a whole control step; joints from 0.
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
    /// Desired position q_d,j, rad or m.
    DesiredQ(usize),
    /// Desired velocity q̇_d,j.
    DesiredQd(usize),
    /// Desired acceleration q̈_d,j.
    DesiredQdd(usize),
    /// What a law has learnt of parameter k, θ̂_k.
    Theta(usize),
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
    /// a · b and c in one operation, rounded once.
    MulAdd(Signs, NodeId, NodeId, NodeId),
    /// −a.
    Neg(NodeId),
    /// |a|.
    Abs(NodeId),
    /// a, no less than the second and no more than the third; NaN stays NaN.
    Clamp(NodeId, NodeId, NodeId),
    /// Chosen by the sign of the first: the second where it is above 0, the third where it is below, and the fourth where it
    /// is 0 or NaN.
    Select(NodeId, NodeId, NodeId, NodeId),
}

/// The signs of a product and what is added to it. A number is negated without an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Signs {
    /// a · b + c.
    Plus,
    /// a · b − c.
    Minus,
    /// c − a · b.
    From,
}

impl Signs {
    /// `a` and `c` with their signs, so that the operation is a · b + c.
    pub fn given<T: Neg<Output = T>>(self, a: T, c: T) -> (T, T) {
        match self {
            Self::Plus => (a, c),
            Self::Minus => (a, -c),
            Self::From => (-a, c),
        }
    }
}

impl Node {
    /// The operands, none to four.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> + use<> {
        let operands = match *self {
            Node::Add(a, b) | Node::Sub(a, b) | Node::Mul(a, b) => [Some(a), Some(b), None, None],
            Node::Neg(a) | Node::Abs(a) => [Some(a), None, None, None],
            Node::MulAdd(_, a, b, c) => [Some(a), Some(b), Some(c), None],
            Node::Clamp(a, low, high) => [Some(a), Some(low), Some(high), None],
            Node::Select(a, above, below, otherwise) => [Some(a), Some(above), Some(below), Some(otherwise)],
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => [None; 4],
        };
        operands.into_iter().flatten()
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
            Node::MulAdd(signs, a, b, c) => Node::MulAdd(signs, new(a), new(b), new(c)),
            Node::Neg(a) => Node::Neg(new(a)),
            Node::Abs(a) => Node::Abs(new(a)),
            Node::Clamp(a, low, high) => Node::Clamp(new(a), new(low), new(high)),
            Node::Select(a, above, below, otherwise) => {
                Node::Select(new(a), new(above), new(below), new(otherwise))
            }
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
