//! The expansion: sample D and G on a tensor grid, transform, differentiate for h.

use std::collections::BTreeMap;

use super::Lagrangian;
use super::coefficients::{Accuracy, Entry, Layers, distinct};
use super::coupled;
use super::function::{Function, MAX_JOINTS, WHOLE};
use super::transform::{Axis, grid_point, grid_size, transform};
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

/// A combination by function rather than by index.
pub type Expansion = BTreeMap<Function, f64>;

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
    let mut layers = vec![entries(arm)];
    layers.extend((0..uncertainty.parameters.len()).map(|k| entries(&uncertainty.alone(arm, k))));
    let mut columns: Vec<_> = layers.into_iter().map(Vec::into_iter).collect();
    let joined = Entry::all(arm.dof())
        .map(|entry| {
            let (layers, errors) = columns.iter_mut().filter_map(Iterator::next).unzip();
            Layers { entry, layers, errors }
        })
        .collect();
    let ranges = uncertainty.parameters.iter().map(|p| [p.low, p.high]).collect();
    Lagrangian { ranges, ..distinct(arm.dof(), joined) }
}

/// d_ij with i ≤ j, h_ijk with j ≤ k and g_i, and how well each is known.
///
/// The model is the sum of those of single bodies on the joints that carry them. Each is expanded by itself, so that what a
/// light hand adds to a heavy arm's inertia is not taken from a difference of large numbers. What is a term and what is
/// rounding is decided here and nowhere else: by what the entry itself rounds by in the recursion behind the samples.
fn entries(arm: &Arm) -> Vec<(Expansion, Accuracy)> {
    if arm.linkage.is_some() {
        return expanded(arm);
    }
    let n = arm.dof();
    let mut parts: Vec<BTreeMap<Entry, (Expansion, Accuracy)>> = Vec::new();
    for (index, joint) in arm.joints.iter().enumerate() {
        if joint.body == Body::default() && joint.armature == 0.0 {
            continue;
        }
        let mut alone = arm.clone();
        alone.joints.truncate(index + 1);
        for carrier in &mut alone.joints[..index] {
            (carrier.body, carrier.armature) = (Body::default(), 0.0);
        }
        parts.push(Entry::all(index + 1).zip(expanded(&alone)).collect());
    }
    let entries: Vec<Entry> = Entry::all(n).collect();
    entries.into_par_iter().map(|entry| sum(parts.iter().filter_map(|part| part.get(&entry)))).collect()
}

/// The sum of expansions of one entry. Terms that cancel leave no more than they were known to.
fn sum<'a>(parts: impl Iterator<Item = &'a (Expansion, Accuracy)>) -> (Expansion, Accuracy) {
    let mut terms: BTreeMap<Function, [f64; 2]> = BTreeMap::new();
    let mut known = Accuracy::default();
    for (expansion, accuracy) in parts {
        known.error += accuracy.error;
        // A body that adds nothing to the entry does not blur it.
        if !expansion.is_empty() {
            known.resolution += accuracy.resolution;
        }
        for (&function, &k) in expansion {
            let [value, noise] = terms.entry(function).or_default();
            *value += k;
            *noise += accuracy.resolution + 2.0 * f64::EPSILON * k.abs();
        }
    }
    let mut out = Expansion::new();
    for (function, [value, noise]) in terms {
        if value.abs() > noise {
            out.insert(function, value);
        } else {
            known.error += value.abs();
        }
    }
    (out, known)
}

/// The same of an arm as a whole.
fn expanded(arm: &Arm) -> Vec<(Expansion, Accuracy)> {
    let n = arm.dof();
    // The nodes of a prismatic axis are −1, 0 and 1 m.
    let sizes = Sizes::within(arm, &vec![1.0; arm.moving().len()]);
    let grown: f64 = arm.moving().iter().map(|joint| lebesgue(joint.kind)).product::<f64>();
    let (spread, steep) = arm.linkage.as_ref().map_or((1.0, 1.0), |linkage| coupled::growth(linkage));
    let grown = grown * spread;
    let (noise_d, noise_g) = noise(arm);
    let own = |raw: Expansion, noise: f64, size: Size| {
        significant(raw, ROUNDING * noise, SAMPLED * grown * size.exact)
    };
    let d = expand_mass_matrix(arm);
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).collect();
    let d: BTreeMap<(usize, usize), _> = d
        .into_iter()
        .zip(pairs)
        .map(|(raw, (i, j))| ((i, j), own(raw, noise_d[i][j], sizes.mass_matrix[i][j])))
        .collect();
    let g: Vec<_> = expand_gravity(arm)
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
                let raw = christoffel(parts.map(|part| &part.0), [k, j, i]);
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
fn expand_mass_matrix(arm: &Arm) -> Vec<Expansion> {
    match &arm.linkage {
        None => mass_matrix_terms(arm),
        Some(linkage) => coupled::mass_matrix(arm, linkage, &mass_matrix_terms(&linkage.chain)),
    }
}

/// The same for joints that move by themselves.
fn mass_matrix_terms(arm: &Arm) -> Vec<Expansion> {
    let n = arm.dof();
    // D does not depend on the first joint.
    let axes: Vec<Axis> = arm
        .joints
        .iter()
        .enumerate()
        .map(|(j, joint)| if j == 0 { Axis::constant() } else { Axis::new(joint.kind, 2) })
        .collect();
    let samples = sample(&axes, |q| mass_matrix(arm, q).concat());
    let upper: Vec<usize> = (0..n).flat_map(|i| (i..n).map(move |j| i * n + j)).collect();
    upper
        .into_par_iter()
        .map(|entry| {
            let column: Vec<f64> = samples.iter().map(|sample| sample[entry]).collect();
            collect(arm, &axes, &column)
        })
        .collect()
}

/// G by joint.
fn expand_gravity(arm: &Arm) -> Vec<Expansion> {
    match &arm.linkage {
        None => gravity_terms(arm),
        Some(linkage) => coupled::gravity(arm, linkage, &gravity_terms(&linkage.chain)),
    }
}

/// The same for joints that move by themselves.
fn gravity_terms(arm: &Arm) -> Vec<Expansion> {
    let axes: Vec<Axis> = arm.joints.iter().map(|joint| Axis::new(joint.kind, 1)).collect();
    let samples = sample(&axes, |q| gravity(arm, q));
    (0..arm.dof())
        .map(|i| collect(arm, &axes, &samples.iter().map(|sample| sample[i]).collect::<Vec<_>>()))
        .collect()
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

/// The real canonical terms of a transformed sample array.
fn collect(arm: &Arm, axes: &[Axis], samples: &[f64]) -> Expansion {
    let mut terms = Vec::new();
    for (index, (re, im)) in transform(axes, samples).into_iter().enumerate() {
        let mut kappa = [0; MAX_JOINTS];
        let mut power = [0; MAX_JOINTS];
        for (j, (axis, k)) in axes.iter().zip(grid_point(axes, index)).enumerate() {
            match arm.joints[j].kind {
                JointKind::Revolute => kappa[j] = axis.index[k],
                JointKind::Prismatic => power[j] = axis.index[k].unsigned_abs(),
            }
        }
        // c e^{iκq} and its conjugate partner at −κ together make 2 Re c cos(κq) − 2 Im c sin(κq).
        match kappa.iter().find(|&&k| k != 0) {
            None => terms.push((Function { kappa, power, sine: false, part: WHOLE }, re)),
            Some(&first) if first > 0 => {
                terms.push((Function { kappa, power, sine: false, part: WHOLE }, 2.0 * re));
                terms.push((Function { kappa, power, sine: true, part: WHOLE }, -2.0 * im));
            }
            Some(_) => {}
        }
    }
    terms.into_iter().filter(|(_, k)| *k != 0.0).collect()
}

/// The terms that are above `rounding` and not lost beside the largest of them, and how well they are known where the
/// samples were known to `sampled`.
fn significant(mut terms: Expansion, rounding: f64, sampled: f64) -> (Expansion, Accuracy) {
    let largest = terms.values().fold(0.0, |most: f64, k| most.max(k.abs()));
    let resolution = rounding.max(LOST * largest);
    let dropped: f64 = terms.values().map(|k| k.abs()).filter(|k| *k <= resolution).sum();
    terms.retain(|_, k| k.abs() > resolution);
    (terms, Accuracy { resolution, error: dropped + sampled })
}

/// h_ijk from d_ij, d_ik and d_jk by exact differentiation along k, j and i.
fn christoffel(d: [&Expansion; 3], along: [usize; 3]) -> Expansion {
    let mut sum = Expansion::new();
    for ((expansion, joint), factor) in d.into_iter().zip(along).zip([0.5, 0.5, -0.5]) {
        for (function, value) in expansion {
            if let Some((derivative, slope)) = function.derivative(joint) {
                *sum.entry(derivative).or_insert(0.0) += factor * slope * value;
            }
        }
    }
    sum
}
