use super::*;
use crate::law::{ExactLaw, Gains};
use crate::test_arm::TwoLink;

const LAW: ExactLaw<f64, 2> = ExactLaw {
    gains: Gains {
        p12: [[4.0, 0.0], [0.0, 4.0]],
        damping: [[10.0, 0.0], [0.0, 10.0]],
        pqq: [[0.25, 0.0], [0.0, 0.25]],
    },
    coulomb: [[0.0; 2]; 2],
};
const SETTINGS: Settings<f64, 2> =
    Settings { period: 1e-3, torque_limit: [Some(30.0), None], on_fault: OnFault::Hold };
const GOAL: Desired<f64, 2> = Desired::at_rest([0.1, -0.2]);

type Loop = Controller<TwoLink<f64>, ExactLaw<f64, 2>, 2>;

fn controller(on_fault: OnFault) -> Loop {
    Controller::new(TwoLink::EXAMPLE, LAW, Settings { on_fault, ..SETTINGS }).unwrap()
}

#[test]
fn commands_what_the_law_says() {
    let (q, qd) = ([0.12, -0.25], [0.01, 0.02]);
    let command = controller(OnFault::Hold).step(&q, &qd, &GOAL).unwrap();
    let expected = LAW.torque(&TwoLink::EXAMPLE, &mut (), &Sample { q, qd, desired: GOAL, period: 1e-3 });
    assert_eq!(command, Command { torque: expected, saturated: [false; 2] });
}

#[test]
fn cuts_at_the_limit_and_says_so() {
    let command = controller(OnFault::Hold).step(&[5.0, 5.0], &[0.0; 2], &GOAL).unwrap();
    assert_eq!((command.torque[0], command.saturated), (-30.0, [true, false]));
    assert!(command.torque[1] < -100.0);
    let command = controller(OnFault::Hold).step(&[-5.0, 0.0], &[0.0; 2], &GOAL).unwrap();
    assert_eq!((command.torque[0], command.saturated), (30.0, [true, false]));
}

#[test]
fn names_the_quantity_and_the_joint() {
    let bad = [0.0, f64::NAN];
    let good = [0.0; 2];
    let infinite = [f64::NEG_INFINITY, f64::NAN];
    let mut controller = controller(OnFault::Zero);
    let mut named = |q: &[f64; 2], qd: &[f64; 2], desired: Desired<f64, 2>| {
        let fault = controller.step(q, qd, &desired).unwrap_err();
        assert_eq!(fault.command, [0.0; 2]);
        (fault.quantity, fault.joint)
    };
    assert_eq!(named(&bad, &bad, GOAL), (Quantity::Position, 1));
    assert_eq!(named(&good, &infinite, GOAL), (Quantity::Velocity, 0));
    assert_eq!(named(&good, &good, Desired { q: bad, ..GOAL }), (Quantity::DesiredPosition, 1));
    assert_eq!(named(&good, &good, Desired { qd: infinite, ..GOAL }), (Quantity::DesiredVelocity, 0));
    assert_eq!(named(&good, &good, Desired { qdd: bad, ..GOAL }), (Quantity::DesiredAcceleration, 1));
    assert_eq!(named(&good, &[1e308, 0.0], GOAL), (Quantity::Torque, 0));
}

#[test]
fn hold_repeats_the_last_good_command() {
    let mut controller = controller(OnFault::Hold);
    let fault = controller.step(&[f64::NAN; 2], &[0.0; 2], &GOAL).unwrap_err();
    assert_eq!(fault.command, [0.0; 2]);
    let good = controller.step(&[5.0, 0.0], &[0.0; 2], &GOAL).unwrap();
    assert_eq!(good.torque[0], -30.0);
    for _ in 0..3 {
        let fault = controller.step(&[0.0, f64::NAN], &[0.0; 2], &GOAL).unwrap_err();
        assert_eq!(fault.command, good.torque);
    }
    assert!(controller.step(&[0.1, -0.2], &[0.0; 2], &GOAL).is_ok());
}

#[test]
fn zero_lets_go() {
    let mut controller = controller(OnFault::Zero);
    assert!(controller.step(&[0.0; 2], &[0.0; 2], &GOAL).is_ok());
    let fault = controller.step(&[0.0; 2], &[f64::NAN; 2], &GOAL).unwrap_err();
    assert_eq!(fault.command, [0.0; 2]);
}

#[test]
fn gravity_holds_the_last_good_position() {
    let arm = TwoLink::EXAMPLE;
    let limits = Settings { torque_limit: [Some(15.0), None], on_fault: OnFault::Gravity, ..SETTINGS };
    let mut controller = Controller::new(arm, LAW, limits).unwrap();
    let fault = controller.step(&[f64::NAN; 2], &[0.0; 2], &GOAL).unwrap_err();
    assert_eq!(fault.command, [0.0; 2]);

    let q = [1.2, 0.4];
    assert!(controller.step(&q, &[0.0; 2], &GOAL).is_ok());
    let fault = controller.step(&[f64::NAN; 2], &[0.0; 2], &GOAL).unwrap_err();
    assert_eq!(fault.command, arm.gravity(&q));
    assert!(fault.command[1] != 0.0);

    // A broken velocity leaves the position good; level, the arm weighs 16 N·m, more than the limit.
    let fault = controller.step(&[0.0; 2], &[f64::NAN; 2], &GOAL).unwrap_err();
    assert_eq!(fault.command, [15.0, 4.0]);
}

#[test]
fn refuses_bad_numbers_by_name() {
    let refused = |law, settings| {
        let error: Result<Loop, ConfigError> = Controller::new(TwoLink::EXAMPLE, law, settings);
        error.map_or_else(|e| std::string::ToString::to_string(&e), |_| "accepted".into())
    };
    assert_eq!(refused(LAW, SETTINGS), "accepted");
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(LAW, Settings { period, ..SETTINGS }), "period must be positive and finite");
    }
    let torque_limit = [None, Some(0.0)];
    assert_eq!(
        refused(LAW, Settings { torque_limit, ..SETTINGS }),
        "torque_limit[1] must be positive and finite"
    );
    let coulomb = [[0.0, 1.0], [0.0; 2]];
    assert_eq!(refused(ExactLaw { coulomb, ..LAW }, SETTINGS), "coulomb[0] must be finite and not positive");
}

/// Counts its steps, and computes NaN when told to.
#[derive(Clone, Copy, Debug)]
struct Counting;

impl Law<TwoLink<f64>, 2> for Counting {
    type State = u32;

    fn initial_state(&self) -> u32 {
        7
    }

    fn torque(&self, _: &TwoLink<f64>, state: &mut u32, sample: &Sample<f64, 2>) -> [f64; 2] {
        *state += 1;
        if sample.q[0] > 1.0 { [f64::NAN; 2] } else { [0.0; 2] }
    }

    fn check(&self) -> Result<(), ConfigError> {
        Ok(())
    }
}

#[test]
fn a_faulty_step_leaves_the_law_as_it_was() {
    let mut controller = Controller::new(TwoLink::EXAMPLE, Counting, SETTINGS).unwrap();
    assert!(controller.step(&[0.0; 2], &[0.0; 2], &GOAL).is_ok());
    assert_eq!(*controller.law_state(), 8);
    let fault = controller.step(&[2.0, 0.0], &[0.0; 2], &GOAL).unwrap_err();
    assert_eq!((fault.quantity, *controller.law_state()), (Quantity::Torque, 8));
}
