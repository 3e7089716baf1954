//! A motion that every arm can make: half a radian about the middle, slow enough for its limits.

use crate::arm::{Arm, Joint, JointKind};

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

/// The motion for `arm`: neighbouring joints go opposite ways, so that their torques do not add up.
pub fn first_motion(arm: &Arm) -> FirstMotion {
    let mut out = FirstMotion { from: Vec::new(), to: Vec::new(), duration: SHORTEST };
    for (index, joint) in arm.joints.iter().enumerate() {
        let (middle, way) = span(joint);
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
