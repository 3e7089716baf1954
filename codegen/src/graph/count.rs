//! What a graph costs.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Graph, Node};
use crate::lagrangian::MAX_JOINTS;

/// What one sine and cosine count for, in multiplications and additions.
pub const TRIG_PAIR: usize = 12;

/// What a clamp or a choice by a sign counts for: two comparisons.
pub const CLAMP: usize = 2;
/// What a division counts for.
pub const DIVISION: usize = 5;

/// Operations of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions, subtractions, negations and absolute values.
    pub add: usize,
    /// Multiplications together with an addition or subtraction, rounded once: one operation each.
    pub fused: usize,
    /// Numbers that are clamped, and choices by a sign.
    pub other: usize,
    /// Divisions.
    pub div: usize,
    /// Joints of which sine or cosine is taken.
    pub trig_pairs: usize,
}

impl Operations {
    /// All but sines and cosines together.
    pub fn arithmetic(&self) -> usize {
        self.mul + self.add + self.fused + self.other + self.div
    }

    /// What code is compared by: multiplications and additions, with every clamp, division and pair of sine and cosine as
    /// 2, 5 and [`TRIG_PAIR`], and a multiplication together with an addition as 1.
    pub fn cost(&self) -> usize {
        self.mul
            + self.add
            + self.fused
            + CLAMP * self.other
            + DIVISION * self.div
            + TRIG_PAIR * self.trig_pairs
    }

    /// Those of `nodes`, where sines and cosines are of angles divided by `parts`.
    pub(super) fn of<'a>(nodes: impl Iterator<Item = &'a Node>, parts: &[u8; MAX_JOINTS]) -> Self {
        let mut count = Self::default();
        let mut turned: Vec<usize> = Vec::with_capacity(MAX_JOINTS);
        for node in nodes {
            match *node {
                Node::Mul(..) => count.mul += 1,
                Node::Add(..) | Node::Sub(..) | Node::Neg(_) | Node::Abs(_) => count.add += 1,
                Node::MulAdd(..) => count.fused += 1,
                Node::Clamp(..) | Node::Select(..) => count.other += 1,
                Node::Sin(joint) | Node::Cos(joint) if !turned.contains(&joint) => turned.push(joint),
                Node::Sin(_) | Node::Cos(_) | Node::Input(_) | Node::Constant(_) => {}
            }
        }
        count.mul += turned.iter().filter(|&&joint| parts.get(joint).is_some_and(|&part| part != 1)).count();
        count.trig_pairs = turned.len();
        count
    }
}

impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} mul, {} add, ", self.mul, self.add)?;
        if self.fused > 0 {
            write!(f, "{} mul-add, ", self.fused)?;
        }
        write!(f, "{} sin-cos pairs", self.trig_pairs)
    }
}

impl Graph {
    /// Counts the operations of one evaluation.
    pub fn operations(&self) -> Operations {
        Operations::of(self.nodes.iter(), &self.parts)
    }

    /// True where every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        self.nodes.iter().all(Node::is_finite)
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
