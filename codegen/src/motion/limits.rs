//! Does the motion keep to the joints' limits?

use super::Motion;
use crate::arm::{Arm, JointKind};
use crate::error::Diagnostics;
use crate::number::{decimal, scientific};
use crate::numerics::Interval;

/// Instants among which the worst is sought.
const INSTANTS: u32 = 2000;
/// Pieces of a motion to begin with, how often they may be halved, and how many more may be open at once.
const PIECES: u32 = 32;
const HALVINGS: usize = 60;
const OPEN: usize = 4096;
/// Limits are often printed with ten digits, and motions run up to them.
const SLACK: f64 = 1e-9;

/// Adds one fault for each limit of each joint that the motion breaks, with the worst instant; one alone where its
/// numbers overflow. Between the instants that are looked at the motion is enclosed, so that no limit is broken unseen.
pub fn check_limits(motion: &Motion, arm: &Arm, faults: &mut Diagnostics) {
    let times = (0..=INSTANTS).map(|k| motion.duration() * f64::from(k) / f64::from(INSTANTS));
    let targets: Vec<_> = times.map(|t| (t, motion.at(t))).collect();
    let finite = |target: &super::Target| {
        [&target.q, &target.qd, &target.qdd].into_iter().flatten().all(|v| v.is_finite())
    };
    if let Some((t, _)) = targets.iter().find(|(_, target)| !finite(target)) {
        let problem = format!("overflows at t = {t:.3e} s");
        faults.push("motion", problem, "write times and positions in SI units");
        return;
    }
    for (i, joint) in arm.joints.iter().enumerate() {
        let number = i + 1;
        let mut compare = |kind: usize, low: f64, high: f64| {
            let (what, value) = KINDS[kind];
            let excess = |x: f64| (x - high).max(low - x);
            let worst = targets
                .iter()
                .map(|(t, target)| (excess(value(target)[i]), *t, value(target)[i]))
                .fold((0.0, 0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst });
            let slack = SLACK * high.abs().max(low.abs());
            let found = if worst.0 > slack {
                Some(("is", worst.1, worst.2))
            } else {
                beyond(motion, i, kind, [low - slack, high + slack])
            };
            if let Some((is, t, value)) = found {
                faults.push(
                    "motion",
                    format!(
                        "{what} of joint {number} ({}) {is} {} at t = {} s, outside its limits [{}, {}]",
                        joint.name,
                        decimal(value, 6),
                        decimal(t, 3),
                        scientific(low),
                        scientific(high)
                    ),
                    match joint.kind {
                        JointKind::Revolute => {
                            "keep the motion inside the joint limits, or correct the limits; angles are in rad"
                        }
                        JointKind::Prismatic => {
                            "keep the motion inside the joint limits, or correct the limits; lengths are in m"
                        }
                    },
                );
            }
        };
        if let Some([low, high]) = joint.limits.position {
            compare(0, low, high);
        }
        if let Some(most) = joint.limits.velocity {
            compare(1, -most, most);
        }
        if let Some(most) = joint.limits.acceleration {
            compare(2, -most, most);
        }
    }
}

type Value = fn(&super::Target) -> &[f64];

/// What is compared with limits, in the order of [`Motion::joint_span`].
const KINDS: [(&str, Value); 3] = [
    ("position", |target| &target.q),
    ("velocity", |target| &target.qd),
    ("acceleration", |target| &target.qdd),
];

/// An instant at which joint `joint` leaves [low, high], with what is said of it and its value there; `None` where none
/// does. Where no halving decides, what it may be at most.
fn beyond(
    motion: &Motion,
    joint: usize,
    kind: usize,
    [low, high]: [f64; 2],
) -> Option<(&'static str, f64, f64)> {
    let leaves = |range: Interval| range.low < low - 1e-200 || range.high > high + 1e-200;
    let mut open = motion.pieces(PIECES);
    let room = open.len() + OPEN;
    for _ in 0..HALVINGS {
        open.retain(|&[from, to]| leaves(motion.joint_span(joint, from, to)[kind]));
        for &[from, to] in &open {
            let middle = 0.5 * (from + to);
            let value = KINDS[kind].1(&motion.at(middle))[joint];
            if value < low || value > high {
                return Some(("is", middle, value));
            }
        }
        if open.is_empty() || open.len() > room {
            break;
        }
        let halves = |&[from, to]: &[f64; 2]| {
            let cut = motion.cut(from, to);
            [[from, cut], [cut, to]]
        };
        open = open.iter().flat_map(halves).collect();
    }
    open.first().map(|&[from, to]| {
        let range = motion.joint_span(joint, from, to)[kind];
        ("may be", 0.5 * (from + to), if range.high > high { range.high } else { range.low })
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use gramforge_runtime::reference::Sinusoid;

    use super::*;
    use crate::simulate::example::three_link;

    fn faults(motion: &Motion, edit: impl Fn(&mut Arm)) -> String {
        let mut arm = three_link();
        edit(&mut arm);
        let mut faults = Diagnostics::of(Path::new("a.json"));
        check_limits(motion, &arm, &mut faults);
        if faults.is_empty() { String::new() } else { faults.into_error().to_string() }
    }

    #[test]
    fn a_limit_that_is_broken_between_equal_instants_is_found() {
        // 2000 equal steps of 200 s are whole periods of 10 Hz: every one of them sees the joint at rest.
        let term =
            |amplitude| vec![Sinusoid { amplitude, frequency: 20.0 * std::f64::consts::PI, phase: 0.0 }];
        let motion = Motion::Sinusoids {
            offset: vec![0.0; 3],
            terms: vec![term(0.01), term(0.0), term(0.0)],
            duration: 200.0,
        };
        let message = faults(&motion, |arm| arm.joints[0].limits.position = Some([-0.0099, 1.0]));
        assert!(message.contains("position of joint 1") && message.contains("outside"), "{message}");
        let message = faults(&motion, |arm| arm.joints[0].limits.acceleration = Some(39.0));
        assert!(message.contains("acceleration of joint 1"), "{message}");
        // One that it just keeps is kept.
        let speed = 0.01 * 20.0 * std::f64::consts::PI;
        let message = faults(&motion, |arm| {
            arm.joints[0].limits.position = Some([-0.01, 0.01]);
            arm.joints[0].limits.velocity = Some(speed);
            arm.joints[1].limits.velocity = Some(0.0);
        });
        assert_eq!(message, "");
    }

    #[test]
    fn a_motion_may_run_up_to_its_limits() {
        // The quintic is fastest in its middle, at 15/8 of its mean speed.
        let motion = Motion::Quintic { from: vec![0.0; 3], to: vec![1.0; 3], duration: 2.0 };
        let fastest = 15.0 / 16.0;
        assert_eq!(faults(&motion, |arm| arm.joints[1].limits.velocity = Some(fastest)), "");
        let message = faults(&motion, |arm| arm.joints[1].limits.velocity = Some(fastest * (1.0 - 1e-7)));
        assert!(message.contains("velocity of joint 2"), "{message}");
    }
}
