//! What a graph costs.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{Graph, Node};

/// What one sine and cosine count for, in multiplications and additions.
pub const TRIG_PAIR: usize = 12;

/// Operations of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions, subtractions and negations.
    pub add: usize,
    /// Joints of which sine or cosine is taken.
    pub trig_pairs: usize,
}

impl Operations {
    /// Multiplications and additions together.
    pub fn arithmetic(&self) -> usize {
        self.mul + self.add
    }

    /// What code is compared by: multiplications and additions, with every pair of sine and cosine as [`TRIG_PAIR`].
    pub fn cost(&self) -> usize {
        self.arithmetic() + TRIG_PAIR * self.trig_pairs
    }
}

impl Graph {
    /// Counts the operations of one evaluation.
    pub fn operations(&self) -> Operations {
        let mut count = Operations::default();
        let mut turned = BTreeSet::new();
        for node in &self.nodes {
            match *node {
                Node::Mul(..) => count.mul += 1,
                Node::Add(..) | Node::Sub(..) | Node::Neg(_) => count.add += 1,
                Node::Sin(joint) | Node::Cos(joint) => {
                    turned.insert(joint);
                }
                Node::Input(_) | Node::Constant(_) => {}
            }
        }
        count.mul +=
            turned.iter().filter(|&&joint| self.parts.get(joint).is_some_and(|&part| part != 1)).count();
        count.trig_pairs = turned.len();
        count
    }

    /// True where every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        self.nodes.iter().all(|node| match *node {
            Node::Constant(bits) => f64::from_bits(bits).is_finite(),
            _ => true,
        })
    }

    /// How often each node is used, by other nodes or as an output.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.nodes.len()];
        for id in self.nodes.iter().flat_map(Node::operands).chain(self.outputs.iter().copied()) {
            uses[id] += 1;
        }
        uses
    }
}
