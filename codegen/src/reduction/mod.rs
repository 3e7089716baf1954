//! The reduction: which ψ functions a model keeps, and with which parameters.

mod dictionary;
mod exact;
mod extremes;
mod gram_schmidt;
mod minimax;
mod rates;
mod reestimate;
mod regression;
mod samples;
mod separate;
mod shared;
mod shares;
mod simplified_arm;
mod sparse;
mod uniform;

pub use dictionary::{Dictionary, minimax_sparse, over_dictionary};
pub use exact::exact;
pub use extremes::extremes;
pub use gram_schmidt::{GramSchmidt, Pick};
pub use minimax::minimax;
pub use rates::{Columns, Rate, Term, Turned, columns, grouped, rates, summed};
pub use reestimate::reestimate;
pub use regression::{Learnt, Regression};
pub use samples::Samples;
pub use separate::{minimax_each, separate};
use serde::{Deserialize, Serialize};
pub use shared::{Ranked, ranked, shared};
pub use shares::shares;
pub use simplified_arm::{Expressed, SimplifiedArm, expressed};
pub use sparse::{CandidateFunction, Group, Sparse, products};
pub(crate) use uniform::{solved, uniform};

use crate::domain::Measure;
use crate::lagrangian::{Coefficient, Combination, Entry, Lagrangian};

/// A model of the same structure (1) with simplified coefficients.
///
/// Holds: `combinations` and `simplified` run parallel to [`Lagrangian::coefficients`]; what is not
/// simplified is the exact combination.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reduced {
    /// The kept functions u_1 … u_ξ in the order of selection, as indices into [`Lagrangian::functions`];
    /// where every coefficient has its own, the union in ascending order; empty for the exact model.
    pub selected: Vec<usize>,
    /// α̂_m by index.
    pub combinations: Vec<Combination>,
    /// Whether α̂_m differs in form from α_m.
    pub simplified: Vec<bool>,
    /// ∂α̂_m/∂u_k by index and uncertain parameter, for a law that learns u; empty where the model stays as it is.
    pub variations: Vec<Vec<Combination>>,
    /// How it is made.
    pub kind: Kind,
}

/// How a model is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Kind {
    /// Nothing is left out.
    Exact,
    /// Sums of kept ψ functions.
    Expanded,
    /// Few functions for each coefficient, products among them.
    Sparse(Sparse),
    /// The exact model of another arm, which has fewer parameters.
    SimplifiedArm(SimplifiedArm),
}

impl Reduced {
    /// True for the exact model.
    pub fn is_exact(&self) -> bool {
        self.kind == Kind::Exact
    }

    /// How a sparse model is written down; `None` for the other kinds.
    pub fn sparse(&self) -> Option<&Sparse> {
        match &self.kind {
            Kind::Sparse(sparse) => Some(sparse),
            Kind::Exact | Kind::Expanded | Kind::SimplifiedArm(_) => None,
        }
    }

    /// The other arm whose exact model this is; `None` for the other kinds.
    pub fn simplified_arm(&self) -> Option<&SimplifiedArm> {
        match &self.kind {
            Kind::SimplifiedArm(arm) => Some(arm),
            Kind::Exact | Kind::Expanded | Kind::Sparse(_) => None,
        }
    }

    /// True where every parameter is a finite number.
    pub fn is_finite(&self) -> bool {
        let all = self.combinations.iter().chain(self.variations.iter().flatten());
        all.flatten().all(|(_, k)| k.is_finite())
    }

    /// The residual α_m − α̂_m of coefficient `m` as one combination, at the arm's own parameters.
    pub fn residual(&self, lagrangian: &Lagrangian, m: usize) -> Combination {
        plus(&lagrangian.coefficients[m].terms, -1.0, &self.combinations[m])
    }

    /// ∂(α_m − α̂_m)/∂u_k.
    pub fn residual_variation(&self, lagrangian: &Lagrangian, m: usize, k: usize) -> Combination {
        let exact = &lagrangian.coefficients[m].variations[k];
        match self.variations.get(m) {
            Some(learnt) => plus(exact, -1.0, &learnt[k]),
            None => exact.clone(),
        }
    }
}

/// a + k b, both by ascending function, without zeros.
pub fn plus(a: &Combination, k: f64, b: &Combination) -> Combination {
    let mut out = Combination::new();
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    loop {
        let (l, value) = match (a.peek(), b.peek()) {
            (Some(&&(la, ka)), Some(&&(lb, kb))) => match la.cmp(&lb) {
                std::cmp::Ordering::Less => (a.next(), (la, ka)).1,
                std::cmp::Ordering::Greater => (b.next(), (lb, k * kb)).1,
                std::cmp::Ordering::Equal => {
                    a.next();
                    b.next();
                    (la, ka + k * kb)
                }
            },
            (Some(&&(la, ka)), None) => (a.next(), (la, ka)).1,
            (None, Some(&&(lb, kb))) => (b.next(), (lb, k * kb)).1,
            (None, None) => break,
        };
        if value != 0.0 {
            out.push((l, value));
        }
    }
    out
}

/// Weight w_m of equation (2): the mean square of what multiplies α_m, summed over the places where it stands.
pub fn weight(coefficient: &Coefficient, measure: &Measure) -> f64 {
    let acceleration = &measure.acceleration_square;
    let velocity = &measure.velocity_square;
    let of = |entry: Entry| match entry {
        Entry::D(i, j) if i == j => acceleration[i],
        Entry::D(i, j) => acceleration[i] + acceleration[j],
        Entry::H(_, j, k) if j == k => velocity[j][j],
        Entry::H(_, j, k) => 2.0 * velocity[j][k],
        Entry::G(_) => 1.0,
    };
    coefficient.places.iter().map(|place| of(place.entry)).sum()
}
