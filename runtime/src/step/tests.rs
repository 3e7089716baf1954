//! The loop about a step that is written out, for a step of two joints whose numbers can be followed by hand.

use super::*;
use crate::{Fault, OnFault, Quantity, Reason};

/// τ_1 = 2 q_1 + θ, τ_2 = q̈_d,2; the other inputs reach no torque. θ falls by s = q̇_1.
struct Simple;

impl ControlStep<2, 1> for Simple {
    type Scalar = f64;
    const SETTINGS: Settings<f64, 2> =
        Settings { period: 0.1, torque_limit: [Some(5.0), None], on_fault: OnFault::Gravity };
    const LEARNING: Learning<f64, 1> = Learning { low: [-1.0], high: [1.0], initial: [0.5] };

    fn step(
        q: &[f64; 2],
        qd: &[f64; 2],
        desired: &Desired<f64, 2>,
        theta: &[f64; 1],
    ) -> StepTorque<f64, 2, 1> {
        let asked = [2.0 * q[0] + theta[0], desired.qdd[1]];
        let unread = q[1] + qd[0] + qd[1] + desired.q[0] + desired.q[1] + desired.qd[0] + desired.qd[1];
        StepTorque {
            asked,
            limited: [clamp(asked[0], -5.0, 5.0), asked[1]],
            unread: unread + desired.qdd[0],
            correction: [qd[0]],
        }
    }

    fn gravity_torque(q: &[f64; 2]) -> [f64; 2] {
        [100.0 * q[0], q[1]]
    }
}

type Loop = StepController<Simple, 2, 1>;

static READY: Loop = StepController::new();

const STILL: Desired<f64, 2> = Desired { q: [0.0; 2], qd: [0.0; 2], qdd: [0.0; 2] };

#[test]
fn limits_cut_and_say_so() {
    let mut controller = READY;
    let command = controller.step(&[1.0, 0.0], &[0.0; 2], &STILL).unwrap();
    assert_eq!((command.torque, command.saturated), ([2.5, 0.0], [false; 2]));
    let command = controller.step(&[-4.0, 0.0], &[0.0; 2], &STILL).unwrap();
    assert_eq!((command.torque, command.saturated), ([-5.0, 0.0], [true, false]));
}

#[test]
fn a_fault_is_found_wherever_it_enters_and_the_gravity_torque_is_held() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..10 {
            let mut controller = READY;
            controller.step(&[0.01, 3.0], &[0.0; 2], &STILL).unwrap();
            let (mut q, mut qd, mut desired) = ([0.02, 4.0], [0.0; 2], STILL);
            let joint = place % 2;
            let (input, quantity) = match place / 2 {
                0 => (&mut q, Quantity::Position),
                1 => (&mut qd, Quantity::Velocity),
                2 => (&mut desired.q, Quantity::DesiredPosition),
                3 => (&mut desired.qd, Quantity::DesiredVelocity),
                _ => (&mut desired.qdd, Quantity::DesiredAcceleration),
            };
            input[joint] = bad;
            // The last finite position: that of the instant, where it is not the position that is bad.
            let command = if quantity == Quantity::Position { [1.0, 3.0] } else { [2.0, 4.0] };
            let fault = controller.step(&q, &qd, &desired).unwrap_err();
            assert_eq!(fault, Fault { quantity, reason: Reason::NotFinite, joint, command });
            assert_eq!(controller.learnt(), &[0.5], "nothing is learnt from a bad instant");
        }
    }
    let mut controller = READY;
    let far = [f64::MAX, 0.0];
    let fault = controller.step(&far, &[0.0; 2], &STILL).unwrap_err();
    // The torque and the gravity torque overflow.
    assert_eq!((fault.quantity, fault.joint, fault.command), (Quantity::Torque, 0, [0.0; 2]));
}

/// More joints than are written out: τ = q MAX within 1 N·m.
struct Many;

impl ControlStep<10> for Many {
    type Scalar = f64;
    const SETTINGS: Settings<f64, 10> =
        Settings { period: 0.1, torque_limit: [Some(1.0); 10], on_fault: OnFault::Hold };
    const LEARNING: Learning<f64, 0> = Learning::NONE;

    fn step(q: &[f64; 10], _: &[f64; 10], _: &Desired<f64, 10>, _: &[f64; 0]) -> StepTorque<f64, 10> {
        let asked = q.map(|q| q * f64::MAX);
        let limited = asked.map(|asked| clamp(asked, -1.0, 1.0));
        StepTorque { asked, limited, unread: 0.0, correction: [] }
    }

    fn gravity_torque(_: &[f64; 10]) -> [f64; 10] {
        [0.0; 10]
    }
}

#[test]
fn the_first_joint_whose_torque_overflows_is_named_and_every_joint_is_looked_at() {
    let desired = Desired { q: [0.0; 10], qd: [0.0; 10], qdd: [0.0; 10] };
    let at = |joints: &[usize], value: f64| {
        let mut q = [0.0; 10];
        joints.iter().for_each(|&i| q[i] = value);
        StepController::<Many, 10>::new().step(&q, &[0.0; 10], &desired)
    };
    for (joints, first) in [(&[3, 9][..], 3), (&[9], 9), (&[0, 1], 0)] {
        let fault = at(joints, 2.0).unwrap_err();
        assert_eq!((fault.quantity, fault.joint), (Quantity::Torque, first));
    }
    let command = at(&[1, 9], -0.5).unwrap();
    for i in 0..10 {
        let cut = i == 1 || i == 9;
        assert_eq!((command.torque[i], command.saturated[i]), (if cut { -1.0 } else { 0.0 }, cut), "{i}");
    }
}

/// The step of [`Simple`], for motions inside these limits alone.
struct Checked;

impl ControlStep<2, 1> for Checked {
    type Scalar = f64;
    const SETTINGS: Settings<f64, 2> = Simple::SETTINGS;
    const LEARNING: Learning<f64, 1> = Simple::LEARNING;
    const REFERENCE: Option<ReferenceLimits<f64, 2>> = Some(ReferenceLimits {
        lowest: [-1.0, 0.5],
        highest: [1.0, 2.0],
        velocity: [3.0, 4.0],
        acceleration: [5.0, 6.0],
    });

    fn step(
        q: &[f64; 2],
        qd: &[f64; 2],
        desired: &Desired<f64, 2>,
        theta: &[f64; 1],
    ) -> StepTorque<f64, 2, 1> {
        Simple::step(q, qd, desired, theta)
    }

    fn gravity_torque(q: &[f64; 2]) -> [f64; 2] {
        Simple::gravity_torque(q)
    }
}

#[test]
fn a_desired_motion_beyond_its_limits_is_a_fault() {
    let mut controller = StepController::<Checked, 2, 1>::new();
    let edges = [(0, [-1.0, 1.0], [0.5, 2.0]), (1, [-3.0, 3.0], [-4.0, 4.0]), (2, [-5.0, 5.0], [-6.0, 6.0])];
    for (place, first, second) in edges {
        let quantity =
            [Quantity::DesiredPosition, Quantity::DesiredVelocity, Quantity::DesiredAcceleration][place];
        for (joint, ends) in [first, second].into_iter().enumerate() {
            for (end, away) in ends.into_iter().zip([-1.0, 1.0]) {
                let mut desired = Desired { q: [0.0, 1.0], qd: [0.0; 2], qdd: [0.0; 2] };
                let put = |desired: &mut Desired<f64, 2>, x: f64| {
                    [&mut desired.q, &mut desired.qd, &mut desired.qdd][place][joint] = x;
                };
                put(&mut desired, end);
                assert!(controller.step(&[0.01, 3.0], &[0.0; 2], &desired).is_ok(), "the edge is inside");
                let learnt = *controller.learnt();
                put(&mut desired, end + 1e-9 * away);
                let fault = controller.step(&[0.02, 4.0], &[7.0, 0.0], &desired).unwrap_err();
                let reason = Reason::BeyondLimits;
                assert_eq!(fault, Fault { quantity, reason, joint, command: [2.0, 4.0] });
                assert_eq!(*controller.learnt(), learnt, "nothing is learnt from it");
                put(&mut desired, f64::NAN);
                let fault = controller.step(&[0.02, 4.0], &[0.0; 2], &desired).unwrap_err();
                assert_eq!((fault.quantity, fault.reason), (quantity, Reason::NotFinite));
            }
        }
    }
    let far = Desired { q: [0.0, 1.0], qd: [0.0, -4.5], qdd: [9.0, 0.0] };
    let fault = controller.step(&[0.0; 2], &[0.0; 2], &far).unwrap_err();
    assert_eq!(std::format!("{fault}"), "desired velocity[1] is beyond its limits");
}

#[test]
fn what_is_learnt_stays_in_its_box() {
    let mut controller = READY;
    controller.step(&[0.0; 2], &[-3.0, 0.0], &STILL).unwrap();
    assert_eq!(controller.learnt(), &[1.0]);
    for (put, got) in [(0.25, 0.25), (7.0, 1.0), (f64::NEG_INFINITY, -1.0), (f64::NAN, 0.5)] {
        controller.restore([put]);
        assert_eq!(controller.learnt(), &[got]);
    }
    let learn = |controller: &mut Loop, times: usize| {
        for _ in 0..times {
            controller.step(&[0.0; 2], &[-2e-17, 0.0], &STILL).unwrap();
        }
        *controller.learnt()
    };
    // Half an ulp of 0.5 is 5.6e-17.
    controller.restore([0.5]);
    assert_eq!(learn(&mut controller, 2), [0.5]);
    controller.restore([0.5]);
    assert_eq!(learn(&mut controller, 2), [0.5], "what was below the last digit is forgotten");
    assert_eq!(learn(&mut controller, 1), [0.5 + f64::EPSILON / 2.0]);
    controller.reset();
    assert_eq!((controller.learnt(), controller.safe_command()), (&[0.5], [0.0; 2]));
}

#[test]
fn what_is_no_number_passes() {
    assert!(clamp(f64::NAN, -1.0, 1.0).is_nan());
    assert_eq!([-2.0, 0.5, 2.0].map(|x| clamp(x, -1.0, 1.0)), [-1.0, 0.5, 1.0]);
    assert_eq!([3.0, -3.0, 0.0, f64::NAN].map(|x| select(x, 1.0, 2.0, 4.0)), [1.0, 2.0, 4.0, 4.0]);
}
