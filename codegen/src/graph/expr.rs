//! Handles on nodes: operators fold constants, signs and zeros before a node is made.

use std::ops::{Add, Mul, Neg, Sub};

use super::Builder;
use super::node::{Node, NodeId};
use crate::dynamics::Scalar;

/// Handles of one graph are equal where they stand for the same node.
impl PartialEq for Expr<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

/// A handle on a node: copy it, add it, multiply it.
#[derive(Clone, Copy, Debug)]
pub struct Expr<'g> {
    builder: &'g Builder,
    id: NodeId,
}

impl<'g> Expr<'g> {
    pub(super) fn new(builder: &'g Builder, id: NodeId) -> Self {
        Self { builder, id }
    }

    /// Index of the node, for [`Builder::finish`].
    pub fn id(self) -> NodeId {
        self.id
    }

    /// Names the node, unless it has a name already; of a negation also what is negated.
    pub fn named(self, text: &str, own_line: bool) -> Self {
        self.builder.name(self.id, text, own_line);
        // Sums use what is negated, and subtract it.
        if let Some(positive) = self.negated() {
            let minus = text.strip_prefix("minus_").map_or(format!("minus_{text}"), str::to_string);
            self.builder.name(positive.id, &minus, own_line);
        }
        self
    }

    /// k·x with the sign of `k` left in the constant, where `k * x` would take it out to share |k|·x.
    pub fn scaled(self, k: f64) -> Self {
        if self.is_constant() || k == 0.0 || k.abs() == 1.0 {
            return self * self.constant(k);
        }
        let (a, b) = ordered(self.constant(k).id, self.id);
        self.make(Node::Mul(a, b))
    }

    /// |x|.
    pub fn abs(self) -> Self {
        match (self.value(), self.node()) {
            (Some(x), _) => self.constant(x.abs()),
            // The sign goes; and |x| has none.
            (None, Node::Neg(id)) => Expr { id, ..self }.abs(),
            (None, Node::Abs(_)) => self,
            _ => self.make(Node::Abs(self.id)),
        }
    }

    /// The number, no less than `low` and no more than `high`; NaN stays NaN.
    pub fn clamp(self, low: Self, high: Self) -> Self {
        match (self.value(), low.value(), high.value()) {
            (Some(x), Some(low), Some(_)) if x < low => self.constant(low),
            (Some(x), Some(_), Some(high)) if x > high => self.constant(high),
            (Some(_), Some(_), Some(_)) => self,
            _ => self.make(Node::Clamp(self.id, low.id, high.id)),
        }
    }

    /// `above` where the number is above 0, `below` where it is below, `otherwise` where it is 0 or NaN.
    pub fn select(self, above: Self, below: Self, otherwise: Self) -> Self {
        match self.value() {
            Some(x) if x > 0.0 => above,
            Some(x) if x < 0.0 => below,
            Some(_) => otherwise,
            None if above == below && below == otherwise => above,
            None => self.make(Node::Select(self.id, above.id, below.id, otherwise.id)),
        }
    }

    /// True for a constant.
    pub fn is_constant(self) -> bool {
        self.value().is_some()
    }

    fn node(self) -> Node {
        self.builder.node(self.id)
    }

    /// The number, of a constant.
    pub fn value(self) -> Option<f64> {
        match self.node() {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The operand of a negation.
    fn negated(self) -> Option<Self> {
        match self.node() {
            Node::Neg(id) => Some(Expr { id, ..self }),
            _ => None,
        }
    }

    fn make(self, node: Node) -> Self {
        self.builder.intern(node)
    }
}

/// `a + b` and `a · b` round alike in either order, so the smaller index goes first and both orders share.
fn ordered(a: NodeId, b: NodeId) -> (NodeId, NodeId) {
    (a.min(b), a.max(b))
}

impl Add for Expr<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        match (self.value(), other.value()) {
            (Some(a), Some(b)) => return self.constant(a + b),
            (Some(0.0), None) => return other,
            (None, Some(0.0)) => return self,
            (Some(a), None) if a < 0.0 => return other - self.constant(-a),
            (None, Some(b)) if b < 0.0 => return self - self.constant(-b),
            _ => {}
        }
        match (self.negated(), other.negated()) {
            (Some(a), Some(b)) => -(a + b),
            (Some(a), None) => other - a,
            (None, Some(b)) => self - b,
            (None, None) => {
                let (a, b) = ordered(self.id, other.id);
                self.make(Node::Add(a, b))
            }
        }
    }
}

impl Sub for Expr<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        if self.id == other.id {
            return self.constant(0.0);
        }
        match (self.value(), other.value()) {
            (Some(a), Some(b)) => return self.constant(a - b),
            (Some(0.0), None) => return -other,
            (None, Some(0.0)) => return self,
            (None, Some(b)) if b < 0.0 => return self + self.constant(-b),
            _ => {}
        }
        match (self.negated(), other.negated()) {
            (Some(a), Some(b)) => b - a,
            (Some(a), None) => -(a + other),
            (None, Some(b)) => self + b,
            (None, None) => self.make(Node::Sub(self.id, other.id)),
        }
    }
}

impl Mul for Expr<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match (self.value(), other.value()) {
            (Some(a), Some(b)) => return self.constant(a * b),
            (Some(_), None) => return other * self,
            (None, Some(c)) => {
                if c == 0.0 {
                    return other;
                } else if c == 1.0 {
                    return self;
                } else if c < 0.0 {
                    // Positive constants alone, so that c·x and −c·x share.
                    return -(self * self.constant(-c));
                }
            }
            (None, None) => {}
        }
        match (self.negated(), other.negated()) {
            (Some(a), Some(b)) => a * b,
            (Some(a), None) => -(a * other),
            (None, Some(b)) => -(self * b),
            (None, None) => {
                let (a, b) = ordered(self.id, other.id);
                self.make(Node::Mul(a, b))
            }
        }
    }
}

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        if let Some(x) = self.value() {
            return self.constant(-x);
        }
        match self.node() {
            Node::Neg(id) => Expr { id, ..self },
            // −(a − b) is b − a to the last bit.
            Node::Sub(a, b) => self.make(Node::Sub(b, a)),
            _ => self.make(Node::Neg(self.id)),
        }
    }
}

impl Scalar for Expr<'_> {
    fn constant(self, x: f64) -> Self {
        self.builder.constant(x)
    }
}
