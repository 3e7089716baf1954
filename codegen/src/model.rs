//! A model together with its code.

use crate::graph::Graph;
use crate::reduction::Reduced;
use crate::torque::Form;
use serde::{Deserialize, Serialize};

/// A model of the arm: what its coefficients are, and the graph that computes its torque.
///
/// Holds: `code` computes D̂ a_r + Ĉ v_r + Ĝ with the coefficients of `reduced`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Model {
    /// The coefficients, and which of the four kinds of model they make ([`crate::reduction::Kind`]).
    pub reduced: Reduced,
    /// How the code computes the torque.
    pub form: Form,
    /// The passivity torque.
    pub code: Graph,
}

impl Model {
    /// What the code costs, by [`crate::graph::Operations::cost`].
    pub fn cost(&self) -> usize {
        self.code.operations().cost()
    }
}
