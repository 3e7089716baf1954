//! The expansion: sample D and G on a tensor grid, transform, differentiate for h.

use std::collections::BTreeMap;

use super::coefficients::{Accuracy, Entry, Layers, distinct};
use super::coupled;
use super::table::{Table, gravity_axes, mass_matrix_axes, merged};
use super::transform::{Axis, grid_point, grid_size, transform};
use super::{Combination, Lagrangian};
use crate::arm::{Arm, Body, JointKind, Uncertainty};
use crate::dynamics::{Size, Sizes, gravity, mass_matrix, rounding};
use crate::numerics::low_discrepancy::LowDiscrepancy;
use crate::parallel::Parallelize;

/// Positions at which the rounding of the samples is looked at.
const LOOKED_AT: usize = 48;
/// Terms up to this many times that are rounding: the transform takes as much as the samples.
const ROUNDING: f64 = 2.0;
/// A term below this part of its coefficient's largest one is lost when they are added.
const LOST: f64 = 0.5 * f64::EPSILON;
/// Roundings behind each sample at most, as a part of what is summed.
const SAMPLED: f64 = 512.0 * f64::EPSILON;

/// Expands the exact model (1) of `arm` over the harmonic dictionary.
///
/// In each revolute joint d_ij is a trigonometric polynomial of degree ≤ 2 and g_i of degree ≤ 1, in each
/// prismatic joint both are polynomials of degree ≤ 2, so sampling and inverting the transform is exact
/// to rounding. h_ijk = ½(∂d_ij/∂q_k + ∂d_ik/∂q_j − ∂d_jk/∂q_i).
pub fn expand(arm: &Arm) -> Lagrangian {
    expand_family(arm, &Uncertainty::default())
}

/// The same for a family of arms: the model is linear in the inertial parameters, so its derivative by each uncertain
/// one is the model of an arm that has that parameter alone.
pub fn expand_family(arm: &Arm, uncertainty: &Uncertainty) -> Lagrangian {
    let table = Table::of(arm);
    let mut layers = vec![entries(arm, &table)];
    layers.extend((0..uncertainty.parameters.len()).map(|k| entries(&uncertainty.alone(arm, k), &table)));
    let mut columns: Vec<_> = layers.into_iter().map(Vec::into_iter).collect();
    let joined = Entry::all(arm.dof())
        .map(|entry| {
            let (layers, errors) = columns.iter_mut().filter_map(Iterator::next).unzip();
            Layers { entry, layers, errors }
        })
        .collect();
    let ranges = uncertainty.parameters.iter().map(|p| [p.low, p.high]).collect();
    Lagrangian { ranges, ..distinct(arm.dof(), &table.functions, joined) }
}

/// d_ij with i ≤ j, h_ijk with j ≤ k and g_i, and how well each is known.
///
/// The model is the sum of those of single bodies on the joints that carry them. Each is expanded by itself, so that what a
/// light hand adds to a heavy arm's inertia is not taken from a difference of large numbers. What is a term and what is
/// rounding is decided here and nowhere else: by what the entry itself rounds by in the recursion behind the samples.
fn entries(arm: &Arm, table: &Table) -> Vec<(Combination, Accuracy)> {
    if arm.linkage.is_some() {
        return expanded(arm, table);
    }
    let n = arm.dof();
    let mut parts: Vec<BTreeMap<Entry, (Combination, Accuracy)>> = Vec::new();
    for (index, joint) in arm.joints.iter().enumerate() {
        if joint.body == Body::default() && joint.armature == 0.0 {
            continue;
        }
        let mut alone = arm.clone();
        alone.joints.truncate(index + 1);
        for carrier in &mut alone.joints[..index] {
            (carrier.body, carrier.armature) = (Body::default(), 0.0);
        }
        parts.push(Entry::all(index + 1).zip(expanded(&alone, table)).collect());
    }
    let entries: Vec<Entry> = Entry::all(n).collect();
    entries.into_par_iter().map(|entry| sum(parts.iter().filter_map(|part| part.get(&entry)))).collect()
}

/// The sum of expansions of one entry. Terms that cancel leave no more than they were known to.
fn sum<'a>(parts: impl Iterator<Item = &'a (Combination, Accuracy)>) -> (Combination, Accuracy) {
    // By function the value and what it may be off by.
    let mut terms: Vec<(usize, [f64; 2])> = Vec::new();
    let mut known = Accuracy::default();
    for (expansion, accuracy) in parts {
        known.error += accuracy.error;
        // A body that adds nothing to the entry does not blur it.
        if !expansion.is_empty() {
            known.resolution += accuracy.resolution;
        }
        let noise = |k: f64| accuracy.resolution + 2.0 * f64::EPSILON * k.abs();
        let mut out = Vec::with_capacity(terms.len() + expansion.len());
        let mut rest = expansion.iter().copied().peekable();
        for (l, [value, blur]) in terms {
            while let Some((l, k)) = rest.next_if(|term| term.0 < l) {
                out.push((l, [k, noise(k)]));
            }
            out.push(match rest.next_if(|term| term.0 == l) {
                Some((_, k)) => (l, [value + k, blur + noise(k)]),
                None => (l, [value, blur]),
            });
        }
        out.extend(rest.map(|(l, k)| (l, [k, noise(k)])));
        terms = out;
    }
    let mut out = Combination::with_capacity(terms.len());
    for (l, [value, noise]) in terms {
        if value.abs() > noise {
            out.push((l, value));
        } else {
            known.error += value.abs();
        }
    }
    (out, known)
}

/// The same of an arm as a whole.
fn expanded(arm: &Arm, table: &Table) -> Vec<(Combination, Accuracy)> {
    let n = arm.dof();
    // The nodes of a prismatic axis are −1, 0 and 1 m.
    let sizes = Sizes::within(arm, &vec![1.0; arm.moving().len()]);
    let grown: f64 = arm.moving().iter().map(|joint| lebesgue(joint.kind)).product::<f64>();
    let (spread, steep) = arm.linkage.as_ref().map_or((1.0, 1.0), |linkage| coupled::growth(linkage));
    let grown = grown * spread;
    let (noise_d, noise_g) = noise(arm);
    let own = |raw: Combination, noise: f64, size: Size| {
        significant(raw, ROUNDING * noise, SAMPLED * grown * size.exact)
    };
    let d = expand_mass_matrix(arm, table);
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).collect();
    let d: BTreeMap<(usize, usize), _> = d
        .into_iter()
        .zip(pairs)
        .map(|(raw, (i, j))| ((i, j), own(raw, noise_d[i][j], sizes.mass_matrix[i][j])))
        .collect();
    let g: Vec<_> = expand_gravity(arm, table)
        .into_iter()
        .zip(noise_g.iter().zip(&sizes.gravity))
        .map(|(raw, (&noise, &size))| own(raw, noise, size))
        .collect();
    let entries: Vec<Entry> = Entry::all(n).collect();
    entries
        .into_par_iter()
        .map(|entry| match entry {
            Entry::D(i, j) => d[&(i, j)].clone(),
            Entry::H(i, j, k) => {
                let parts = [(i, j), (i, k), (j, k)].map(|(i, j)| &d[&(i.min(j), i.max(j))]);
                let raw = christoffel(table, parts.map(|part| &part.0), [k, j, i]);
                // A derivative along one joint is at most twice as large, or as often as others follow it, and three are
                // halved.
                let known = Accuracy::sum(parts.iter().map(|part| (steep, part.1)));
                significant(raw, known.resolution, known.error)
            }
            Entry::G(i) => g[i].clone(),
        })
        .collect()
}

/// The most that entries of D and G were found to round by.
fn noise(arm: &Arm) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = arm.dof();
    let spread = LowDiscrepancy::new(n);
    let at = |index: usize| {
        let angle = |u: f64| std::f64::consts::PI * (2.0 * u - 1.0);
        let kinds = arm.moving().iter().map(|joint| joint.kind);
        let position = |(kind, u): (JointKind, f64)| match kind {
            JointKind::Revolute => angle(u),
            JointKind::Prismatic => 2.0 * u - 1.0,
        };
        let q: Vec<f64> = kinds.zip(spread.point(index)).map(position).collect();
        rounding(arm, &q)
    };
    let larger = |a: Vec<f64>, b: Vec<f64>| a.into_iter().zip(b).map(|(a, b)| a.max(b)).collect();
    let none = (vec![vec![0.0; n]; n], vec![0.0; n]);
    (0..LOOKED_AT).map(at).fold(none, |most, now| {
        (most.0.into_iter().zip(now.0).map(|(a, b)| larger(a, b)).collect(), larger(most.1, now.1))
    })
}

/// How much larger than an error at the nodes of one axis the interpolated error can be between them.
fn lebesgue(kind: JointKind) -> f64 {
    match kind {
        // 5 equispaced angles: 1.99, 3 angles: 1.67.
        JointKind::Revolute => 2.0,
        // −1, 0 and 1, as a part of max(1, q²).
        JointKind::Prismatic => 4.0,
    }
}

/// D by rows, from the diagonal on.
fn expand_mass_matrix(arm: &Arm, table: &Table) -> Vec<Combination> {
    match &arm.linkage {
        None => mass_matrix_terms(arm, table),
        Some(linkage) => {
            let chain = Table::of(&linkage.chain);
            coupled::mass_matrix(arm, linkage, (&chain, &mass_matrix_terms(&linkage.chain, &chain)), table)
        }
    }
}

/// The same for joints that move by themselves.
fn mass_matrix_terms(arm: &Arm, table: &Table) -> Vec<Combination> {
    let n = arm.dof();
    let axes = mass_matrix_axes(&kinds(arm));
    let places = table.places(&axes);
    let samples = sample(&axes, |q| mass_matrix(arm, q).concat());
    let upper: Vec<usize> = (0..n).flat_map(|i| (i..n).map(move |j| i * n + j)).collect();
    upper
        .into_par_iter()
        .map(|entry| {
            let column: Vec<f64> = samples.iter().map(|sample| sample[entry]).collect();
            table.collect(&places, &transform(&axes, &column))
        })
        .collect()
}

/// G by joint.
fn expand_gravity(arm: &Arm, table: &Table) -> Vec<Combination> {
    match &arm.linkage {
        None => gravity_terms(arm, table),
        Some(linkage) => {
            let chain = Table::of(&linkage.chain);
            coupled::gravity(arm, linkage, (&chain, &gravity_terms(&linkage.chain, &chain)), table)
        }
    }
}

/// The same for joints that move by themselves.
fn gravity_terms(arm: &Arm, table: &Table) -> Vec<Combination> {
    let axes = gravity_axes(&kinds(arm));
    let places = table.places(&axes);
    let samples = sample(&axes, |q| gravity(arm, q));
    let column = |i: usize| samples.iter().map(|sample| sample[i]).collect::<Vec<_>>();
    (0..arm.dof()).map(|i| table.collect(&places, &transform(&axes, &column(i)))).collect()
}

fn kinds(arm: &Arm) -> Vec<JointKind> {
    arm.joints.iter().map(|joint| joint.kind).collect()
}

/// Values of `f` on the grid, in grid order.
fn sample(axes: &[Axis], f: impl Fn(&[f64]) -> Vec<f64> + Sync) -> Vec<Vec<f64>> {
    (0..grid_size(axes))
        .into_par_iter()
        .map(|index| {
            let point = grid_point(axes, index);
            let q: Vec<f64> = axes.iter().zip(point).map(|(axis, k)| axis.nodes[k]).collect();
            f(&q)
        })
        .collect()
}

/// The terms that are above `rounding` and not lost beside the largest of them, and how well they are known where the
/// samples were known to `sampled`.
fn significant(mut terms: Combination, rounding: f64, sampled: f64) -> (Combination, Accuracy) {
    let largest = terms.iter().fold(0.0, |most: f64, (_, k)| most.max(k.abs()));
    let resolution = rounding.max(LOST * largest);
    let dropped: f64 = terms.iter().map(|(_, k)| k.abs()).filter(|k| *k <= resolution).sum();
    terms.retain(|(_, k)| k.abs() > resolution);
    (terms, Accuracy { resolution, error: dropped + sampled })
}

/// h_ijk from d_ij, d_ik and d_jk by exact differentiation along k, j and i.
fn christoffel(table: &Table, d: [&Combination; 3], along: [usize; 3]) -> Combination {
    let parts = d.into_iter().zip(along).zip([0.5, 0.5, -0.5]);
    parts.fold(Combination::new(), |sum, ((terms, joint), factor)| {
        merged(sum, &table.derivative(terms, joint, factor))
    })
}
