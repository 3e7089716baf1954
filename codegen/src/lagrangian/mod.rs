//! The Lagrangian model as linear combinations: every d_ij, h_ijk and g_i is Σ_l k_l ψ_l(q).

mod absolute;
mod coefficients;
mod coupled;
mod expand;
mod function;
mod table;
mod transform;
mod values;

pub use absolute::{Absolute, Coordinates};
pub use coefficients::{Accuracy, Coefficient, Entry, Place};
pub use expand::{expand, expand_family};
pub use function::{Function, MAX_JOINTS, WHOLE};
use serde::{Deserialize, Serialize};
pub use values::Values;

/// A linear combination Σ k_l ψ_l: pairs (index l into [`Lagrangian::functions`], k_l), by ascending l, without zeros.
pub type Combination = Vec<(usize, f64)>;

/// The exact model of an arm over the harmonic dictionary.
///
/// Holds: `functions` is sorted and has no duplicates, the constant first; every entry of D, h and G
/// that is not identically zero is a place of exactly one coefficient; no two coefficients are equal up
/// to sign; the largest term of each is positive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lagrangian {
    /// Number of joints n.
    pub dof: usize,
    /// The p functions ψ_l that occur.
    pub functions: Vec<Function>,
    /// The r distinct coefficients, d before h before g.
    pub coefficients: Vec<Coefficient>,
    /// Range [low, high] of each uncertain parameter u_k, which is 0 for the arm's own value; none where it is known.
    pub ranges: Vec<[f64; 2]>,
    /// The entries that cannot be told from zero, with what they may be for all that: at the arm's own parameters, then by
    /// each uncertain one.
    pub vanishing: Vec<(Entry, Vec<Accuracy>)>,
}

impl Lagrangian {
    /// The model of the arm as specified, every parameter known; functions and coefficients keep their numbers.
    #[must_use]
    pub fn at_nominal(&self) -> Self {
        let mut known = self.clone();
        known.ranges.clear();
        for coefficient in &mut known.coefficients {
            coefficient.variations.clear();
            coefficient.errors.truncate(1);
        }
        known
    }

    /// Nonzero terms over the distinct coefficients.
    pub fn terms(&self) -> usize {
        self.coefficients.iter().map(|c| c.terms.len()).sum()
    }

    /// Values of all ψ at `q`.
    pub fn evaluate_functions(&self, q: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.functions.len());
        let mut rest = self.functions.iter().peekable();
        while let Some(psi) = rest.next() {
            // Cosine and sine of one angle stand side by side.
            match rest.next_if(|next| psi.is_before(next)) {
                Some(_) => out.extend(psi.evaluate_both(q)),
                None => out.push(psi.evaluate(q)),
            }
        }
        out
    }
}

/// Value of a combination, given the values of the functions.
pub fn evaluate(terms: &[(usize, f64)], psi: &[f64]) -> f64 {
    terms.iter().fold(0.0, |sum, &(l, k)| sum + k * psi[l])
}
