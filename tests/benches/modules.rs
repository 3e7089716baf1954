//! What one passivity torque of each generated module costs: `cargo bench -p gramforge-tests --bench modules`.
//!
//! Instructions, which repeat on a busy machine as nanoseconds do not, are counted by `tests/peers/compare.py`.

#![allow(missing_docs, reason = "`criterion_group!` makes a function without any")]

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main};
use gramforge_generated::{
    arm3_exact, arm3_xi1, arm3_xi2, arm3_xi3, puma560_exact, puma560_xi6, puma560_xi12,
};
use gramforge_runtime::Model;
use gramforge_tests::random::Random;

/// States that one measured call takes in turn.
const STATES: usize = 256;

fn torque<const N: usize>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    model: &impl Model<N, Scalar = f64>,
) {
    let mut random = Random::new(7);
    let states: Vec<[[f64; N]; 4]> = (0..STATES)
        .map(|_| [random.array(3.0), random.array(2.0), random.array(2.0), random.array(10.0)])
        .collect();
    let mut next = states.iter().cycle();
    group.bench_function(name, |b| {
        b.iter(|| {
            let [q, qd, v_r, a_r] = next.next().expect("cycles for ever");
            model.passivity_torque(black_box(q), black_box(qd), black_box(v_r), black_box(a_r))
        });
    });
}

fn modules(c: &mut Criterion) {
    let mut group = c.benchmark_group("passivity torque");
    torque(&mut group, "arm3_xi1", &arm3_xi1::Arm3Xi1);
    torque(&mut group, "arm3_xi2", &arm3_xi2::Arm3Xi2);
    torque(&mut group, "arm3_xi3", &arm3_xi3::Arm3Xi3);
    torque(&mut group, "arm3_exact", &arm3_exact::Arm3Exact);
    torque(&mut group, "puma560_xi6", &puma560_xi6::Puma560Xi6);
    torque(&mut group, "puma560_xi12", &puma560_xi12::Puma560Xi12);
    torque(&mut group, "puma560_exact", &puma560_exact::Puma560Exact);
    group.finish();
}

fn short() -> Criterion {
    Criterion::default().warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1))
}

criterion_group! {
    name = all;
    config = short();
    targets = modules
}
criterion_main!(all);
