//! What one period of the loop is computed with: the arm about the desired state at its start, and the desired motion during it.

use nalgebra::DMatrix;

use super::course::{Course, Lag};
use super::enclosure::{Around, Curved, Enclosure, Forms};
use super::problem::Problem;
use crate::numerics::linalg::{dense, weighed};

/// What one uncertain number adds.
#[derive(Clone, Debug)]
pub(super) struct Added {
    /// What its arm has, where it is one of inertia.
    pub(super) enclosure: Enclosure,
    /// Its D_m, and that at the start.
    pub(super) mass_matrix: Forms,
    pub(super) inertia: Turned,
    /// Bound on |d/dt(D_m q̈_d + n_m)| along the desired motion, with q̈_d held.
    pub(super) lag_rate: Vec<f64>,
}

/// A part of D, A, as the eigenvectors of D see it. All matrices by rows.
#[derive(Clone, Debug)]
pub(super) struct Turned {
    /// Wᵀ A.
    pub(super) left: Vec<f64>,
    /// Bounds on the entries of Wᵀ A W and of Wᵀ A W Wᵀ.
    pub(super) entries: Vec<f64>,
    pub(super) pulls: Vec<f64>,
    /// Bounds on the lengths of the rows of Wᵀ A W.
    pub(super) lengths: Vec<f64>,
}

/// What the product of two displacements adds to D, ½∂_k∂_l D for both orders.
#[derive(Clone, Debug)]
pub(super) struct Bend {
    pub(super) pair: (usize, usize),
    pub(super) inertia: Turned,
}

/// All that a period needs of arm and motion.
#[derive(Clone, Debug)]
pub(super) struct Local {
    pub(super) course: Course,
    /// Half the sides of the box of displacements that it holds for: of q, then of q̇.
    pub(super) half: Vec<f64>,
    pub(super) arm: Enclosure,
    /// Its D.
    pub(super) mass_matrix: Curved,
    pub(super) added: Vec<Added>,
    /// Columns W of D⁻¹ at the start: W Wᵀ is near it, and `inverse` is W Wᵀ as computed.
    pub(super) w: Vec<Vec<f64>>,
    pub(super) inverse: Vec<Vec<f64>>,
    /// |W||Wᵀ|.
    pub(super) inverse_size: Vec<Vec<f64>>,
    /// ∂_kD for each k.
    pub(super) slopes: Vec<Turned>,
    /// The same for each product of two displacements.
    pub(super) bends: Vec<Bend>,
    /// Lengths of the rows of Wᵀ A W for what is of third order in D and for what rounds in it, and those of Wᵀ D W − 1.
    pub(super) rest_lengths: Vec<f64>,
    pub(super) rounding_lengths: Vec<f64>,
    pub(super) unit_lengths: Vec<f64>,
    /// What the held torque of the desired motion lags behind.
    pub(super) lag: Lag,
}

impl Local {
    /// About the start of `course`, for displacements up to `half`; `None` where D cannot be inverted there.
    pub(super) fn new(problem: &Problem, course: Course, half: Vec<f64>) -> Option<Self> {
        let around = Around { target: &course.target, p12: &problem.gains.p12, half: &half };
        let arm = Enclosure::new(problem.arm, around, true);
        let mass_matrix = Curved::of(problem.arm, around);
        let n = problem.arm.dof();
        let d: Vec<Vec<f64>> = mass_matrix.centre.chunks(n).map(<[f64]>::to_vec).collect();
        let w = factor(&d)?;
        let size = |i: usize, j: usize| -> f64 { (0..n).map(|k| w[i][k].abs() * w[j][k].abs()).sum() };
        let entry = |i: usize, j: usize| -> f64 { (0..n).map(|k| w[i][k] * w[j][k]).sum() };
        let square = |of: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            (0..n).map(|i| (0..n).map(|j| of(i, j)).collect()).collect()
        };
        let inverse = square(&entry);
        let inverse_size = square(&size);
        let slopes = mass_matrix.slopes.iter().map(|slopes| Turned::new(&w, &|i, j| slopes[i * n + j]));
        let slopes = slopes.collect();
        let bends = mass_matrix
            .bends
            .iter()
            .map(|(pair, bends)| Bend { pair: *pair, inertia: Turned::new(&w, &|i, j| bends[i * n + j]) });
        let bends = bends.collect();
        let sized: Vec<Vec<f64>> = w.iter().map(|row| row.iter().map(|x| x.abs()).collect()).collect();
        let rest_lengths = Turned::new(&sized, &|i, j| mass_matrix.rest[i * n + j]).lengths;
        let rounding = Turned::new(&sized, &|i, j| mass_matrix.rounding[i * n + j] + ROUNDED * d[i][j].abs());
        let unit_lengths = unit_lengths(&w, &d);
        let added = problem.numbers.iter().map(|number| {
            let enclosure = Enclosure::new(&number.arm, around, false);
            let mass_matrix = Forms::of_inertia(&number.arm, around);
            let inertia = Turned::new(&w, &|i, j| mass_matrix.centre[i * n + j]);
            let lag = Lag::new(&number.arm, &course, &[]);
            let lag_rate = lag.rate.iter().map(|rate| rate.magnitude()).collect();
            Added { enclosure, mass_matrix, inertia, lag_rate }
        });
        let added = added.collect();
        let viscous: Vec<f64> = problem.arm.joints.iter().map(|joint| joint.viscous_friction).collect();
        let lag = Lag::new(problem.arm, &course, &viscous);
        let rounding_lengths = rounding.lengths;
        Some(Self {
            course,
            half,
            arm,
            mass_matrix,
            added,
            w,
            inverse,
            inverse_size,
            slopes,
            bends,
            rest_lengths,
            rounding_lengths,
            unit_lengths,
            lag,
        })
    }
}

/// Roundings of Wᵀ D W, relative to what is summed, with room to spare.
const ROUNDED: f64 = 1e-13;

/// W with W Wᵀ ≈ D⁻¹: the eigenvectors of D over the roots of its eigenvalues.
fn factor(d: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = d.len();
    let finite = d.iter().flatten().all(|entry| entry.is_finite());
    let symmetric = DMatrix::from_fn(n, n, |i, j| 0.5 * (d[i][j] + d[j][i]));
    if !finite {
        return None;
    }
    let eigen = symmetric.symmetric_eigen();
    if !eigen.eigenvalues.iter().all(|value| *value > 0.0) {
        return None;
    }
    let entry = |i: usize, k: usize| eigen.eigenvectors[(i, k)] / libm::sqrt(eigen.eigenvalues[k]);
    Some((0..n).map(|i| (0..n).map(|k| entry(i, k)).collect()).collect())
}

impl Turned {
    fn new(w: &[Vec<f64>], part: &dyn Fn(usize, usize) -> f64) -> Self {
        let n = w.len();
        let mut out = Self {
            left: vec![0.0; n * n],
            entries: Vec::with_capacity(n * n),
            pulls: Vec::with_capacity(n * n),
            lengths: Vec::with_capacity(n),
        };
        for i in 0..n {
            let row = &mut out.left[i * n..(i + 1) * n];
            for (j, left) in row.iter_mut().enumerate() {
                *left = (0..n).map(|k| w[k][i] * part(k, j)).sum();
            }
            let size =
                |k: usize| -> f64 { row.iter().map(|x| x.abs()).zip(w).map(|(x, w)| x * w[k].abs()).sum() };
            let sizes: Vec<f64> = (0..n).map(size).collect();
            let entry = |j: usize| -> f64 { row.iter().zip(w).map(|(x, w)| x * w[j]).sum() };
            let entries: Vec<f64> = (0..n).map(entry).collect();
            let pull = |j: usize| -> f64 {
                let of: f64 = w[j].iter().zip(&entries).map(|(w, x)| w * x).sum();
                of.abs() + ROUNDED * weighed(&w[j], &sizes)
            };
            out.pulls.extend((0..n).map(pull));
            out.lengths.push(libm::sqrt(entries.iter().map(|x| x * x).sum()) * (1.0 + 1e-9));
            out.entries.extend(entries.iter().zip(&sizes).map(|(x, size)| x.abs() + ROUNDED * size));
        }
        out
    }
}

/// Lengths of the rows of Wᵀ D W − 1.
fn unit_lengths(w: &[Vec<f64>], d: &[Vec<f64>]) -> Vec<f64> {
    let n = w.len();
    let product = dense(w).transpose() * dense(d) * dense(w);
    let row = |i: usize| -> f64 {
        let entry = |j: usize| product[(i, j)] - if i == j { 1.0 } else { 0.0 };
        libm::sqrt((0..n).map(|j| entry(j) * entry(j)).sum()) * (1.0 + 1e-9)
    };
    (0..n).map(row).collect()
}

impl Added {
    /// Bound on the length of row `i` of Wᵀ ΔD_m W for displacements up to `away`.
    pub(super) fn changed_length(&self, w: &[Vec<f64>], i: usize, away: &[f64], lambda: f64) -> f64 {
        let n = w.len();
        let left = |j: usize| -> f64 {
            (0..n).map(|k| w[k][i].abs() * self.mass_matrix.change(k * n + j, away, lambda)).sum()
        };
        let left: Vec<f64> = (0..n).map(left).collect();
        let entry = |j: usize| -> f64 { (0..n).map(|k| left[k] * w[k][j].abs()).sum() };
        libm::sqrt((0..n).map(|j| entry(j) * entry(j)).sum()) * (1.0 + 1e-9)
    }
}
