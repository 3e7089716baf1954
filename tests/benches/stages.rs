//! What the stages of generation cost: `cargo bench -p gramforge-tests --bench stages [-- NAME]`.

#![allow(missing_docs, reason = "`criterion_group!` makes a function without any")]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use gramforge::Generation;
use gramforge::internals::bounds::{Effort, certified};
use gramforge::internals::domain::Measure;
use gramforge::internals::lagrangian::expand;
use gramforge::internals::{reduction, torque};
use gramforge_tests::{arm, generation, spec};

fn expansion(c: &mut Criterion) {
    let mut group = c.benchmark_group("expansion");
    for name in ["arm3_exact", "puma560_exact", "ur5"] {
        let arm = arm(name);
        group.bench_function(name, |b| b.iter(|| expand(black_box(&arm))));
    }
    group.finish();
}

fn exact_code(c: &mut Criterion) {
    let mut group = c.benchmark_group("exact code");
    for name in ["arm3_exact", "puma560_exact"] {
        let arm = arm(name);
        let lagrangian = expand(&arm);
        group.bench_function(name, |b| b.iter(|| torque::exact(black_box(&arm), black_box(&lagrangian))));
    }
    group.finish();
}

/// Gram–Schmidt and the minimax refit apart, then the certificates of what they leave.
fn reduction_and_certificates(c: &mut Criterion) {
    for (name, functions) in [("arm3_xi3", 3), ("puma560_xi6", 6)] {
        let made = generation(name);
        let measure = Measure::new(made.domain(), made.arm());
        let mut group = c.benchmark_group("reduction");
        group.bench_function(format!("{name}/gram_schmidt"), |b| {
            b.iter(|| reduction::shared(black_box(made.lagrangian()), &measure, functions));
        });
        let points = reduction::extremes(&measure, made.domain());
        let selected = reduction::shared(made.lagrangian(), &measure, functions);
        group.bench_function(format!("{name}/minimax"), |b| {
            b.iter(|| reduction::minimax(black_box(made.lagrangian()), selected.clone(), &points));
        });
        group.finish();
        c.benchmark_group("certificates").bench_function(name, |b| {
            b.iter(|| {
                certified(black_box(made.lagrangian()), made.reduced(), made.domain(), &Effort::default())
            });
        });
    }
}

/// A whole specification, from the file to the text of the module.
fn whole_generation(c: &mut Criterion) {
    let mut group = c.benchmark_group("generation");
    for name in ["arm3_exact", "arm3_xi2", "puma560_exact"] {
        let path = spec(name);
        group.bench_function(name, |b| {
            b.iter(|| Generation::from_file(black_box(&path)).unwrap().module().unwrap());
        });
    }
    group.finish();
}

fn few_samples() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
}

criterion_group! {
    name = stages;
    config = few_samples();
    targets = expansion, exact_code, reduction_and_certificates, whole_generation
}
criterion_main!(stages);
