//! Certified extremes over sets of positions of what grows or falls with D(q).
//!
//! Over a box around c, D(q) = D(c) + Σ_k ∂_kD(c) δ_k + R with |R_ij| ≤ ½ Σ_kl max|∂_k∂_l d_ij| w_k w_l, and
//! −diag(g) ≼ R ≼ diag(g) with g_i = Σ_j |R_ij| √(d_ii/d_jj): scaled so that light joints are not charged for heavy
//! ones. A function that is convex in D and monotone takes its largest value over the affine part at a vertex of the
//! box, with diag(g) added or subtracted; subdivision does the rest. R also holds what rounding does to D and to its
//! slopes, by the recursion over norms. What is made of D⁻ and D⁺ must be a proof: see [`super::verified`].

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, recursion_rounding};
use crate::dynamics::{coriolis, mass_matrix};
use crate::lagrangian::{Entry, Function, Lagrangian};
use crate::reduction::plus;

/// A direction whose slope is below this fraction of D counts as remainder, which halves the vertices.
const FLAT: f64 = 0.003;
/// Largest |κ_k κ_l| of a term in d_ij, whose degree in each joint is at most 2.
const BENT: f64 = 4.0;
/// Rounding of a sum of curvatures, relative.
const SUMMED: f64 = 1e-9;

/// A box of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Its middle, rad or m.
    pub centre: Vec<f64>,
    /// Half its sides, rad or m.
    pub half: Vec<f64>,
}

/// The largest values over a set of cells, entry by entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// What no position of the set exceeds; infinite where the search ended before it knew.
    pub bound: Vec<f64>,
    /// What some position attains.
    pub seen: Vec<f64>,
}

/// D over boxes, for every arm of a family.
pub struct Inertia {
    members: Vec<Member>,
}

/// One arm.
struct Member {
    arm: Arm,
    /// max|∂_k∂_l d_ij| at \[k n + l\]\[i n + j\].
    curvature: Vec<Vec<f64>>,
    /// What rounding does to D and h, that of the arm's rotations included.
    rounding: Bounds,
}

struct Judged {
    member: usize,
    cell: Cell,
    bound: Vec<f64>,
    seen: Vec<f64>,
    split: usize,
    vertices: usize,
}

impl Member {
    fn new(
        arm: Arm,
        lagrangian: &Lagrangian,
        u: &[f64],
        position_bound: &[f64],
        angles: Option<&Bounds>,
    ) -> Self {
        let n = arm.dof();
        let largest = |psi: &Function| -> f64 {
            psi.power.iter().zip(position_bound).map(|(&p, q)| (0..p).fold(1.0, |m, _| m * q)).product()
        };
        // max|∂_k∂_l ψ| for every ψ.
        let second = |psi: &Function, k: usize, l: usize| -> f64 {
            let Some((once, first)) = psi.derivative(k) else { return 0.0 };
            let Some((twice, factor)) = once.derivative(l) else { return 0.0 };
            (first * factor).abs() * largest(&twice)
        };
        // What the expansion has dropped bends D, too.
        let largest_monomial = position_bound.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
        let rounding = recursion_rounding(&arm, position_bound);
        let rounding = angles.map_or_else(|| rounding.clone(), |angles| rounding.clone().plus(angles));
        // An entry without a coefficient vanishes to rounding.
        let bent = BENT * steep(&arm) * steep(&arm);
        let none = |index: usize| bent * largest_monomial * rounding.d[index / n][index % n];
        let mut curvature = vec![(0..n * n).map(none).collect::<Vec<f64>>(); n * n];
        for coefficient in &lagrangian.coefficients {
            let varied = u.iter().zip(&coefficient.variations);
            let terms = varied.fold(coefficient.terms.clone(), |sum, (&u, v)| plus(&sum, u, v));
            let errors = coefficient.errors.iter().map(|accuracy| accuracy.error);
            let sizes = std::iter::once(1.0).chain(u.iter().map(|u| u.abs()));
            let dropped = bent * largest_monomial * errors.zip(sizes).map(|(e, size)| e * size).sum::<f64>();
            for place in &coefficient.places {
                let Entry::D(i, j) = place.entry else { continue };
                for (index, entries) in curvature.iter_mut().enumerate() {
                    let bend = |(psi, value): &(usize, f64)| {
                        value.abs() * second(&lagrangian.functions[*psi], index / n, index % n)
                    };
                    let sum =
                        none(i * n + j) + dropped + terms.iter().map(bend).sum::<f64>() * (1.0 + SUMMED);
                    entries[i * n + j] = sum;
                    entries[j * n + i] = sum;
                }
            }
        }
        Self { arm, curvature, rounding }
    }
}

/// The largest sum of rates with which joints turn for a coordinate; 1 where none follow.
fn steep(arm: &Arm) -> f64 {
    let couplings = arm.linkage.iter().flat_map(|linkage| &linkage.couplings);
    let mut sums = vec![0.0; arm.dof()];
    couplings.for_each(|c| sums[c.coordinate] += c.multiplier.abs());
    sums.into_iter().fold(1.0, f64::max)
}

impl Inertia {
    /// For cells inside |q_j| ≤ `position_bound`\[j\]; the reach matters for prismatic joints alone.
    pub fn new(arm: &Arm, lagrangian: &Lagrangian, position_bound: &[f64]) -> Self {
        Self { members: vec![Member::new(arm.clone(), lagrangian, &[], position_bound, None)] }
    }

    /// The same for every arm that `uncertainty` allows: D is affine in the uncertain parameters, so what is convex in D
    /// is largest at vertices of their box.
    ///
    /// `angles` bounds what rounding the arm's rotations has changed of D and h.
    pub fn of_family(
        arm: &Arm,
        uncertainty: &Uncertainty,
        lagrangian: &Lagrangian,
        position_bound: &[f64],
        angles: Option<&Bounds>,
    ) -> Self {
        let member =
            |u: Vec<f64>| Member::new(uncertainty.at(arm, &u), lagrangian, &u, position_bound, angles);
        Self { members: uncertainty.extreme_vertices().into_par_iter().map(member).collect() }
    }

    /// The largest values over `cells` of the entries of `f`, each relative to what is attained within `tolerance` or
    /// as near as looking at `budget` vertices allows.
    ///
    /// `f` gets matrices D⁻ ≼ D ≼ D⁺ at a vertex; each of its entries must be positive, convex in D, and either fall
    /// with D and look at D⁻ or rise with D and look at D⁺. Where D⁻ is not positive definite it gives infinity.
    pub fn largest(
        &self,
        cells: Vec<Cell>,
        tolerance: f64,
        budget: usize,
        f: impl Fn(&DMatrix<f64>, &DMatrix<f64>) -> Vec<f64> + Sync,
    ) -> Extremes {
        let pairs: Vec<(usize, Cell)> = (0..self.members.len())
            .flat_map(|member| cells.iter().map(move |c| (member, c.clone())))
            .collect();
        let mut judged: Vec<Judged> =
            pairs.into_par_iter().map(|(member, cell)| self.judge(member, cell, &f)).collect();
        let mut spent: usize = judged.iter().map(|j| j.vertices).sum();
        loop {
            let seen = fold(&judged, |j| &j.seen);
            let excess = |j: &Judged| {
                j.bound.iter().zip(&seen).map(|(b, s)| b / s.max(f64::MIN_POSITIVE)).fold(0.0, f64::max)
            };
            let (mut open, closed): (Vec<Judged>, Vec<Judged>) =
                judged.into_iter().partition(|j| excess(j) > 1.0 + tolerance);
            let room = budget.saturating_sub(spent);
            if open.is_empty() || room == 0 {
                judged = open.into_iter().chain(closed).collect();
                return Extremes { bound: fold(&judged, |j| &j.bound), seen };
            }
            // Stable, so that the order never depends on threads; the worst first, where the budget runs short.
            open.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
            let mut children = Vec::new();
            let mut planned = 0;
            judged = closed;
            for parent in open {
                if planned >= room {
                    judged.push(parent);
                    continue;
                }
                planned += 2 * parent.vertices;
                children.extend(halves(&parent));
            }
            let judge =
                |(member, cell, bound): (usize, Cell, Vec<f64>)| self.judge(member, cell, &f).within(&bound);
            let children: Vec<Judged> = children.into_par_iter().map(judge).collect();
            spent += children.iter().map(|j| j.vertices).sum::<usize>();
            judged.extend(children);
        }
    }

    fn judge(
        &self,
        member: usize,
        cell: Cell,
        f: &impl Fn(&DMatrix<f64>, &DMatrix<f64>) -> Vec<f64>,
    ) -> Judged {
        let Member { arm, curvature, rounding } = &self.members[member];
        let n = arm.dof();
        let rows = mass_matrix(arm, &cell.centre);
        let centre = DMatrix::from_fn(n, n, |i, j| 0.5 * (rows[i][j] + rows[j][i]));
        let scale = |i: usize, j: usize| libm::sqrt(centre[(i, i)] * centre[(j, j)]);
        let mut rest = DMatrix::from_fn(n, n, |i, j| rounding.d[i][j].max(rounding.d[j][i]));
        let mut slopes = Vec::new();
        let (mut split, mut most) = (0, -1.0);
        for k in 0..n {
            if cell.half[k] == 0.0 {
                continue;
            }
            let unit: Vec<f64> = (0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect();
            let c = coriolis(arm, &cell.centre, &unit);
            // ∂_k d_ij = h_ijk + h_jik.
            let slope = DMatrix::from_fn(n, n, |i, j| cell.half[k] * (c[i][j] + c[j][i]));
            let bend = DMatrix::from_fn(n, n, |i, j| {
                let with = |l: usize| curvature[k * n + l][i * n + j] * cell.half[l];
                0.5 * cell.half[k] * (0..n).map(with).sum::<f64>()
            });
            let size = |m: &DMatrix<f64>| -> f64 {
                (0..n * n).map(|e| m[(e / n, e % n)].abs() / scale(e / n, e % n)).fold(0.0, f64::max)
            };
            let (steep, bent) = (size(&slope), size(&bend));
            if steep + bent > most {
                (split, most) = (k, steep + bent);
            }
            rest += bend;
            rest += DMatrix::from_fn(n, n, |i, j| cell.half[k] * (rounding.h[i][j][k] + rounding.h[j][i][k]));
            if steep > FLAT {
                slopes.push(slope);
            } else {
                rest += slope.abs();
            }
        }
        let margin = |i: usize| -> f64 {
            (0..n).map(|j| rest[(i, j)] * libm::sqrt(centre[(i, i)] / centre[(j, j)])).sum()
        };
        let margin = DMatrix::from_fn(n, n, |i, j| if i == j { margin(i) } else { 0.0 });
        let vertices = 1_usize << slopes.len();
        let mut bound: Vec<f64> = Vec::new();
        for vertex in 0..vertices {
            let mut d = centre.clone();
            for (k, slope) in slopes.iter().enumerate() {
                if vertex >> k & 1 == 1 { d -= slope } else { d += slope }
            }
            let values = f(&(&d - &margin), &(&d + &margin));
            bound = if bound.is_empty() { values } else { larger(&bound, &values) };
        }
        Judged { seen: f(&centre, &centre), member, bound, cell, split, vertices }
    }
}

impl Judged {
    /// What held for the parent holds for its halves.
    fn within(mut self, parent: &[f64]) -> Self {
        self.bound.iter_mut().zip(parent).for_each(|(own, parent)| *own = own.min(*parent));
        self
    }
}

fn halves(parent: &Judged) -> Vec<(usize, Cell, Vec<f64>)> {
    let k = parent.split;
    let side = |sign: f64| {
        let mut cell = parent.cell.clone();
        cell.half[k] *= 0.5;
        cell.centre[k] += sign * cell.half[k];
        (parent.member, cell, parent.bound.clone())
    };
    vec![side(-1.0), side(1.0)]
}

fn larger(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a.max(*b)).collect()
}

fn fold(judged: &[Judged], of: impl Fn(&Judged) -> &Vec<f64>) -> Vec<f64> {
    judged.iter().map(|j| of(j).clone()).reduce(|a, b| larger(&a, &b)).unwrap_or_default()
}
