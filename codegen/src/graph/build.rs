//! Building a graph: nodes are shared as they are made.

use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::node::{Name, Node, NodeId, Signs, Variable};
use super::{Expr, Graph, Operations};
use crate::lagrangian::{MAX_JOINTS, WHOLE};
use crate::trig::Trig;

/// What a graph begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// An input.
    Input(Variable),
    /// sin q_j of a joint, from 0.
    Sin(usize),
    /// cos q_j.
    Cos(usize),
}

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
            fma: false,
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

    /// The nodes of `graph` once more, with `leaf` in place of its inputs, sines and cosines; folded and shared anew, and
    /// products apart from sums, as another sum may need them. `name` gives the new name of a node from the old one.
    pub fn embed<'g>(
        &'g self,
        graph: &Graph,
        mut leaf: impl FnMut(Leaf) -> Expr<'g>,
        name: impl Fn(&str) -> Option<String>,
    ) -> Vec<Expr<'g>> {
        let mut new: Vec<Expr<'g>> = Vec::with_capacity(graph.nodes.len());
        // A negative constant keeps its sign, so that what it makes keeps its name.
        let product = |new: &[Expr<'g>], a: NodeId, b: NodeId| match (graph.negative(a), graph.negative(b)) {
            (Some(k), _) => new[b].scaled(k),
            (None, Some(k)) => new[a].scaled(k),
            (None, None) => new[a] * new[b],
        };
        for (node, old) in graph.nodes.iter().zip(&graph.names) {
            let value = match *node {
                Node::Input(variable) => leaf(Leaf::Input(variable)),
                Node::Sin(joint) => leaf(Leaf::Sin(joint)),
                Node::Cos(joint) => leaf(Leaf::Cos(joint)),
                Node::Constant(bits) => self.constant(f64::from_bits(bits)),
                Node::Add(a, b) => new[a] + new[b],
                Node::Sub(a, b) => new[a] - new[b],
                Node::Mul(a, b) => product(&new, a, b),
                Node::MulAdd(Signs::Plus, a, b, c) => product(&new, a, b) + new[c],
                Node::MulAdd(Signs::Minus, a, b, c) => product(&new, a, b) - new[c],
                Node::MulAdd(Signs::From, a, b, c) => new[c] - product(&new, a, b),
                Node::Neg(a) => -new[a],
                Node::Abs(a) => new[a].abs(),
                Node::Clamp(a, low, high) => new[a].clamp(new[low], new[high]),
                Node::Select(a, above, below, otherwise) => {
                    new[a].select(new[above], new[below], new[otherwise])
                }
            };
            if let Some(old) = old
                && !value.is_constant()
                && let Some(text) = name(&old.text)
            {
                value.named(&text, old.own_line);
            }
            new.push(value);
        }
        new
    }

    pub(super) fn intern(&self, node: Node) -> Expr<'_> {
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
        Expr::new(self, id)
    }

    pub(super) fn node(&self, id: NodeId) -> Node {
        self.state.borrow().nodes[id]
    }

    /// Names the node, unless it has a name already.
    pub(super) fn name(&self, id: NodeId, text: &str, own_line: bool) {
        let slot = &mut self.state.borrow_mut().names[id];
        if slot.is_none() {
            *slot = Some(Name { text: text.to_string(), own_line });
        }
    }
}
