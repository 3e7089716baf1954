//! A motion that the arm can make: half a radian about a place that its drives can hold, slow enough for its limits.

use crate::arm::{Arm, Joint, JointKind};
use crate::dynamics::inverse_dynamics;
use crate::numerics::low_discrepancy::LowDiscrepancy;

/// A quintic motion, at rest at both ends.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstMotion {
    /// Start by joint, rad or m.
    pub from: Vec<f64>,
    /// End by joint, rad or m.
    pub to: Vec<f64>,
    /// Duration, s.
    pub duration: f64,
}

/// Way of a joint, rad or m, where its range leaves room for it.
const WAY: [(JointKind, f64); 2] = [(JointKind::Revolute, 0.5), (JointKind::Prismatic, 0.1)];
/// Most of a joint's range that is used.
const PART: f64 = 0.4;
/// The shortest duration, s.
const SHORTEST: f64 = 3.0;
/// Most of a limit of speed or acceleration that is used.
const LOAD: f64 = 0.5;
/// Peaks of the quintic: speed times duration, and acceleration times its square, both over the way.
const PEAK: [f64; 2] = [1.875, 5.7736];

/// Places about which a motion is tried.
const PLACES: usize = 64;
/// Furthest from the middle, rad; of a shorter range a quarter.
const FURTHEST: f64 = 1.5;
/// Share of a torque limit that the motion may take: the rest corrects errors.
const TORQUE: f64 = 0.6;

/// The motion for `arm`: about the middle of the joints' ranges, or about the first of some places near it where the drives bear it.
pub fn first_motion(arm: &Arm) -> FirstMotion {
    let places = LowDiscrepancy::new(arm.dof());
    let mut best = (f64::INFINITY, about(arm, &vec![0.0; arm.dof()]));
    for index in 0..PLACES {
        let place = match index {
            0 => vec![0.0; arm.dof()],
            _ => places
                .point(index)
                .iter()
                .zip(&arm.joints)
                .map(|(x, joint)| (2.0 * x - 1.0) * room(joint))
                .collect(),
        };
        let motion = about(arm, &place);
        let load = load(arm, &motion);
        if load < best.0 {
            best = (load, motion);
        }
        if load <= TORQUE {
            break;
        }
    }
    best.1
}

/// How far from the middle of its motion a joint may be put, rad or m.
fn room(joint: &Joint) -> f64 {
    match (joint.kind, joint.limits.position) {
        (_, Some([low, high])) => (0.25 * (high - low)).min(FURTHEST),
        (JointKind::Revolute, None) => FURTHEST,
        (JointKind::Prismatic, None) => 0.0,
    }
}

/// The largest torque of `motion` over its limit; 0 where there are no limits.
fn load(arm: &Arm, motion: &FirstMotion) -> f64 {
    let n = arm.dof();
    let peak = PEAK[1] / (motion.duration * motion.duration);
    let at = |share: f64, pull: f64| {
        let q: Vec<f64> = (0..n).map(|i| motion.from[i] + share * (motion.to[i] - motion.from[i])).collect();
        let qdd: Vec<f64> = (0..n).map(|i| pull * peak * (motion.to[i] - motion.from[i])).collect();
        inverse_dynamics(arm, &q, &vec![0.0; n], &qdd)
    };
    let torques = [at(0.0, 1.0), at(0.5, 0.0), at(1.0, -1.0)];
    let share = |torque: &Vec<f64>| {
        let of =
            |(torque, joint): (&f64, &Joint)| joint.limits.torque.map_or(0.0, |most| torque.abs() / most);
        torque.iter().zip(&arm.joints).map(of).fold(0.0, f64::max)
    };
    torques.iter().map(share).fold(0.0, f64::max)
}

/// The motion about a place that is `away` from the middle by joint, rad or m: neighbouring joints go opposite ways, so that their
/// torques do not add up.
fn about(arm: &Arm, away: &[f64]) -> FirstMotion {
    let mut out = FirstMotion { from: Vec::new(), to: Vec::new(), duration: SHORTEST };
    for (index, joint) in arm.joints.iter().enumerate() {
        let (middle, way) = span(joint);
        let half = 0.5 * way;
        let middle = match joint.limits.position {
            Some([low, high]) => (middle + away[index]).max(low + half).min(high - half),
            None => middle + away[index],
        };
        let sign = if index % 2 == 0 { 0.5 } else { -0.5 };
        out.from.push(rounded(middle - sign * way));
        out.to.push(rounded(middle + sign * way));
        let speed = joint.limits.velocity.map_or(0.0, |most| PEAK[0] * way / (LOAD * most));
        let acceleration =
            joint.limits.acceleration.map_or(0.0, |most| libm::sqrt(PEAK[1] * way / (LOAD * most)));
        let least = speed.max(acceleration);
        if least.is_finite() {
            out.duration = out.duration.max(libm::ceil(2.0 * least) / 2.0);
        }
    }
    out
}

/// The middle of the motion of `joint`, and its way.
fn span(joint: &Joint) -> (f64, f64) {
    let most = WAY.iter().find(|(kind, _)| *kind == joint.kind).map_or(0.0, |(_, way)| *way);
    match joint.limits.position {
        // A joint that turns further than once has its zero where its maker put it.
        Some([low, high]) if high - low < 6.0 => (0.5 * (low + high), most.min(PART * (high - low))),
        Some([low, high]) => (0.0_f64.clamp(low + 0.5 * most, high - 0.5 * most), most),
        None => (0.0, most),
    }
}

/// Three decimals: numbers that a person reads.
fn rounded(value: f64) -> f64 {
    let value = libm::round(value * 1000.0) / 1000.0;
    if value == 0.0 { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::{TORQUE, first_motion, load};
    use crate::simulate::example::three_link;

    #[test]
    fn a_motion_spares_weak_drives() {
        let mut arm = three_link();
        let middle = first_motion(&arm);
        assert_eq!(load(&arm, &middle), 0.0, "no limits, no load");
        // What the middle takes of joint 2 is more than its drive bears.
        arm.joints[1].limits.torque = Some(20.0);
        assert!(load(&arm, &middle) > 1.0, "{}", load(&arm, &middle));
        let spared = first_motion(&arm);
        assert!(load(&arm, &spared) <= TORQUE, "{} at {:?}", load(&arm, &spared), spared.from);
    }
}
