//! Building: operators on handles; folding and sharing happen as nodes are made.

use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::{Add, Mul, Neg, Sub};

use super::node::{Name, Node, NodeId, Variable};
use super::{Graph, Operations};
use crate::dynamics::Scalar;
use crate::lagrangian::{MAX_JOINTS, WHOLE};
use crate::trig::Trig;

/// Collects the nodes of a graph under construction.
#[derive(Debug, Default)]
pub struct Builder {
    state: RefCell<State>,
}

#[derive(Debug, Default)]
struct State {
    nodes: Vec<Node>,
    names: Vec<Option<Name>>,
    parts: Option<[u8; MAX_JOINTS]>,
    // Only looked up, never iterated: its order cannot reach the output.
    known: HashMap<Node, NodeId, BuildHasherDefault<Mixer>>,
    /// For counting.
    seen: Vec<bool>,
}

/// Multiply and rotate: nodes are small, many, and no adversary chooses them.
#[derive(Debug, Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u64(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(5) ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_usize(&mut self, x: usize) {
        self.write_u64(x as u64);
    }

    fn write_isize(&mut self, x: isize) {
        self.write_u64(x as u64);
    }
}

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

impl Builder {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// An input.
    pub fn input(&self, variable: Variable) -> Expr<'_> {
        self.intern(Node::Input(variable))
    }

    /// Lets [`Builder::sin_cos`] stand for sines of q_j / part_j.
    pub fn divide(&self, parts: [u8; MAX_JOINTS]) {
        self.state.borrow_mut().parts = Some(parts);
    }

    /// (sin q_j, cos q_j); of the part of q_j that [`Builder::divide`] names.
    pub fn sin_cos(&self, joint: usize) -> (Expr<'_>, Expr<'_>) {
        (self.intern(Node::Sin(joint)), self.intern(Node::Cos(joint)))
    }

    /// A constant; −0 becomes 0.
    pub fn constant(&self, x: f64) -> Expr<'_> {
        self.intern(Node::Constant((x + 0.0).to_bits()))
    }

    /// The graph of `outputs`, without what they do not need.
    pub fn finish(self, outputs: &[NodeId]) -> Graph {
        let State { nodes, names, parts, .. } = self.state.into_inner();
        let mut needed = vec![false; nodes.len()];
        for &output in outputs {
            needed[output] = true;
        }
        // Operands come before their users, so one pass from the end reaches them all.
        for id in (0..nodes.len()).rev() {
            if needed[id] {
                nodes[id].operands().for_each(|operand| needed[operand] = true);
            }
        }
        let mut new = vec![0; nodes.len()];
        let mut graph = Graph {
            nodes: Vec::new(),
            names: Vec::new(),
            outputs: Vec::new(),
            sines: Trig::default(),
            parts: parts.unwrap_or(WHOLE),
        };
        for (id, (node, name)) in nodes.into_iter().zip(names).enumerate() {
            if needed[id] {
                new[id] = graph.nodes.len();
                graph.nodes.push(node.renumbered(|operand| new[operand]));
                graph.names.push(name);
            }
        }
        graph.outputs = outputs.iter().map(|&output| new[output]).collect();
        graph
    }

    /// Number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.state.borrow().nodes.len()
    }

    /// Forgets all but the first `len` nodes; whoever has a handle on another must not use it again.
    pub(crate) fn truncate(&self, len: usize) {
        let State { nodes, names, known, .. } = &mut *self.state.borrow_mut();
        nodes.drain(len.min(nodes.len())..).for_each(|node| {
            known.remove(&node);
        });
        names.truncate(len);
    }

    /// What [`Graph::operations`] of the finished graph of `outputs` would be; `None` where it would not be finite.
    pub(crate) fn operations(&self, outputs: impl Iterator<Item = NodeId>) -> Option<Operations> {
        let State { nodes, seen, parts, .. } = &mut *self.state.borrow_mut();
        seen.clear();
        seen.resize(nodes.len(), false);
        let mut needed: Vec<NodeId> = Vec::with_capacity(nodes.len());
        let mut need = |id: NodeId, needed: &mut Vec<NodeId>| {
            if !std::mem::replace(&mut seen[id], true) {
                needed.push(id);
            }
        };
        outputs.for_each(|id| need(id, &mut needed));
        let mut next = 0;
        while let Some(&id) = needed.get(next) {
            nodes[id].operands().for_each(|operand| need(operand, &mut needed));
            next += 1;
        }
        let all = || needed.iter().map(|&id| &nodes[id]);
        all().all(Node::is_finite).then(|| Operations::of(all(), &parts.unwrap_or(WHOLE)))
    }

    fn intern(&self, node: Node) -> Expr<'_> {
        let mut state = self.state.borrow_mut();
        let id = match state.known.get(&node) {
            Some(&id) => id,
            None => {
                let id = state.nodes.len();
                state.nodes.push(node);
                state.names.push(None);
                state.known.insert(node, id);
                id
            }
        };
        Expr { builder: self, id }
    }

    fn node(&self, id: NodeId) -> Node {
        self.state.borrow().nodes[id]
    }
}

impl<'g> Expr<'g> {
    /// Index of the node, for [`Builder::finish`].
    pub fn id(self) -> NodeId {
        self.id
    }

    /// Names the node, unless it has a name already.
    pub fn named(self, text: &str, own_line: bool) -> Self {
        let mut state = self.builder.state.borrow_mut();
        let slot = &mut state.names[self.id];
        if slot.is_none() {
            *slot = Some(Name { text: text.to_string(), own_line });
        }
        drop(state);
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

    /// True for a constant.
    pub fn is_constant(self) -> bool {
        self.value().is_some()
    }

    fn node(self) -> Node {
        self.builder.node(self.id)
    }

    fn value(self) -> Option<f64> {
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
