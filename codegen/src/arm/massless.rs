//! Joints that move no mass.

use super::{Arm, Body, Joint};

/// The joints that move no mass, by name: nothing that they carry has any inertia, and neither has their rotor. The model's
/// torque of such a joint is zero.
pub(super) fn massless(arm: &Arm) -> Vec<&str> {
    let bodies: Vec<&Body> = arm.moving().iter().map(|joint| &joint.body).collect();
    // The first joint of the chain that moves with a coordinate carries the most.
    let first = |coordinate: usize| match &arm.linkage {
        None => coordinate,
        Some(linkage) => {
            linkage.couplings.iter().position(|c| c.coordinate == coordinate).unwrap_or(bodies.len())
        }
    };
    let still = |(coordinate, joint): &(usize, &Joint)| {
        joint.armature == 0.0 && bodies.iter().skip(first(*coordinate)).all(|body| **body == Body::default())
    };
    arm.joints.iter().enumerate().filter(still).map(|(_, joint)| joint.name.as_str()).collect()
}
