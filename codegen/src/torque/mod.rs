//! Bodies of the passivity torque D̂ a_r + Ĉ v_r + Ĝ as expression graphs.

mod coupled;
mod expanded;
mod factors;
mod harmonics;
mod matrices;
mod plain;
mod recursive;
mod regressor;
mod relative;
mod sparse;
#[cfg(test)]
mod tests;

pub use expanded::expanded;
pub use matrices::matrices;
pub use plain::plain;
pub use recursive::recursive;
pub(crate) use recursive::{Plan, costs, planned};
pub use regressor::{Regressor, regressor};
use serde::{Deserialize, Serialize};
pub use sparse::sparse;

use crate::arm::Arm;
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::reduction;

/// Where expansions longer than this cannot compete with the recursion: its cost grows with n alone.
const LONG: usize = 4000;

/// Factors are sought in expansions up to this many terms: a longer one has lost against the recursion anyway.
const SHORT: usize = 100;

/// How a body computes the torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    /// Sums of ψ functions.
    Expanded,
    /// Sums of a few functions each, products among them.
    Sparse,
    /// The polarised Newton–Euler recursion.
    Recursive,
}

impl Form {
    /// As one word.
    pub fn name(self) -> &'static str {
        match self {
            Form::Expanded => "expanded",
            Form::Sparse => "sparse",
            Form::Recursive => "recursive",
        }
    }
}

/// The exact torque in the form that costs less; the recursion where they tie.
pub fn exact(arm: &Arm, lagrangian: &Lagrangian) -> (Form, Graph) {
    let recursive = recursive(arm);
    if lagrangian.terms() <= LONG {
        let mut expanded = expanded(arm, lagrangian, &reduction::exact(lagrangian));
        if lagrangian.terms() <= SHORT {
            expanded = expanded.factored();
        }
        if expanded.operations().cost() < recursive.operations().cost() {
            return (Form::Expanded, expanded);
        }
    }
    (Form::Recursive, recursive)
}
