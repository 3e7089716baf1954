//! No reduction.

use super::{Kind, Reduced};
use crate::lagrangian::Lagrangian;

/// The exact model: every coefficient as it is.
pub fn exact(lagrangian: &Lagrangian) -> Reduced {
    Reduced {
        selected: Vec::new(),
        combinations: lagrangian.coefficients.iter().map(|c| c.terms.clone()).collect(),
        simplified: vec![false; lagrangian.coefficients.len()],
        variations: Vec::new(),
        kind: Kind::Exact,
    }
}
