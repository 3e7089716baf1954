use std::vec::Vec;

use super::*;
use crate::Controller;
use crate::law::Law;
use crate::law::{CoriolisTerm, ExactLaw, Gains, ReportLaw, Sample, Switching, lyapunov};
use crate::simulate::RigidPlant;
use crate::test_arm::TwoLink;
use crate::{OnFault, QuinticReference, Settings};

// W = 10I, Pqq = 0.25I, P12 = 4I.
const GAINS: Gains<f64, 2> = Gains {
    p12: [[4.0, 0.0], [0.0, 4.0]],
    damping: [[10.0625, 0.0], [0.0, 10.0625]],
    pqq: [[0.25, 0.0], [0.0, 0.25]],
};
const EXACT: ExactLaw<f64, 2> = ExactLaw { gains: GAINS, coulomb: [[0.0; 2]; 2] };
const MOTION: QuinticReference<f64, 2> =
    QuinticReference { from: [0.0, -1.2], to: [1.5, -2.2], duration: 4.0 };
const SETTINGS: Settings<f64, 2> =
    Settings { period: 1e-3, torque_limit: [None; 2], on_fault: OnFault::Hold };
const FREE: [[f64; 2]; 2] = [[0.0; 2]; 2];

/// Robust against everything that the perturbed arm gets wrong, at joint speeds up to 3 rad/s.
fn report_law(switching: Switching<f64, 2>) -> ReportLaw<f64, 2> {
    let delta_c = TwoLink::<f64>::perturbed().bounds.coriolis(&[3.0; 2]);
    // The largest row sum of sym ΔC is at least its largest eigenvalue.
    let k = delta_c[0][0] + 0.5 * (delta_c[0][1] + delta_c[1][0]) + delta_c[1][1];
    ReportLaw {
        gains: GAINS,
        delta_c,
        coriolis_term: CoriolisTerm::Matrix([[k, 0.0], [0.0, k]]),
        disturbance: [0.0; 2],
        switching,
        coulomb: FREE,
    }
}

fn run<L: Law<TwoLink<f64>, 2>>(
    model: TwoLink<f64>,
    law: L,
    settings: Settings<f64, 2>,
) -> Vec<Record<f64, 2>> {
    let mut controller = Controller::new(model, law, settings).unwrap();
    let plant = RigidPlant { model: TwoLink::EXAMPLE, coulomb: FREE };
    let start = JointState { q: [0.2, -1.0], qd: [0.0; 2] };
    let mut simulation = Simulation::new(plant, start, settings.period, 2).unwrap();
    (0..4000).map(|_| simulation.step(&mut controller, &MOTION).unwrap()).collect()
}

fn error(record: &Record<f64, 2>) -> f64 {
    let [a, b] = [0, 1].map(|i| (record.state.q[i] - record.desired.q[i]).abs());
    a.max(b)
}

fn final_error(records: &[Record<f64, 2>]) -> f64 {
    records[3500..].iter().map(error).fold(0.0, f64::max)
}

/// Total variation of the torques in the last half second, N·m.
fn chatter(records: &[Record<f64, 2>]) -> f64 {
    let torque = |r: &Record<f64, 2>| r.command.unwrap().torque;
    let step = |w: &[Record<f64, 2>]| {
        let (a, b) = (torque(&w[0]), torque(&w[1]));
        (a[0] - b[0]).abs() + (a[1] - b[1]).abs()
    };
    records[3500..].windows(2).map(step).sum()
}

#[test]
fn lyapunov_function_decreases_along_the_exact_law() {
    let records = run(TwoLink::EXAMPLE, EXACT, SETTINGS);
    let energy: Vec<f64> = records
        .iter()
        .map(|r| {
            let sample = Sample { q: r.state.q, qd: r.state.qd, desired: r.desired, period: 1e-3 };
            lyapunov(&TwoLink::EXAMPLE, &GAINS, &sample)
        })
        .collect();
    assert!(energy[0] > 0.1);
    // Down to where the held torque's own error shows.
    for pair in energy.windows(2).take_while(|pair| pair[0] > 1e-5) {
        assert!(pair[1] < pair[0], "{pair:?}");
    }
    assert!(energy[3999] < 1e-6 * energy[0], "{}", energy[3999]);
}

#[test]
fn exact_law_converges_only_with_an_exact_model() {
    let good = final_error(&run(TwoLink::EXAMPLE, EXACT, SETTINGS));
    let poor = final_error(&run(TwoLink::perturbed(), EXACT, SETTINGS));
    assert!(good < 1e-4 && poor > 5e-3, "{good} {poor}");
}

#[test]
fn report_law_converges_with_a_wrong_model_inside_its_bounds() {
    let robust = final_error(&run(TwoLink::perturbed(), report_law(Switching::Sign), SETTINGS));
    assert!(robust < 5e-4, "{robust}");
}

#[test]
fn boundary_layer_removes_the_chatter() {
    let sign = run(TwoLink::perturbed(), report_law(Switching::Sign), SETTINGS);
    let layer = run(TwoLink::perturbed(), report_law(Switching::BoundaryLayer([0.05; 2])), SETTINGS);
    assert!(chatter(&layer) < 0.01 * chatter(&sign), "{} {}", chatter(&layer), chatter(&sign));
    assert!(final_error(&layer) < 0.02, "{}", final_error(&layer));
}

#[test]
fn saturation_is_recorded() {
    let records = run(TwoLink::EXAMPLE, EXACT, Settings { torque_limit: [Some(13.0), None], ..SETTINGS });
    let saturated = records.iter().filter(|r| r.command.unwrap().saturated[0]).count();
    assert!(saturated > 0 && saturated < records.len());
    assert!(records.iter().all(|r| r.command.unwrap().torque[0].abs() <= 13.0));
    assert!(records.iter().all(|r| !r.command.unwrap().saturated[1]));
}

#[test]
fn works_in_single_precision() {
    let arm = TwoLink::<f64>::EXAMPLE.to_f32();
    let single = |m: [[f64; 2]; 2]| m.map(|row| row.map(|x| x as f32));
    let gains = Gains { p12: single(GAINS.p12), damping: single(GAINS.damping), pqq: single(GAINS.pqq) };
    let law = ReportLaw {
        gains,
        delta_c: [[0.0; 2]; 2],
        coriolis_term: CoriolisTerm::Matrix([[0.0; 2]; 2]),
        disturbance: [0.0; 2],
        switching: Switching::BoundaryLayer([0.1; 2]),
        coulomb: [[0.0; 2]; 2],
    };
    let settings = Settings { period: 1e-3_f32, torque_limit: [Some(100.0); 2], on_fault: OnFault::Gravity };
    let mut controller = Controller::new(arm, law, settings).unwrap();
    let motion = QuinticReference { from: [0.0_f32, -1.2], to: [1.5, -2.2], duration: 4.0 };
    let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; 2] };
    let mut simulation =
        Simulation::new(plant, JointState { q: [0.2, -1.0], qd: [0.0; 2] }, 1e-3, 2).unwrap();
    for _ in 0..4000 {
        assert!(simulation.step(&mut controller, &motion).unwrap().command.is_ok());
    }
    let q = simulation.state().q;
    assert!((q[0] - 1.5).abs() < 1e-3 && (q[1] + 2.2).abs() < 1e-3, "{q:?}");
}

#[test]
fn a_fault_applies_the_safe_command() {
    /// A reference that is lost after 10 ms.
    struct Lost;
    impl Reference<f64, 2> for Lost {
        fn duration(&self) -> f64 {
            1.0
        }
        fn at(&self, t: f64) -> Desired<f64, 2> {
            Desired::at_rest(if t > 0.0105 { [f64::NAN; 2] } else { [0.0; 2] })
        }
        fn check(&self) -> Result<(), ConfigError> {
            Ok(())
        }
    }
    let settings = Settings { on_fault: OnFault::Gravity, ..SETTINGS };
    let mut controller = Controller::new(TwoLink::EXAMPLE, EXACT, settings).unwrap();
    let plant = RigidPlant { model: TwoLink::EXAMPLE, coulomb: FREE };
    let mut simulation = Simulation::new(plant, JointState { q: [0.0; 2], qd: [0.0; 2] }, 1e-3, 1).unwrap();
    let records: Vec<_> = (0..1000).map(|_| simulation.step(&mut controller, &Lost).unwrap()).collect();
    assert!(records[10].command.is_ok() && records[11].command.is_err());
    assert!(records[999].state.q[0].abs() < 1e-6, "gravity torque must hold the arm up");
}

#[test]
fn refuses_a_clock_that_stands() {
    let plant = RigidPlant { model: TwoLink::<f64>::EXAMPLE, coulomb: FREE };
    let state = JointState { q: [0.0; 2], qd: [0.0; 2] };
    let named = |period, substeps| {
        Simulation::new(plant, state, period, substeps).map(|_| ()).map_err(|e| e.parameter)
    };
    assert_eq!(named(1e-3, 1), Ok(()));
    assert_eq!(named(0.0, 1), Err("period"));
    assert_eq!(named(f64::NAN, 1), Err("period"));
    assert_eq!(named(1e-3, 0), Err("substeps"));
}
