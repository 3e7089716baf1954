//! A graph made ready to be interpreted many times: the same bits as [`Graph::interpret`], several times as fast.
//!
//! Nodes stand in groups of one kind whose operands all lie in earlier groups, so that the machine need not guess the
//! kind of each.

use gramforge_runtime::step;

use super::{Graph, Node, NodeId, Signs, Variable};
use crate::lagrangian::MAX_JOINTS;
use crate::trig::{Angle, Trig};

/// A graph in groups of nodes of one kind.
#[derive(Clone, Debug)]
pub struct Tape<T> {
    /// A value for each node: those of the constants, and zeros.
    values: Vec<T>,
    /// How many of them are leaves, which come first.
    leaves: usize,
    inputs: Vec<(usize, Variable)>,
    /// Sines, and cosines, by joint.
    sines: Vec<(usize, usize)>,
    cosines: Vec<(usize, usize)>,
    /// In order of evaluation; the values of a group begin where those of the one before end.
    groups: Vec<Group>,
    outputs: Vec<usize>,
    trig: Trig,
    parts: [u8; MAX_JOINTS],
}

#[derive(Clone, Debug)]
struct Group {
    kind: Kind,
    /// Places of the first two operands; an unused one is 0.
    operands: Vec<[u32; 2]>,
    /// Those of the third and the fourth, for kinds that have more than two.
    more: Vec<[u32; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Add,
    Sub,
    Mul,
    /// With the signs of the operation.
    MulAdd(Signs),
    Neg,
    Abs,
    Clamp,
    Select,
}

const KINDS: [Kind; 10] = [
    Kind::Add,
    Kind::Sub,
    Kind::Mul,
    Kind::MulAdd(Signs::Plus),
    Kind::MulAdd(Signs::Minus),
    Kind::MulAdd(Signs::From),
    Kind::Neg,
    Kind::Abs,
    Kind::Clamp,
    Kind::Select,
];

impl Kind {
    /// `None` for a leaf.
    fn of(node: &Node) -> Option<Self> {
        Some(match node {
            Node::Add(..) => Self::Add,
            Node::Sub(..) => Self::Sub,
            Node::Mul(..) => Self::Mul,
            Node::MulAdd(signs, ..) => Self::MulAdd(*signs),
            Node::Neg(_) => Self::Neg,
            Node::Abs(_) => Self::Abs,
            Node::Clamp(..) => Self::Clamp,
            Node::Select(..) => Self::Select,
            Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => return None,
        })
    }

    /// Where it stands in [`KINDS`].
    fn place(self) -> usize {
        KINDS.iter().position(|&kind| kind == self).unwrap_or(0)
    }
}

impl<T: Angle> Tape<T> {
    /// Makes `graph` ready.
    pub fn new(graph: &Graph) -> Self {
        let mut out = Self {
            values: Vec::with_capacity(graph.nodes.len()),
            leaves: 0,
            inputs: Vec::new(),
            sines: Vec::new(),
            cosines: Vec::new(),
            groups: Vec::new(),
            outputs: Vec::new(),
            trig: graph.sines.clone(),
            parts: graph.parts,
        };
        let mut places = vec![usize::MAX; graph.nodes.len()];
        for (id, node) in graph.nodes.iter().enumerate() {
            let place = out.values.len();
            let value = match *node {
                Node::Constant(bits) => T::from_f64(f64::from_bits(bits)),
                Node::Input(variable) => {
                    out.inputs.push((place, variable));
                    T::ZERO
                }
                Node::Sin(joint) => {
                    out.sines.push((place, joint));
                    T::ZERO
                }
                Node::Cos(joint) => {
                    out.cosines.push((place, joint));
                    T::ONE
                }
                _ => continue,
            };
            places[id] = place;
            out.values.push(value);
        }
        out.leaves = out.values.len();
        out.group(&graph.nodes, &mut places);
        out.outputs = graph.outputs.iter().map(|&output| places[output]).collect();
        out
    }

    /// Puts all nodes that are no leaves into groups: again and again the largest one of those that could come next.
    fn group(&mut self, nodes: &[Node], places: &mut [usize]) {
        let mut users: Vec<Vec<NodeId>> = vec![Vec::new(); nodes.len()];
        let mut waiting = vec![0; nodes.len()];
        let mut ready: [Vec<NodeId>; KINDS.len()] = Default::default();
        for (id, node) in nodes.iter().enumerate() {
            let Some(kind) = Kind::of(node) else { continue };
            for operand in node.operands().filter(|&operand| Kind::of(&nodes[operand]).is_some()) {
                users[operand].push(id);
                waiting[id] += 1;
            }
            if waiting[id] == 0 {
                ready[kind.place()].push(id);
            }
        }
        loop {
            // The first of the largest.
            let largest = (0..KINDS.len()).rev().max_by_key(|&kind| ready[kind].len()).unwrap_or(0);
            let members = std::mem::take(&mut ready[largest]);
            if members.is_empty() {
                return;
            }
            let kind = KINDS[largest];
            let mut group = Group { kind, operands: Vec::with_capacity(members.len()), more: Vec::new() };
            for &id in &members {
                let mut own = nodes[id].operands().map(|operand| places[operand] as u32);
                let mut pair = || [own.next().unwrap_or(0), own.next().unwrap_or(0)];
                group.operands.push(pair());
                if matches!(kind, Kind::Clamp | Kind::Select | Kind::MulAdd(_)) {
                    group.more.push(pair());
                }
            }
            for id in members {
                places[id] = self.values.len();
                self.values.push(T::ZERO);
                for &user in &users[id] {
                    waiting[user] -= 1;
                    if let (0, Some(kind)) = (waiting[user], Kind::of(&nodes[user])) {
                        ready[kind.place()].push(user);
                    }
                }
            }
            self.groups.push(group);
        }
    }

    /// As [`Graph::interpret`].
    pub fn interpret(&self, q: &[T], qd: &[T], v_r: &[T], a_r: &[T]) -> Vec<T> {
        self.evaluate(q, |variable| super::interpret::of_model(variable, q, qd, v_r, a_r))
    }

    /// As [`Graph::interpret_step`].
    pub fn interpret_step(&self, q: &[T], qd: &[T], desired: [&[T]; 3], theta: &[T]) -> Vec<T> {
        self.evaluate(q, |variable| super::interpret::of_step(variable, q, qd, desired, theta))
    }

    fn evaluate<'a>(&self, q: &[T], read: impl Fn(Variable) -> Option<&'a T>) -> Vec<T>
    where
        T: 'a,
    {
        let trig = super::interpret::turned(q, &self.parts, &self.trig);
        let mut values = self.values.clone();
        for &(place, variable) in &self.inputs {
            values[place] = read(variable).copied().unwrap_or(T::ZERO);
        }
        for &(place, joint) in &self.sines {
            values[place] = trig.get(joint).map_or(T::ZERO, |pair| pair.0);
        }
        for &(place, joint) in &self.cosines {
            values[place] = trig.get(joint).map_or(T::ONE, |pair| pair.1);
        }
        let mut place = self.leaves;
        for group in &self.groups {
            let (before, rest) = values.split_at_mut(place);
            group.evaluate(before, rest);
            place += group.operands.len();
        }
        self.outputs.iter().map(|&output| values[output]).collect()
    }
}

impl Group {
    /// Writes the values of the group to the beginning of `out`.
    fn evaluate<T: Angle>(&self, values: &[T], out: &mut [T]) {
        let value = |place: u32| values[place as usize];
        let pairs = out.iter_mut().zip(&self.operands);
        match self.kind {
            Kind::Add => pairs.for_each(|(out, &[a, b])| *out = value(a) + value(b)),
            Kind::Sub => pairs.for_each(|(out, &[a, b])| *out = value(a) - value(b)),
            Kind::Mul => pairs.for_each(|(out, &[a, b])| *out = value(a) * value(b)),
            Kind::MulAdd(signs) => pairs.zip(&self.more).for_each(|((out, &[a, b]), &[c, _])| {
                let (first, added) = signs.given(value(a), value(c));
                *out = first.mul_add(value(b), added);
            }),
            Kind::Neg => pairs.for_each(|(out, &[a, _])| *out = -value(a)),
            Kind::Abs => pairs.for_each(|(out, &[a, _])| *out = value(a).abs()),
            Kind::Clamp => pairs.zip(&self.more).for_each(|((out, &[a, low]), &[high, _])| {
                *out = step::clamp(value(a), value(low), value(high));
            }),
            Kind::Select => pairs.zip(&self.more).for_each(|((out, &[a, above]), &[below, otherwise])| {
                *out = step::select(value(a), value(above), value(below), value(otherwise));
            }),
        }
    }
}
