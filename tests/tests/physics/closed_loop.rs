//! The report's example in closed loop: what its figures claim, and the same run through the generated modules.

use gramforge::Generation;
use gramforge::internals::simulate::{ArmModel, Comparison, Run, Scenario, simulate};
use gramforge_generated::{arm3_exact, arm3_xi2};
use gramforge_runtime::Model;
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_tests::{difference, edited, generation, largest};
use serde_json::json;

fn run(generation: &Generation) -> Comparison {
    let scenario = Scenario::of(generation);
    scenario.and_then(|scenario| simulate(&scenario)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn two_functions_track_as_well_as_the_exact_model() {
    let Comparison { exact, law, .. } = run(&generation("arm3_xi2"));
    for (name, run) in [("exact (16)", &exact), ("two functions (34)", &law)] {
        let metrics = &run.metrics;
        println!(
            "{name}: rms error {:.6} rad, within 0.01 rad from {:?} s, peak torque {:.1?} N·m, variation {:.0?} N·m",
            metrics.rms_error_total,
            metrics.convergence_time,
            metrics.peak_torque,
            metrics.torque_total_variation
        );
        assert_eq!(metrics.diverged_at, None);
        assert!(metrics.convergence_time.unwrap() < 1.5);
    }
    assert!(law.metrics.rms_error_total <= exact.metrics.rms_error_total);
}

/// Asserts that V falls from every instant to the next while it is above `level` times its start, and never comes
/// back above it: below, the torque that is held for a period makes it ripple.
fn falls(name: &str, run: &Run, level: f64) {
    let v = &run.trace.lyapunov;
    let rises = v.windows(2).filter(|pair| pair[1] > pair[0]);
    let highest = rises.map(|pair| pair[1]).fold(0.0, f64::max) / v[0];
    let first_below = v.iter().position(|v| *v < level * run.trace.lyapunov[0]).expect("V falls");
    println!(
        "{name}: V(0) = {:.3} J, at {:.2} s below {level:e} of it, rises up to {highest:.1e} of it",
        v[0], run.trace.time[first_below]
    );
    for pair in v[..=first_below].windows(2) {
        assert!(pair[1] < pair[0], "{name}: {pair:?}");
    }
    assert!(v[first_below..].iter().all(|x| *x < level * v[0]), "{name}: V rises to {highest:e} of V(0)");
    assert!(run.trace.time[first_below] < 1.5, "{name}");
}

#[test]
fn v_falls_down_to_the_ripple_of_the_held_torque() {
    let Comparison { exact, law, .. } = run(&generation("arm3_xi2"));
    falls("exact (16)", &exact, 1e-6);
    falls("two functions (34)", &law, 2e-3);
}

#[test]
fn a_boundary_layer_removes_the_chatter() {
    let sign = run(&generation("arm3_xi2")).law;
    let with_layer = edited("arm3_xi2", |spec| {
        spec["control"]["boundary_layer"] = json!(0.05);
        // The slope inside the layer asks for a shorter one; it is the chatter that is looked at.
        spec["control"]["allow_long_period"] = json!(true);
    })
    .unwrap();
    let layer = run(&with_layer).law;
    let variation = |run: &Run| run.metrics.torque_total_variation[0];
    println!(
        "total variation of the torque of joint 1: {:.0} N·m, with a layer of 0.05 {:.1} N·m",
        variation(&sign),
        variation(&layer)
    );
    assert!(variation(&sign) > 10.0 * variation(&layer));
    assert!(layer.metrics.convergence_time.unwrap() < 1.5);
}

/// Torques of the generated controller at every instant of the run, on a plant of the given model.
fn through_modules(plant: impl Model<3, Scalar = f64>, instants: usize) -> Vec<f64> {
    let mut controller = arm3_xi2::controller();
    let start = arm3_xi2::REFERENCE.at(0.0);
    let state = JointState { q: start.q.map(|q| q + 0.2), qd: start.qd };
    let plant = RigidPlant { model: plant, coulomb: [[0.0; 2]; 3] };
    let mut simulation = Simulation::new(plant, state, arm3_xi2::SETTINGS.period, 10).unwrap();
    let step = |_| simulation.step(&mut controller, &arm3_xi2::REFERENCE).unwrap().command.unwrap().torque;
    (0..instants).flat_map(step).collect()
}

#[test]
fn the_generated_modules_give_the_same_run() {
    let generation = generation("arm3_xi2");
    let torque = run(&generation).law.trace.torque;
    let simulated = torque.concat();
    let same_plant = through_modules(ArmModel::new(generation.arm()).unwrap(), torque.len());
    assert!(simulated.iter().zip(&same_plant).all(|(a, b)| a.to_bits() == b.to_bits()));
    // The generated plant is the same arm in another order of operations.
    let own_plant = through_modules(arm3_exact::Arm3Exact, torque.len());
    let apart = difference(&simulated, &own_plant) / largest(&simulated);
    println!("generated controller: same bits on the same plant, {apart:.1e} apart on the generated one");
    assert!(apart < 1e-9, "{apart:e}");
}
