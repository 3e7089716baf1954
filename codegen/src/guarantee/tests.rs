//! Where the errors of a loop can be followed no further.

use gramforge_runtime::reference::Sinusoid;

use super::declared::Declared;
use super::follow::{Open, Sampled, follow};
use super::funnel::{Funnel, Lost};
use super::problem::{Problem, Switching, Wrong};
use crate::arm::Arm;
use crate::control::Gains;
use crate::motion::Motion;
use crate::simulate::example::three_link;

const ZERO: [f64; 3] = [0.0; 3];
const START: [f64; 3] = [0.002; 3];
const WIDE: [f64; 6] = [1.0, 1.0, 1.0, 10.0, 10.0, 10.0];

fn diagonal(x: [f64; 3]) -> Vec<Vec<f64>> {
    (0..3).map(|i| (0..3).map(|j| if i == j { x[i] } else { 0.0 }).collect()).collect()
}

/// The three-link arm at rest for 0.05 s under law (16).
fn judged<T>(damping: f64, f: impl FnOnce(&Problem) -> T) -> T {
    let place = vec![0.2, 0.5, -1.4];
    let motion = Motion::Quintic { from: place.clone(), to: place, duration: 0.05 };
    of(&three_link(), &motion, damping, f)
}

/// The same arm with viscous friction in a fast motion.
pub(super) fn moving(f: impl FnOnce(&Problem)) {
    let mut arm = three_link();
    arm.joints.iter_mut().zip([3.0, 2.0, 1.0]).for_each(|(joint, b)| joint.viscous_friction = b);
    let motion = Motion::Quintic { from: vec![0.1, -0.4, 0.8], to: vec![1.3, 0.9, -0.7], duration: 0.7 };
    of(&arm, &motion, 100.0, f);
}

fn of<T>(arm: &Arm, motion: &Motion, damping: f64, f: impl FnOnce(&Problem) -> T) -> T {
    let gains = Gains {
        p12: diagonal([5.0; 3]),
        damping: diagonal([2.0 * damping, 2.0 * damping, damping]),
        pqq: diagonal([2.5 * damping, 2.5 * damping, 1.25 * damping]),
    };
    f(&Problem {
        arm,
        numbers: Vec::new(),
        viscous: vec![0.0; 3],
        motion,
        gains: &gains,
        damping: gains.damping.clone(),
        switching: Switching::None,
        compensated: &[[0.0; 2]; 3],
        period: 0.001,
        repetition: None,
        initial: [&START, &ZERO],
        tube: vec![0.01; 3],
    })
}

/// A step whose torque is off by up to `torque`, whatever the errors.
fn off(torque: f64) -> Wrong {
    Wrong { torque: vec![torque; 3], s: vec![0.0; 3] }
}

fn followed(problem: &Problem, torque: f64, settle: Option<f64>) -> Result<Sampled, Open> {
    follow(problem, Declared::new(WIDE.to_vec(), &|_| off(torque)), settle)
}

#[test]
fn a_loop_that_settles_is_held_for_ever() {
    judged(100.0, |problem| {
        let sampled = followed(problem, 0.0, Some(1.5)).expect("the errors die away");
        assert_eq!(sampled.valid_until, None);
        let settled = sampled.settled_error.expect("for ever is long enough");
        assert!(settled.iter().zip(&sampled.reach).all(|(settled, reach)| settled < reach), "{settled:?}");
    });
}

#[test]
fn a_claim_ends_before_the_period_in_which_errors_may_leave_the_tube() {
    // The torque error pushes the joints out of the tube once the motion has ended.
    judged(100.0, |problem| {
        let sampled = followed(problem, 12.0, Some(1.5)).expect("the motion itself is followed");
        let end = sampled.valid_until.expect("not for ever");
        let (last, errors) = sampled.course.last().expect("periods");
        assert!(end >= 0.05 && end == *last, "{end} {last}");
        assert!(errors.iter().chain(&sampled.reach).all(|error| *error <= 0.01), "{errors:?}");
        assert_eq!(sampled.settled_error, None, "the claim ends before");
        // What comes next is lost, and stays lost however often it is tried.
        let mut funnel = Funnel::new(problem, off(12.0));
        while funnel.step().is_ok() {}
        let (index, hull) = (funnel.index, funnel.set.hull());
        assert!((index as f64 * 0.001 - end).abs() < 1e-12);
        for _ in 0..3 {
            assert!(matches!(funnel.step(), Err(Lost::Tube { .. })));
            assert_eq!((funnel.index, funnel.set.hull()), (index, hull.clone()));
        }
    });
}

#[test]
fn a_loop_that_is_lost_during_the_motion_is_not_claimed() {
    judged(100.0, |problem| {
        assert!(matches!(followed(problem, 400.0, None), Err(Open::Lost(Lost::Tube { .. }))));
    });
}

/// A step that is wrong by more where the errors are larger: each torque counts with what holds where it is computed.
#[test]
fn what_the_step_is_wrong_by_grows_with_the_errors() {
    judged(100.0, |problem| {
        let settle = Some(1.5);
        let wrong = |most: &[f64]| off(if most[0] < START[0] { 0.0 } else { 0.2 * most[0] / START[0] });
        // From bounds below the errors at the start.
        let from = |bounds: [f64; 6]| follow(problem, Declared::new(bounds.to_vec(), &wrong), settle);
        let grown = from([1e-4; 6]).expect("followed");
        let (first, last) =
            (grown.torque_error[0].clone(), grown.torque_error[grown.torque_error.len() - 1].1[0]);
        assert!(first.0 == 0.0 && first.1[0] >= 0.2 && last >= first.1[0], "{:?}", grown.torque_error);
        // No less than a step that is always wrong by as much as the start needs, no more than one by the most.
        let [least, most] = [0.2, last].map(|by| followed(problem, by, settle).expect("followed"));
        assert!([&least, &grown, &most].iter().all(|sampled| sampled.valid_until.is_none()), "held for ever");
        let settled = |sampled: &Sampled| sampled.settled_error.clone().expect("for ever is long enough");
        let [least, grown, most] = [&least, &grown, &most].map(settled);
        for i in 0..3 {
            assert!(least[i] < grown[i] && grown[i] <= most[i], "{least:?} {grown:?} {most:?}");
        }
        // What never holds what it was made for.
        let growing = |most: &[f64]| off(1e4 * most[0]);
        let lost = follow(problem, Declared::new(vec![1e-4; 6], &growing), settle);
        assert!(matches!(lost, Err(Open::Lost(_) | Open::Growing(_))), "{lost:?}");
    });
}

/// A box that is to hold for ever is larger than the set in it, and its first torque counts as well.
#[test]
fn a_box_beyond_the_declared_errors_widens_them() {
    judged(100.0, |problem| {
        let tiny = [1e-9; 3];
        let problem = Problem { initial: [&tiny, &ZERO], ..problem.clone() };
        // Errors of the torque alone: the largest before the box is made.
        let mut funnel = Funnel::new(&problem, off(0.2));
        let mut most = funnel.set.hull();
        while funnel.index < 1500 {
            let step = funnel.step().expect("followed");
            most.iter_mut().zip(step.hull).for_each(|(most, x)| *most = most.max(x));
        }
        let asked = std::cell::Cell::new(0);
        let wrong = |bounds: &[f64]| {
            asked.set(asked.get() + usize::from(bounds != most));
            off(0.2)
        };
        let sampled = follow(&problem, Declared::new(most.clone(), &wrong), Some(1.5)).expect("followed");
        assert_eq!(sampled.valid_until, None);
        assert!(asked.get() > 0, "larger errors are declared for the box");
    });
}

/// A motion that moves on at its end is claimed for whole periods of it: of none, there is nothing to claim.
#[test]
fn a_motion_of_less_than_a_period_is_not_claimed() {
    judged(100.0, |problem| {
        let moving = Motion::Sinusoids {
            offset: vec![0.2, 0.5, -1.4],
            terms: vec![vec![Sinusoid { amplitude: 0.1, frequency: 1.0, phase: 0.3 }], vec![], vec![]],
            duration: 0.0005,
        };
        assert!(!moving.rests());
        let of = |motion| followed(&Problem { motion, ..problem.clone() }, 0.0, Some(1.5));
        assert_eq!(of(&moving), Err(Open::Short));
        // At rest the period that holds the motion is followed, and those after it.
        let place = vec![0.2, 0.5, -1.4];
        let brief = Motion::Quintic { from: place.clone(), to: place, duration: 1e-13 };
        let sampled = of(&brief).expect("the errors die away");
        assert_eq!(sampled.valid_until, None);
        assert!(sampled.reach.iter().zip(START).all(|(reach, start)| *reach >= start), "{:?}", sampled.reach);
    });
}
