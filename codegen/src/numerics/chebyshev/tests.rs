//! Known best approximations, and the certificate of optimality.

use super::super::basis::Basis;
use super::super::vector::dot;
use super::{Fit, fit, fit_below, residuals, spanning_points};
use crate::numerics::low_discrepancy::LowDiscrepancy;

/// Points of an arc |θ| ≤ `half`.
fn arc(half: f64) -> Vec<f64> {
    (0..=4000).map(|i| half * (f64::from(i) / 2000.0 - 1.0)).collect()
}

fn best(columns: &[Vec<f64>], values: &[f64]) -> (Basis, Fit) {
    let basis = Basis::new(columns);
    let fit = fit(&basis, values, &spanning_points(&basis));
    (basis, fit)
}

/// No parameters do better than `level`: the multipliers of the reference prove it.
fn assert_optimal(basis: &Basis, values: &[f64], fit: &Fit) {
    let count = basis.directions.len();
    assert_eq!(fit.reference.len(), count + 1);
    let mut residual = vec![0.0; values.len()];
    residuals(&basis.directions, values, &fit.parameters, &mut residual);
    for active in &fit.reference {
        let reached = active.sign * residual[active.point];
        assert!((reached - fit.level).abs() <= 2e-6 * fit.level, "{reached} {}", fit.level);
    }
    let lu = super::Lu::new(super::rows(&basis.directions, &fit.reference)).expect("a regular reference");
    let mut unit = vec![0.0; count + 1];
    unit[count] = 1.0;
    let multipliers = lu.solve_transposed(&unit);
    assert!(multipliers.iter().all(|&x| x > -1e-9), "{multipliers:?}");
    let right: Vec<f64> = fit.reference.iter().map(|a| a.sign * values[a.point]).collect();
    assert!((dot(&multipliers, &right) - fit.level).abs() < 1e-9 * fit.level);
    assert!(fit.deviation <= fit.level * (1.0 + 1e-6));
}

#[test]
fn a_fourth_power_of_the_cosine_by_three_harmonics() {
    // With x = cos θ on [a, b] the best cubic leaves 2 ((b − a)/4)⁴ of x⁴, at five points with changing signs.
    for half in [0.6_f64, 1.4, 3.0] {
        let points = arc(half);
        let columns: Vec<Vec<f64>> =
            (0..4).map(|k| points.iter().map(|t| libm::cos(f64::from(k) * t)).collect()).collect();
        let values: Vec<f64> = points.iter().map(|t| libm::pow(libm::cos(*t), 4.0)).collect();
        let (basis, fit) = best(&columns, &values);
        let expected = 2.0 * libm::pow((1.0 - libm::cos(half)) / 4.0, 4.0);
        assert!((fit.deviation / expected - 1.0).abs() < 1e-4, "{} {expected}", fit.deviation);
        assert_optimal(&basis, &values, &fit);
        let mut reference = fit.reference.clone();
        reference.sort_by(|a, b| points[a.point].abs().total_cmp(&points[b.point].abs()));
        assert!(reference.windows(2).all(|pair| pair[0].sign == -pair[1].sign));
    }
}

#[test]
fn a_half_angle_by_full_cubic_harmonics() {
    // 1, cos θ … sin 3θ on a full turn leave of cos 4θ all of it: the error equioscillates already.
    let points = arc(std::f64::consts::PI);
    let mut columns = Vec::new();
    for k in 0..=3 {
        columns.push(points.iter().map(|t| libm::cos(f64::from(k) * t)).collect());
        columns.push(points.iter().map(|t| libm::sin(f64::from(k) * t)).collect());
    }
    let values: Vec<f64> = points.iter().map(|t| libm::cos(4.0 * t)).collect();
    let (basis, fit) = best(&columns, &values);
    assert_eq!(basis.directions.len(), 7, "sin 0 is no function");
    assert!((fit.deviation - 1.0).abs() < 1e-9);
}

#[test]
fn many_variables_have_a_certified_optimum() {
    let spread = LowDiscrepancy::new(4);
    let points: Vec<Vec<f64>> = (0..1500).map(|i| spread.point(i)).collect();
    for count in [1, 5, 16] {
        let wave = |k: usize, q: &[f64]| {
            let angle: f64 = q.iter().enumerate().map(|(j, q)| ((k * 7 + j * 3) % 5) as f64 * q).sum();
            libm::cos(angle + k as f64)
        };
        let columns: Vec<Vec<f64>> =
            (0..count).map(|k| points.iter().map(|q| wave(k, q)).collect()).collect();
        let values: Vec<f64> =
            points.iter().map(|q| libm::exp(q[0] - q[1]) * libm::sin(3.0 * q[2] + q[3])).collect();
        let (basis, found) = best(&columns, &values);
        assert_optimal(&basis, &values, &found);
        let again = fit(&basis, &values, &spanning_points(&basis));
        assert_eq!(again, found);
    }
}

#[test]
fn what_cannot_be_improved_is_left_alone() {
    let nothing = Basis::new(&[vec![0.0; 3]]);
    assert_eq!(fit(&nothing, &[1.0, -2.0, 0.5], &[]).deviation, 2.0);
    let (_, exact) = best(&[vec![1.0, 1.0, 1.0]], &[0.0, 0.0, 0.0]);
    assert_eq!((exact.deviation, exact.parameters), (0.0, vec![0.0]));
    // Fewer points than functions need: nothing to exchange.
    let (_, few) = best(&[vec![1.0, 2.0], vec![1.0, -1.0]], &[3.0, 4.0]);
    assert_eq!(few.deviation, 4.0);
}

#[test]
fn a_fit_below_what_can_be_reached_ends_early_and_any_other_is_the_same() {
    let points = arc(1.4);
    let columns: Vec<Vec<f64>> =
        (0..5).map(|k| points.iter().map(|t| libm::cos(f64::from(k) * t)).collect()).collect();
    let values: Vec<f64> = points.iter().map(|t| libm::exp(*t)).collect();
    let basis = Basis::new(&columns);
    let start = spanning_points(&basis);
    let best = fit(&basis, &values, &start);
    assert!(best.level > 0.0);
    for most in [best.deviation, 1.5 * best.deviation] {
        assert_eq!(fit_below(&basis, &values, &start, most), best);
    }
    for part in [0.999, 0.5, 0.01] {
        let most = part * best.level;
        let early = fit_below(&basis, &values, &start, most);
        assert!(early.level > most && early.deviation > most, "{part}");
    }
}
