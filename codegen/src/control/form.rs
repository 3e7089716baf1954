//! The quadratic forms that V and its fall are made of, and their extremes over a set of positions, by branch and bound
//! over D.

use nalgebra::DMatrix;

use super::gains::Gains;
use super::inertia::{Cell, Inertia};
use super::verified::{inverse_diagonal, inverse_entries, largest_ratio, least_eigenvalue};
use crate::numerics::linalg::{dense, rows, symmetric, weighed};

/// Relative gap at which the search for extremes of D ends.
pub(super) const TOLERANCE: f64 = 0.05;
/// Vertices at which a search over a domain may look, for an arm of one joint; the cost of each grows with n².
pub(super) const BUDGET: usize = 200_000;
/// The same for the positions about the start.
const START_BUDGET: usize = 2_000;

/// What D can do over a set of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct InertiaBounds {
    /// λ_min(D) from below, kg·m².
    pub least: f64,
    /// (D⁻¹)_ii from above, 1/(kg·m²).
    pub mobility: Vec<f64>,
    /// λ_max(M⁻¹ diag(D, Pqq)) from above, s: 2V ≤ this zᵀMz.
    pub time: f64,
    /// False where the search ended early, and the numbers are only what was seen.
    pub certified: bool,
}

/// M of equation (17), inverted, with what follows from it.
pub(super) struct Form {
    matrix: DMatrix<f64>,
    root_inverse: DMatrix<f64>,
    /// |M⁻¹|, entry by entry, from above.
    pub(super) inverse: DMatrix<f64>,
    /// (Pqq⁻¹)_ii from above, rad/(N·m).
    pub(super) compliance: Vec<f64>,
    /// λ_min(P12) from below, 1/s.
    pub(super) slowest: f64,
}

impl Form {
    /// `None` where rounding has cost M its definiteness: gains some fifteen powers of ten apart.
    pub(super) fn new(gains: &Gains) -> Option<Self> {
        let n = gains.pqq.len();
        let omega = dense(&gains.pqq) * dense(&gains.p12);
        let m = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => gains.damping[i][j],
            (true, false) => -gains.pqq[i][j - n],
            (false, true) => -gains.pqq[i - n][j],
            (false, false) => omega[(i - n, j - n)],
        });
        let matrix = symmetric(&m);
        let factor = matrix.clone().cholesky()?;
        let root_inverse = factor.l().try_inverse()?;
        let inverse = inverse_entries(&matrix, &factor.inverse())?;
        let pqq = symmetric(&dense(&gains.pqq));
        let compliance = inverse_diagonal(&pqq, pqq.clone().cholesky()?.inverse().diagonal().as_slice());
        let slowest = least_eigenvalue(&symmetric(&dense(&gains.p12)));
        let known = slowest > 0.0 && compliance.iter().all(|c| c.is_finite());
        known.then_some(Self { matrix, root_inverse, inverse, compliance, slowest })
    }
}

/// Bounds on D over `cells`.
pub(super) fn inertia_bounds(
    inertia: &Inertia,
    cells: Vec<Cell>,
    gains: &Gains,
    form: &Form,
) -> InertiaBounds {
    let n = gains.pqq.len();
    let pqq = dense(&gains.pqq);
    let root = &form.root_inverse;
    let unit = DMatrix::identity(n, n);
    let extremes = inertia.largest(cells, TOLERANCE, BUDGET / (n * n), |low, high| {
        let mut out = match low.clone().cholesky() {
            Some(factor) => {
                let inverse = factor.inverse();
                let diagonal = inverse.diagonal();
                let top = largest_ratio(low, &unit, inverse.symmetric_eigenvalues().max());
                std::iter::once(top).chain(inverse_diagonal(low, diagonal.as_slice())).collect()
            }
            None => vec![f64::INFINITY; n + 1],
        };
        let mut energy = DMatrix::zeros(2 * n, 2 * n);
        energy.view_mut((0, 0), (n, n)).copy_from(high);
        energy.view_mut((n, n), (n, n)).copy_from(&pqq);
        let guess = (root * &energy * root.transpose()).symmetric_eigenvalues().max();
        out.push(largest_ratio(&form.matrix, &energy, guess));
        out
    });
    let certified = extremes.bound.iter().all(|b| b.is_finite());
    let values = if certified { extremes.bound } else { extremes.seen };
    InertiaBounds { least: 1.0 / values[0], mobility: values[1..=n].to_vec(), time: values[n + 1], certified }
}

/// V_max(0): max ½ sᵀDs + ½ q_eᵀ Pqq q_e over the initial errors, J, for positions in `cell`.
pub(super) fn initial_level(
    inertia: &Inertia,
    gains: &Gains,
    cell: Cell,
    position: &[f64],
    velocity: &[f64],
) -> f64 {
    let n = position.len();
    let s: Vec<f64> = (0..n).map(|i| velocity[i] + weighed(&gains.p12[i], position)).collect();
    let elastic = largest_form(&dense(&gains.pqq), position);
    if s.iter().all(|&s| s == 0.0) {
        return elastic;
    }
    let extremes = inertia.largest(vec![cell], 1e-3, START_BUDGET, |_, high| vec![largest_form(high, &s)]);
    extremes.bound[0] + elastic
}

/// The largest λ_max(D⁻¹K) over some cells, 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fastest {
    /// From above where it is certified; otherwise only what was seen.
    pub(super) rate: f64,
    /// Whether no position of the cells exceeds it.
    pub(super) certified: bool,
}

/// The largest λ_max(D⁻¹K) over `cells`; infinite where K has overflowed.
pub(super) fn fastest(inertia: &Inertia, cells: Vec<Cell>, damping: &[Vec<f64>]) -> Fastest {
    let unknown = Fastest { rate: f64::INFINITY, certified: false };
    let damping_matrix = symmetric(&dense(damping));
    let Some(factor) = damping_matrix.clone().cholesky() else { return unknown };
    let root = factor.l();
    let extremes = inertia.largest(cells, TOLERANCE, BUDGET / damping.len().pow(2), |low, _| {
        let Some(factor) = low.clone().cholesky() else { return vec![f64::INFINITY] };
        let guess = (root.transpose() * factor.solve(&root)).symmetric_eigenvalues().max();
        vec![largest_ratio(low, &damping_matrix, guess)]
    });
    let (bound, seen) = (extremes.bound[0], extremes.seen[0]);
    let certified = bound.is_finite();
    Fastest { rate: if certified { bound } else { seen }, certified }
}

/// K with the slope of the robust terms.
pub(super) fn total(damping: &[Vec<f64>], more: &[Vec<f64>], slope: &[f64]) -> Vec<Vec<f64>> {
    let n = slope.len();
    let mut sum = dense(damping) + dense(more);
    for i in 0..n {
        sum[(i, i)] += slope[i];
    }
    rows(&sum)
}

/// max ½ xᵀ M x over |x_i| ≤ b_i: the form is convex, so a corner attains it, and the opposite one too. The corners are
/// visited so that each differs from the one before in one sign, and the rounding that gathers on the way is added.
fn largest_form(m: &DMatrix<f64>, b: &[f64]) -> f64 {
    const GATHERED: f64 = 1e-12;
    let n = b.len();
    let mut x = b.to_vec();
    let mut rows: Vec<f64> = (0..n).map(|i| (0..n).map(|j| m[(i, j)] * x[j]).sum()).collect();
    let value = |x: &[f64], rows: &[f64]| 0.5 * x.iter().zip(rows).map(|(x, row)| x * row).sum::<f64>();
    let mut most = value(&x, &rows).max(0.0);
    for corner in 1..1_usize << n.saturating_sub(1) {
        let i = corner.trailing_zeros() as usize;
        x[i] = -x[i];
        for (j, row) in rows.iter_mut().enumerate() {
            *row += 2.0 * m[(j, i)] * x[i];
        }
        most = most.max(value(&x, &rows));
    }
    most * (1.0 + GATHERED)
}
