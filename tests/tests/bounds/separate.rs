//! Mode `separate`: every coefficient picks functions of its own.

use std::path::Path;

use gramforge::Effort;
use gramforge::Generation;
use gramforge::internals::lagrangian::evaluate;
use gramforge::internals::numerics::low_discrepancy::{LowDiscrepancy, in_box};
use gramforge::internals::reduction::Reduced;
use gramforge::load::load;
use gramforge::spec::{ModelSpec, RefitSpec};

/// The PUMA 560's first three links; full certificates are tested elsewhere.
fn made(functions: usize, refit: RefitSpec) -> Generation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/puma3.json");
    let mut loaded = load(&path).unwrap();
    loaded.spec.model = ModelSpec::Separate { functions };
    loaded.spec.refit = refit;
    Generation::with_effort(loaded, &Effort::default().boxes(2_000)).unwrap()
}

fn kept(reduced: &Reduced, m: usize) -> Vec<usize> {
    reduced.combinations[m].iter().map(|&(l, _)| l).collect()
}

#[test]
fn one_function_more_is_added_to_each_coefficient() {
    let models: Vec<Generation> = (1..=4).map(|xi| made(xi, RefitSpec::LeastSquares)).collect();
    for (xi, pair) in (1..).zip(models.windows(2)) {
        let (small, large) = (&pair[0].reduced(), &pair[1].reduced());
        for m in 0..small.combinations.len() {
            if large.simplified[m] {
                assert!(small.simplified[m]);
                assert!(kept(small, m).len() <= xi);
                assert!(
                    kept(small, m).iter().all(|l| kept(large, m).contains(l)),
                    "ξ = {xi}, coefficient {m}"
                );
            }
        }
    }
    // Coefficients differ in what they keep: that is the mode's point.
    let reduced = &models[0].reduced();
    let first: Vec<_> = (0..reduced.combinations.len()).filter(|&m| reduced.simplified[m]).collect();
    assert!(first.iter().any(|&m| kept(reduced, m) != kept(reduced, first[0])));
}

#[test]
fn no_position_exceeds_a_bound() {
    for refit in [RefitSpec::LeastSquares, RefitSpec::Minimax] {
        let made = made(2, refit);
        let spread = LowDiscrepancy::new(made.arm().dof() + 1);
        let mut seen = 0.0_f64;
        for index in 0..4_000 {
            let unit = spread.point(index);
            let q: Vec<f64> = match made.domain() {
                gramforge::internals::domain::Domain::Tube(motion, errors) => {
                    let centre = motion.at(motion.duration() * unit[made.arm().dof()]).q;
                    centre.iter().zip(errors).zip(&unit).map(|((q, e), u)| q + e * (2.0 * u - 1.0)).collect()
                }
                gramforge::internals::domain::Domain::Workspace(limits) => in_box(limits, &unit),
                _ => continue,
            };
            let psi = made.lagrangian().evaluate_functions(&q);
            for (m, certificate) in made.certificates().iter().enumerate() {
                let left = evaluate(&made.reduced().residual(made.lagrangian(), m), &psi).abs();
                assert!(left <= certificate.bound, "coefficient {m}: {left} > {}", certificate.bound);
                seen = seen.max(left);
            }
        }
        assert!(seen > 0.0);
    }
}

#[test]
fn minimax_lowers_what_was_found() {
    let (least, minimax) = (made(2, RefitSpec::LeastSquares), made(2, RefitSpec::Minimax));
    let sum = |made: &Generation| made.certificates().iter().map(|c| c.found).sum::<f64>();
    assert!(sum(&minimax) < 0.95 * sum(&least), "{} {}", sum(&minimax), sum(&least));
}

#[test]
fn enough_functions_give_the_exact_model() {
    let made = made(13, RefitSpec::Minimax);
    assert!(!made.reduced().simplified.contains(&true));
    assert!(made.certificates().iter().all(|c| c.bound == 0.0));
    let (q, qd, v, a) = ([0.3, -0.7, 1.1], [1.0, 0.4, -0.2], [0.2, 0.9, 0.5], [-1.0, 2.0, 0.3]);
    let exact: Vec<f64> = made.exact_code().interpret(&q, &qd, &v, &a);
    for (x, y) in made.code().interpret(&q, &qd, &v, &a).iter().zip(&exact) {
        assert!((x - y).abs() <= 1e-10 * y.abs().max(1.0));
    }
}
