//! Bounds and the design that rests on them: ΔC and k*.

use gramforge::internals::bounds::Bounds;
use gramforge::internals::domain::Measure;
use gramforge::internals::lagrangian::evaluate;
use gramforge_tests::generation;
use gramforge_tests::random::Random;
use nalgebra::DMatrix;

#[test]
fn an_exact_model_has_zero_bounds() {
    let exact = generation("arm3_exact");
    let zero = |bounds: &Bounds| {
        let h = bounds.h.iter().flatten().flatten();
        bounds.d.iter().flatten().chain(h).chain(&bounds.g).all(|&x| x == 0.0)
    };
    assert!(zero(exact.bounds()));
    assert_eq!(exact.design().unwrap().k_star, 0.0);
    assert!(!zero(generation("arm3_xi2").bounds()));
}

#[test]
fn no_bound_is_below_what_the_measure_has_seen() {
    for spec in [
        "arm3_xi1",
        "arm3_xi2",
        "arm3_xi3",
        "arm3_waypoints",
        "arm3_sinusoids",
        "puma560_xi6",
        "puma560_xi12",
        "ur5",
        "stanford",
    ] {
        let made = generation(spec);
        let (lagrangian, reduced) = (made.lagrangian(), made.reduced());
        let deltas: Vec<f64> = made.certificates().iter().map(|proof| proof.bound).collect();
        let measure = Measure::new(made.domain(), made.arm());
        let residuals: Vec<_> = (0..deltas.len()).map(|m| reduced.residual(lagrangian, m)).collect();
        let mut tightest = 0.0_f64;
        for q in &measure.points {
            let psi = lagrangian.evaluate_functions(q);
            for (m, terms) in residuals.iter().enumerate() {
                let seen = evaluate(terms, &psi).abs();
                if deltas[m] > 0.0 {
                    tightest = tightest.max(seen / deltas[m]);
                }
                let name = lagrangian.coefficients[m].name();
                assert!(seen <= deltas[m], "{spec}: {name} is off by {seen} at {q:?}, bound {}", deltas[m]);
            }
        }
        println!("{spec}: the measure's points reach {tightest:.4} of a bound");
    }
}

#[test]
fn coriolis_bounds_are_equation_30() {
    let made = generation("puma560_xi12");
    let design = made.design().unwrap();
    let (h, speed) = (&made.bounds().h, &design.envelope.speed);
    let desired = made.motion().unwrap().largest_speed();
    for i in 0..6 {
        assert!(speed[i] >= desired[i]);
        for j in 0..6 {
            let mut sum = 0.0;
            for k in 0..6 {
                sum += h[i][j][k] * speed[k];
            }
            assert!((design.delta_c[i][j] - sum).abs() <= 1e-15 * sum, "{i} {j}");
        }
    }
}

#[test]
fn k_star_is_enough_and_no_less_is() {
    let mut random = Random::new(7);
    for spec in ["arm3_xi1", "arm3_xi2", "puma560_xi6", "stanford"] {
        let made = generation(spec);
        let design = made.design().unwrap();
        let n = design.delta_c.len();
        // λ_min(k·I + sym δC), δC_ij = part(i, j) ΔC_ij.
        let smallest = |k: f64, part: &mut dyn FnMut() -> f64| {
            let delta = DMatrix::from_fn(n, n, |i, j| part() * design.delta_c[i][j]);
            let sum = DMatrix::identity(n, n) * k + (&delta + delta.transpose()) * 0.5;
            sum.symmetric_eigenvalues().min()
        };
        let k = design.k_star;
        let mut least = f64::INFINITY;
        for trial in 0..2000 {
            // Inside the box, and at its corners.
            let mut part = || if trial % 2 == 0 { random.signed() } else { random.signed().signum() };
            least = least.min(smallest(k, &mut part));
        }
        let (worst, short) = (smallest(k, &mut || -1.0), smallest(0.99 * k, &mut || -1.0));
        println!(
            "{spec}: k* = {k:.4}; least eigenvalue {least:.2e} at random, {worst:.1e} at worst, {short:.1e} with 0.99 k*"
        );
        assert!(least >= -1e-12 * k.max(1.0) && worst.abs() <= 1e-12 * k.max(1.0));
        assert!(short < 0.0);
    }
}
