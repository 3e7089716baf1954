//! The minimax refit against least squares: how much lower the bounds are that count.

use std::path::Path;

use gramforge::Generation;
use gramforge::internals::bounds::{Effort, certified};
use gramforge::internals::domain::Measure;
use gramforge::internals::lagrangian::Lagrangian;
use gramforge::internals::reduction::{Reduced, extremes, minimax, shared, weight};
use gramforge::load::load;
use gramforge::spec::ModelSpec;

/// The stages up to the measure, of a committed specification.
fn stages(name: &str) -> (Generation, Measure) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../generated/specs/{name}.json"));
    let mut loaded = load(&path).expect("a specification");
    loaded.spec.model = ModelSpec::Exact;
    let generation = Generation::new(loaded).expect("a model");
    let measure = Measure::new(generation.domain(), generation.arm());
    (generation, measure)
}

/// Σ_m √w_m Δα_m.
fn weighted(lagrangian: &Lagrangian, measure: &Measure, deltas: &[f64]) -> f64 {
    let term = |(c, delta): (_, &f64)| weight(c, measure).sqrt() * delta;
    lagrangian.coefficients.iter().zip(deltas).map(term).sum()
}

/// Prints Σ√w_m Δα_m for both refits and checks that minimax lowers it by at least the given fraction for each ξ.
fn assert_lower(name: &str, expected: &[(usize, f64)]) {
    let (generation, measure) = stages(name);
    let (lagrangian, domain) = (generation.lagrangian(), generation.domain());
    let points = extremes(&measure, domain);
    println!("{name}, refit over {} points\n xi  least squares  minimax  lower by", points.len());
    for &(functions, fraction) in expected {
        let squares = shared(lagrangian, &measure, functions);
        let uniform = minimax(lagrangian, squares.clone(), &points);
        assert_eq!((&uniform.selected, &uniform.simplified), (&squares.selected, &squares.simplified));
        let bound = |reduced: &Reduced| {
            let proofs = certified(lagrangian, reduced, domain, &Effort::default());
            weighted(lagrangian, &measure, &proofs.iter().map(|proof| proof.bound).collect::<Vec<_>>())
        };
        let (before, after) = (bound(&squares), bound(&uniform));
        let lower = 1.0 - after / before;
        println!("{functions:3}  {before:13.5}  {after:7.5}  {:6.1} %", 100.0 * lower);
        assert!(lower >= fraction, "{name}, xi = {functions}: {lower} instead of {fraction}");
    }
}

/// At ξ = 4 the optimum itself is only 14 % lower.
#[test]
fn bounds_of_the_puma_560_fall() {
    assert_lower("puma560_xi12", &[(4, 0.13), (6, 0.20), (8, 0.30), (10, 0.35), (12, 0.35)]);
}

/// One function for all: nearly nothing to gain, and it must be gained.
#[test]
fn bounds_of_the_three_link_arm_fall() {
    assert_lower("arm3_xi1", &[(1, 0.04), (2, 0.10)]);
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let (generation, measure) = stages("puma560_xi12");
    let (lagrangian, domain) = (generation.lagrangian(), generation.domain());
    let points = extremes(&measure, domain);
    let squares = shared(lagrangian, &measure, 8);
    let refit = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| minimax(lagrangian, squares.clone(), &points))
    };
    assert_eq!(refit(1), refit(3));
}
