//! The minimax refit against least squares: how much lower the bounds are that count.

use std::path::Path;

use gramforge::Generation;
use gramforge::bounds::sampled;
use gramforge::lagrangian::Lagrangian;
use gramforge::load::load;
use gramforge::measure::Measure;
use gramforge::reduction::{Reduced, extremes, minimax, shared, weight};
use gramforge::spec::ModelSpec;

/// The stages up to the measure, of a committed specification.
fn stages(name: &str) -> (Generation, Measure) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../generated/specs/{name}.json"));
    let mut loaded = load(&path).expect("a specification");
    loaded.spec.model = ModelSpec::Exact;
    let generation = Generation::new(loaded).expect("a model");
    let measure = Measure::new(&generation.domain, generation.motion.as_ref(), &generation.arm);
    (generation, measure)
}

/// Σ_m √w_m Δα_m.
fn weighted(lagrangian: &Lagrangian, measure: &Measure, deltas: &[f64]) -> f64 {
    let term = |(c, delta): (_, &f64)| weight(c, measure).sqrt() * delta;
    lagrangian.coefficients.iter().zip(deltas).map(term).sum()
}

#[test]
fn table() {
    for (name, counts) in [("puma560_xi12", vec![4, 6, 8, 10, 12]), ("arm3_xi1", vec![1, 2])] {
        let (generation, measure) = stages(name);
        let Generation { lagrangian, domain, motion, .. } = &generation;
        let points = extremes(&measure, domain, motion.as_ref());
        println!("{name}: {} points", points.len());
        for functions in counts {
            let clock = std::time::Instant::now();
            let squares = shared(lagrangian, &measure, functions);
            let chosen = clock.elapsed();
            let uniform = minimax(lagrangian, squares.clone(), &points);
            let refit = clock.elapsed() - chosen;
            let bound = |reduced: &Reduced| {
                let deltas = sampled(lagrangian, reduced, domain, motion.as_ref());
                weighted(lagrangian, &measure, &deltas)
            };
            let (before, after) = (bound(&squares), bound(&uniform));
            println!(
                "xi = {functions:2}: {before:8.4} -> {after:8.4}  {:5.1} %  chosen {chosen:?} refit {refit:?}",
                100.0 * (1.0 - after / before)
            );
        }
    }
}
