//! The expansion of an arm some of whose joints follow others: that of the chain, with q' = J q + o put in.
//!
//! A sum of angles Σ κ_i q'_i is Σ_c (Σ_i κ_i m_i) q_c + Σ_i κ_i o_i, and the multipliers are whole multiples of the
//! parts that the functions count, so that sines of the chain's angles are sines of the coordinates' turned by a
//! constant angle. Powers of prismatic joints are multiplied out. Both are exact but for rounding.

use std::collections::{BTreeMap, BTreeSet};

use super::Combination;
use super::function::{Function, MAX_JOINTS};
use super::table::Table;
use crate::arm::{Arm, JointKind, Linkage};

/// A combination by function rather than by number.
type Expansion = BTreeMap<Function, f64>;

/// Largest total power of prismatic coordinates in D and G; what is found beyond is rounding of the transform, and
/// would be 0 without.
const MOST_POWER: u8 = 2;

/// What `chain`, the functions of the joints, can become as functions of the coordinates, and what is differentiated for h.
pub(super) fn functions(arm: &Arm, linkage: &Linkage, chain: &[Function]) -> Vec<Function> {
    let parts = arm.parts();
    let mut out = BTreeSet::from([Function { part: parts, ..Function::ONE }]);
    for psi in chain.iter().filter(|psi| psi.power.iter().sum::<u8>() <= MOST_POWER) {
        let (turned, _) = angle(psi, linkage, &parts);
        for power in powers(psi, linkage).into_keys() {
            for sine in [false, true] {
                out.extend(Function { power, sine, ..turned }.canonical().map(|found| found.0));
            }
        }
    }
    let along = |psi: &Function| {
        (0..arm.dof()).filter_map(|j| psi.derivative(j)).map(|found| found.0).collect::<Vec<_>>()
    };
    let derivatives: Vec<Function> = out.iter().flat_map(along).collect();
    out.into_iter().chain(derivatives).collect()
}

/// Jᵀ D' J and the armature of the coordinates, by rows from the diagonal on, from D' in the same order.
pub(super) fn mass_matrix(
    arm: &Arm,
    linkage: &Linkage,
    chain: (&Table, &[Combination]),
    table: &Table,
) -> Vec<Combination> {
    let (n, joints) = (arm.dof(), linkage.couplings.len());
    let parts = arm.parts();
    // Number of entry (i, j), i ≤ j, of a symmetric matrix of n rows.
    let place = |i: usize, j: usize, n: usize| i * (2 * n - i + 1) / 2 + (j - i);
    let mut sums: Vec<Expansion> = vec![Expansion::new(); n * (n + 1) / 2];
    for (i, first) in linkage.couplings.iter().enumerate() {
        for (j, second) in linkage.couplings.iter().enumerate() {
            let (a, b) = (first.coordinate, second.coordinate);
            if a > b {
                continue;
            }
            let entry = chain.1.get(place(i.min(j), i.max(j), joints));
            if let (Some(terms), Some(sum)) = (entry, sums.get_mut(place(a, b, n))) {
                add(sum, (chain.0, terms), first.multiplier * second.multiplier, linkage, &parts);
            }
        }
    }
    for (j, joint) in arm.joints.iter().enumerate().filter(|(_, joint)| joint.armature != 0.0) {
        if let Some(sum) = sums.get_mut(place(j, j, n)) {
            *sum.entry(Function { part: parts, ..Function::ONE }).or_insert(0.0) += joint.armature;
        }
    }
    sums.into_iter().map(|sum| numbered(sum, table)).collect()
}

/// By number; of the functions of `sum` the table lacks none.
fn numbered(sum: Expansion, table: &Table) -> Combination {
    sum.into_iter().filter_map(|(psi, k)| Some((table.number(&psi)?, k))).collect()
}

/// Jᵀ G' from the rows of G'.
pub(super) fn gravity(
    arm: &Arm,
    linkage: &Linkage,
    chain: (&Table, &[Combination]),
    table: &Table,
) -> Vec<Combination> {
    let parts = arm.parts();
    let mut sums: Vec<Expansion> = vec![Expansion::new(); arm.dof()];
    for (coupling, terms) in linkage.couplings.iter().zip(chain.1) {
        if let Some(sum) = sums.get_mut(coupling.coordinate) {
            add(sum, (chain.0, terms), coupling.multiplier, linkage, &parts);
        }
    }
    sums.into_iter().map(|sum| numbered(sum, table)).collect()
}

/// By how much an error of the chain's entries grows when q' = J q + o is put in, as a part of Π max(1, q²) with the
/// roundings of that; and how often half the largest frequency of a coordinate is that of a joint.
pub(super) fn growth(linkage: &Linkage) -> (f64, f64) {
    let slides = |(joint, c): (&crate::arm::Joint, &crate::arm::Coupling)| match joint.kind {
        JointKind::Revolute => 1.0,
        JointKind::Prismatic => {
            let most = (c.multiplier.abs() + c.offset.abs()).max(1.0);
            most * most
        }
    };
    let spread: f64 = linkage.chain.joints.iter().zip(&linkage.couplings).map(slides).product();
    let turns = |i: usize| -> f64 {
        linkage.couplings.iter().filter(|c| c.coordinate == i).map(|c| c.multiplier.abs()).sum()
    };
    let steep = (0..linkage.couplings.len()).map(turns).fold(1.0, f64::max);
    (2.0 * spread, steep)
}

/// Adds `factor` times the chain's `terms` to `sum`, over the coordinates.
fn add(
    sum: &mut Expansion,
    (chain, terms): (&Table, &Combination),
    factor: f64,
    linkage: &Linkage,
    parts: &[u8; MAX_JOINTS],
) {
    for &(l, k) in terms {
        let psi = &chain.functions[l];
        if psi.power.iter().sum::<u8>() > MOST_POWER {
            continue;
        }
        let (turned, phase) = angle(psi, linkage, parts);
        // cos(A + φ) = cos φ cos A − sin φ sin A, sin(A + φ) = cos φ sin A + sin φ cos A.
        let (sin, cos) = libm::sincos(phase);
        let other = Function { sine: !turned.sine, ..turned };
        let across = if turned.sine { sin } else { -sin };
        for (power, scale) in powers(psi, linkage) {
            for (psi, part) in [(turned, cos), (other, across)] {
                if let Some((psi, sign)) = (Function { power, ..psi }).canonical() {
                    *sum.entry(psi).or_insert(0.0) += factor * k * scale * sign * part;
                }
            }
        }
    }
}

/// The function of the coordinates that the angles of `psi` make, without powers, and the constant angle beside them.
fn angle(psi: &Function, linkage: &Linkage, parts: &[u8; MAX_JOINTS]) -> (Function, f64) {
    let mut turns = [0.0; MAX_JOINTS];
    let mut phase = 0.0;
    for (coupling, &kappa) in linkage.couplings.iter().zip(&psi.kappa) {
        if let (Some(turns), Some(&part)) =
            (turns.get_mut(coupling.coordinate), parts.get(coupling.coordinate))
        {
            *turns += f64::from(kappa) * coupling.multiplier * f64::from(part);
            phase += f64::from(kappa) * coupling.offset;
        }
    }
    // Whole numbers within the range of i8 by construction of the linkage.
    (
        Function {
            kappa: turns.map(|turns| turns as i8),
            power: [0; MAX_JOINTS],
            sine: psi.sine,
            part: *parts,
        },
        phase,
    )
}

/// Π (m_i q_c + o_i)^power_i multiplied out: exponents of the coordinates with their factors.
fn powers(psi: &Function, linkage: &Linkage) -> BTreeMap<[u8; MAX_JOINTS], f64> {
    let mut product = BTreeMap::from([([0; MAX_JOINTS], 1.0)]);
    for (coupling, &power) in linkage.couplings.iter().zip(&psi.power) {
        for _ in 0..power {
            let mut next = BTreeMap::new();
            for (exponents, factor) in product {
                let mut raised: [u8; MAX_JOINTS] = exponents;
                if let Some(exponent) = raised.get_mut(coupling.coordinate) {
                    *exponent += 1;
                }
                *next.entry(raised).or_insert(0.0) += coupling.multiplier * factor;
                if coupling.offset != 0.0 {
                    *next.entry(exponents).or_insert(0.0) += coupling.offset * factor;
                }
            }
            product = next;
        }
    }
    product
}
