use super::{Cell, MAX_VARIABLES, Part, Range, Stop, edge, folded, range};
use crate::bounds::polynomial::Polynomial;
use crate::bounds::residual::Residual;
use crate::domain::Domain;
use crate::lagrangian::{Function, MAX_JOINTS};
use crate::numerics::low_discrepancy::{LowDiscrepancy, in_box};

const LIMITS: [[f64; 2]; 4] = [[-2.0, 1.5], [-3.0, 3.0], [-0.4, 0.7], [-1.0, 2.5]];

/// Seven sums over three revolute joints and a prismatic one; the first depends on one joint, the last on none.
fn sums() -> Vec<Vec<(Function, f64)>> {
    let spread = LowDiscrepancy::new(7);
    let term = |index: usize| {
        let u = spread.point(index);
        let pick = |x: f64| -2 + (x * 5.0) as i8;
        let mut kappa = [0; MAX_JOINTS];
        (kappa[0], kappa[1], kappa[3]) = ((u[0] * 3.0) as i8, pick(u[1]), pick(u[2]));
        let mut power = [0; MAX_JOINTS];
        power[2] = (u[3] * 3.0) as u8;
        (Function { kappa, power, sine: u[4] > 0.5, ..Function::ONE }, 2.0 * u[5] - 1.0)
    };
    let mut kappa = [0; MAX_JOINTS];
    kappa[3] = 1;
    let first = vec![(Function { kappa, sine: true, ..Function::ONE }, 0.7)];
    let last = vec![(Function::ONE, 0.2)];
    let between = (0..5).map(|sum| (0..6).map(|i| term(6 * sum + i)).collect());
    std::iter::once(first).chain(between).chain([last]).collect()
}

fn value(terms: &[(Function, f64)], q: &[f64]) -> f64 {
    terms.iter().map(|(psi, k)| k * psi.evaluate(q)).sum()
}

/// Σ Ū |r|, Ū = 1, 2, …; the second and the third are vertices of one residual.
fn weighted(sums: &[Vec<(Function, f64)>], q: &[f64]) -> f64 {
    let r: Vec<f64> = sums.iter().map(|terms| value(terms, q).abs()).collect();
    r[0] + 2.0 * r[1].max(r[2]) + (3..7).map(|i| i as f64 * r[i]).sum::<f64>()
}

fn bounded(stop: &Stop) -> Range {
    let domain = Domain::Workspace(LIMITS.to_vec());
    let position_bound: Vec<f64> = LIMITS.iter().map(|[low, high]| low.abs().max(high.abs())).collect();
    let residual = |terms: &Vec<(Function, f64)>| {
        Residual::new(Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k))), &domain, &position_bound)
    };
    let all: Vec<Residual> = sums().iter().map(residual).collect();
    let part = |range: std::ops::Range<usize>, multiplier: f64| Part {
        vertices: &all[range],
        multiplier,
        cap: f64::from(u32::MAX),
    };
    let mut parts = vec![part(0..1, 1.0), part(1..3, 2.0)];
    parts.extend((3..7).map(|i| part(i..i + 1, i as f64)));
    range(&parts, &LIMITS, stop)
}

/// The largest value that dense points, sides among them, and single-joint climbs from the best of them find.
fn found() -> f64 {
    let (sums, spread) = (sums(), LowDiscrepancy::new(4));
    let side = |u: &f64| (0.5 + 1.4 * (u - 0.5)).clamp(0.0, 1.0);
    let point = |index: usize| in_box(&LIMITS, &spread.point(index).iter().map(side).collect::<Vec<_>>());
    let mut starts: Vec<(f64, Vec<f64>)> = (0..40_000).map(point).map(|q| (weighted(&sums, &q), q)).collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let climbed = starts.into_iter().take(20).map(|(mut height, mut q)| {
        let mut step = 0.1;
        while step > 1e-9 {
            let before = height;
            for j in 0..4 {
                for turn in [step, -step] {
                    let mut next = q.clone();
                    next[j] = (next[j] + turn).clamp(LIMITS[j][0], LIMITS[j][1]);
                    let there = weighted(&sums, &next);
                    if there > height {
                        (height, q) = (there, next);
                    }
                }
            }
            step *= if height > before { 1.0 } else { 0.5 };
        }
        height
    });
    climbed.fold(0.0, f64::max)
}

#[test]
fn no_point_exceeds_the_bound_and_the_bound_is_near() {
    let most = found();
    let range = bounded(&Stop { tolerance: 0.01, cells: 100_000, limit: None });
    assert!(range.found <= most * (1.0 + 1e-6) && range.found > 0.99 * most, "{range:?}, searched {most}");
    assert!(most <= range.upper && range.upper < 1.011 * most, "{range:?}, searched {most}");
    // Whenever it stops, the bound holds; the first grid's is a bad one.
    let early = bounded(&Stop { tolerance: 0.0, cells: 0, limit: None });
    assert!(early.upper > range.upper, "{early:?}");
}

#[test]
fn a_limit_is_kept_or_found_exceeded() {
    let most = found();
    let at = |limit: f64| bounded(&Stop { tolerance: 0.0, cells: 100_000, limit: Some(limit) });
    assert!(at(1.01 * most).upper <= 1.01 * most);
    assert!(at(0.99 * most).found > 0.99 * most);
}

/// On every line the bent sum stays below the parabola, and touches it where the bend is as large everywhere.
#[test]
fn an_edge_is_a_chord_with_a_parabola() {
    for slope in [0.0, 0.3, 1.0, 1.9, 2.1, 5.0] {
        let (h, b) = (0.7, 2.0);
        let f = |x: f64| slope * x + 0.5 * b * (h * h - x * x);
        let largest = (0..=100_000).map(|i| f(h * (2.0 * f64::from(i) / 1e5 - 1.0))).fold(f64::MIN, f64::max);
        let bound = edge(-slope * h, slope * h, 0.5 * h * h * b);
        assert!(bound >= largest - 1e-12 && bound < largest + 1e-8, "{slope}: {bound} {largest}");
    }
}

#[test]
fn corners_fold_over_all_sides() {
    let mut cell = Cell { low: [0.0; MAX_VARIABLES], high: [0.0; MAX_VARIABLES] };
    (cell.high[0], cell.high[1]) = (2.0, 4.0);
    // 1 + x(2 − x)/2 · 3 + y(4 − y)/2 · 0.5 is 1 at all corners and 1 + 1.5 + 1 in the middle.
    assert_eq!(folded(&mut [1.0; 4], &cell, &[3.0, 0.5]), 3.5);
}
