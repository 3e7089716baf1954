//! Identifiers of generated code.
//!
//! What has no name is called after what it is, so that a model with one more function keeps its other lines.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Span};

use crate::graph::{Node, NodeId, Signs, Variable};

/// Longer descriptions are replaced by a short sum of their letters.
const LONGEST: usize = 32;

/// Identifiers in use, and a description of every node so far.
#[derive(Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
    described: Vec<String>,
}

impl Names {
    /// Keeps `text` for what is written first.
    pub(super) fn take(&mut self, text: &str) {
        self.taken.insert(text.to_string());
    }

    /// Describes the next node, which is written within others.
    pub(super) fn describe(&mut self, node: &Node) {
        let text = self.description(node);
        self.described.push(text);
    }

    /// An identifier for the next node: `wished` or its description if that is free, with a number otherwise.
    pub(super) fn fresh(&mut self, node: &Node, wished: Option<&str>) -> Ident {
        let text = match wished {
            Some(wished) => wished.to_string(),
            None => identifier(&self.description(node)),
        };
        let free = (1..).map(|number| if number == 1 { text.clone() } else { format!("{text}_{number}") });
        let free = free.into_iter().find(|text| !self.taken.contains(text)).unwrap_or(text);
        self.taken.insert(free.clone());
        self.described.push(free.clone());
        Ident::new(&free, Span::call_site())
    }

    fn description(&self, node: &Node) -> String {
        let of = |id: NodeId| self.described.get(id).map_or("", String::as_str);
        // Constants change with the size of a model; what they stand in does not.
        let joined = |a: &str, word: &str, b: &str| match (a, b) {
            ("", other) | (other, "") => other.to_string(),
            (a, b) => format!("{a}{word}{b}"),
        };
        match *node {
            Node::Input(variable) => input(variable),
            Node::Sin(j) => format!("sin_q{}", j + 1),
            Node::Cos(j) => format!("cos_q{}", j + 1),
            Node::Constant(_) => String::new(),
            Node::Add(a, b) => joined(of(a), "_plus_", of(b)),
            Node::Sub(a, b) => joined(of(a), "_less_", of(b)),
            Node::Mul(a, b) => joined(of(a), "_", of(b)),
            Node::MulAdd(signs, a, b, c) => match (joined(of(a), "_", of(b)), of(c), signs) {
                (product, added, Signs::Plus) => joined(&product, "_plus_", added),
                (product, added, Signs::Minus) => joined(&product, "_less_", added),
                (product, added, Signs::From) => joined(added, "_less_", &product),
            },
            Node::Neg(a) => format!("minus_{}", of(a)),
            Node::Abs(a) => format!("{}_abs", of(a)),
            Node::Clamp(a, ..) => format!("{}_clamped", of(a)),
            Node::Select(a, ..) => format!("{}_side", of(a)),
        }
    }
}

fn input(variable: Variable) -> String {
    match variable {
        Variable::Q(j) => format!("q{}", j + 1),
        Variable::Qd(j) => format!("qd{}", j + 1),
        Variable::Vr(j) => format!("v_r{}", j + 1),
        Variable::Ar(j) => format!("a_r{}", j + 1),
        Variable::DesiredQ(j) => format!("q_d{}", j + 1),
        Variable::DesiredQd(j) => format!("qd_d{}", j + 1),
        Variable::DesiredQdd(j) => format!("qdd_d{}", j + 1),
        Variable::Theta(k) => format!("theta{}", k + 1),
    }
}

/// The description, or `t_` and a sum of it where it is long or says nothing.
fn identifier(description: &str) -> String {
    if !description.is_empty() && description.len() <= LONGEST {
        return description.to_string();
    }
    // FNV-1a, 32 bits, of which 20 are shown.
    let sum = description
        .bytes()
        .fold(0x811c_9dc5_u32, |sum, byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    format!("t_{:05x}", (sum >> 12) ^ (sum & 0xf_ffff))
}
