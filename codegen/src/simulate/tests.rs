use super::example::{Example, three_link};
use super::*;

#[test]
fn the_exact_law_converges_on_the_reports_arm() {
    let run = Example::three_link(None, None).simulate().unwrap().exact;
    assert!(run.metrics.convergence_time.unwrap() < 1.5, "{:?}", run.metrics);
    assert_eq!(run.metrics.diverged_at, None);
    assert_eq!(run.trace.time.len(), 501);
    assert!((run.trace.time[500] - 5.0).abs() < 1e-12);
    assert!(run.trace.position_error[0].iter().all(|e| (e - 0.2).abs() < 1e-15));
    assert!(run.metrics.final_error.iter().all(|&e| e < 1e-3), "{:?}", run.metrics);
}

#[test]
fn v_decreases_down_to_the_ripple_of_the_held_torque() {
    let v = Example::three_link(None, None).simulate().unwrap().exact.trace.lyapunov;
    // The ripple: what V comes back to once the initial error has gone.
    let ripple = v[250..].iter().copied().fold(0.0, f64::max);
    assert!(ripple < 1e-4 * v[0], "{ripple} of {}", v[0]);
    for pair in v.windows(2) {
        assert!(pair[1] <= pair[0] + ripple, "{pair:?} with ripple {ripple}");
    }
}

#[test]
fn the_reports_law_tracks_with_a_reduced_model() {
    let layer = Example::three_link(Some(2), Some(0.1)).simulate().unwrap();
    let sign = Example::three_link(Some(2), None).simulate().unwrap();
    assert_eq!(layer.exact, sign.exact);
    for run in [&layer.law, &sign.law] {
        assert!(run.metrics.convergence_time.unwrap() < 1.5, "{:?}", run.metrics);
    }
    let variation = |run: &Run| run.metrics.torque_total_variation.iter().sum::<f64>();
    assert!(variation(&layer.law) < 0.5 * variation(&sign.law));
}

#[test]
fn the_exact_graph_gives_the_run_of_the_exact_model() {
    let Comparison { exact, law, .. } = Example::three_link(None, None).simulate().unwrap();
    for (a, b) in exact.trace.position_error.iter().flatten().zip(law.trace.position_error.iter().flatten()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn every_number_of_joints_is_dispatched() {
    for n in 1..=8 {
        let run = Example::chain(n).simulate().unwrap();
        assert_eq!(run.law.metrics.rms_error.len(), n);
        assert_eq!(run.exact.trace.time.len(), 21);
        assert_eq!(run.exact.metrics.diverged_at, None, "{n} joints");
        let error = |run: &Run, k: usize| run.trace.position_error[k].iter().map(|e| e * e).sum::<f64>();
        assert!(error(&run.exact, 20) < error(&run.exact, 0), "{n} joints");
    }
    let mut example = Example::three_link(None, None);
    example.arm.joints.clear();
    assert!(matches!(example.simulate(), Err(Error::Internal(_))));
}

#[test]
fn a_stretched_elbow_and_a_long_period_diverge() {
    let arm = three_link();
    let mut example = Example::new(arm, &[0.0, 0.3, -0.2], &[1.5, 1.2, -0.1], None, None);
    example.design.period = 0.05;
    let run = example.simulate().unwrap().exact;
    let at = run.metrics.diverged_at.unwrap();
    assert!(at < 5.0);
    assert_eq!(run.metrics.convergence_time, None);
    assert!(run.trace.position_error.iter().flatten().all(|e| e.is_finite()));
}

#[test]
fn torque_limits_are_kept_and_counted() {
    let mut example = Example::three_link(None, None);
    example.design.torque_limit = vec![None, Some(40.0), None];
    let metrics = example.simulate().unwrap().exact.metrics;
    assert!(metrics.saturated_steps > 0 && metrics.peak_torque[1] == 40.0, "{metrics:?}");
}

#[test]
fn impossible_numbers_are_the_users_fault() {
    let fault = |change: fn(&mut Example)| {
        let mut example = Example::three_link(None, None);
        change(&mut example);
        match example.simulate() {
            Err(Error::Input(faults)) => faults[0].to_string(),
            other => panic!("{other:?}"),
        }
    };
    assert!(fault(|e| e.simulation.substeps = Some(0)).contains("simulation.substeps"));
    assert!(fault(|e| e.simulation.duration = Some(-1.0)).contains("simulation.duration"));
    assert!(fault(|e| e.simulation.duration = Some(f64::NAN)).contains("simulation.duration"));
    assert!(fault(|e| e.simulation.duration = Some(1e12)).contains("1e8 steps"));
    assert!(fault(|e| e.design.period = 0.0).contains("steps"));
    assert!(fault(|e| e.design.period = -0.01).contains("period"));
    assert!(fault(|e| e.design.gains.damping[0][0] = 0.0).contains("damping"));
}

#[test]
fn parts_of_different_arms_are_refused() {
    let mut example = Example::three_link(None, None);
    example.initial.position = vec![0.1];
    assert!(matches!(example.simulate(), Err(Error::Internal(_))));
}
