//! What differs between two generated modules: functions, numbers, costs, promises and text.

mod module;
mod moved;
mod numbers;
mod unified;

pub use module::ModuleText;
pub use moved::{Group, Moved, Part};

use serde::Serialize;

use crate::graph::Operations;
use unified::unified;

/// What differs from a module to another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Changes {
    /// What each module is called.
    pub names: [String; 2],
    /// Whether the texts differ in any byte.
    pub differ: bool,
    /// How the code of each computes the torque.
    pub forms: [String; 2],
    /// The functions of each, with their shares.
    pub psi: [Vec<(String, f64)>; 2],
    /// Functions that the second module keeps and the first does not, with their share there.
    pub psi_added: Vec<(String, f64)>,
    /// Functions that the first module keeps and the second does not, with their share there.
    pub psi_removed: Vec<(String, f64)>,
    /// Operations of a step of each, as the verdict counts them.
    pub operations: [Operations; 2],
    /// Their sum, a pair of sine and cosine as 12 and a clamp as 2.
    pub cost: [usize; 2],
    /// Certified torque error of each by joint, N·m or N.
    pub torque_error: [Option<Vec<f64>>; 2],
    /// Largest switching gain of each by joint, N·m or N.
    pub switching_gain: [Option<Vec<f64>>; 2],
    /// Kind of guarantee of each.
    pub guarantee: [Option<String>; 2],
    /// Numbers that differ.
    pub numbers: Vec<Part>,
    /// The unified difference of the texts; empty where they are the same.
    pub source: String,
}

impl Changes {
    /// From `before` to `after`.
    pub fn new(before: &ModuleText, after: &ModuleText) -> Self {
        let both = [before, after];
        let only = |a: &ModuleText, b: &ModuleText| -> Vec<(String, f64)> {
            let kept = |name: &String| b.facts.psi.iter().any(|(other, _)| other == name);
            a.facts.psi.iter().filter(|(name, _)| !kept(name)).cloned().collect()
        };
        Self {
            names: both.map(|module| module.name.clone()),
            differ: before.text != after.text,
            forms: both.map(|module| module.facts.form.clone()),
            psi: both.map(|module| module.facts.psi.clone()),
            psi_added: only(after, before),
            psi_removed: only(before, after),
            operations: both.map(|module| module.facts.operations),
            cost: both.map(|module| module.facts.operations.cost()),
            torque_error: both.map(|module| module.facts.torque_error.clone()),
            switching_gain: both.map(|module| module.facts.switching_gain.clone()),
            guarantee: both.map(|module| module.facts.guarantee.clone()),
            numbers: moved::parts(&before.numbers, &after.numbers),
            source: unified(before, after),
        }
    }
}

#[cfg(test)]
mod tests;
