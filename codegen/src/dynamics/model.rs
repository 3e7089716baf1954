//! The oracle: mass matrix, Coriolis matrix, gravity and energy of an arm in f64.

use super::recursion::{Position, passivity_torque};
use crate::arm::{Arm, JointKind, Transform};

/// Positions of the joints that move, in the form that the recursion takes.
pub(crate) fn positions(arm: &Arm, q: &[f64]) -> Vec<Position<f64>> {
    if let Some(linkage) = &arm.linkage {
        return positions(&linkage.chain, &linkage.positions(q));
    }
    let position = |(joint, &q): (&crate::arm::Joint, &f64)| match joint.kind {
        JointKind::Revolute => {
            let (sin, cos) = libm::sincos(q);
            Position::Revolute { sin, cos }
        }
        JointKind::Prismatic => Position::Prismatic(q),
    };
    arm.joints.iter().zip(q).map(position).collect()
}

/// D(q) with armature, n×n, kg·m² (kg·m, kg where prismatic joints meet).
pub fn mass_matrix(arm: &Arm, q: &[f64]) -> Vec<Vec<f64>> {
    let n = arm.dof();
    let q = positions(arm, q);
    let rest = vec![0.0; n];
    let columns = unit_vectors(n).map(|unit| passivity_torque(arm, [0.0; 3], &q, &rest, &rest, &unit));
    transposed(columns.collect())
}

/// The Christoffel form C(q, q̇) of equation (1), n×n, N·m·s/rad.
pub fn coriolis(arm: &Arm, q: &[f64], qd: &[f64]) -> Vec<Vec<f64>> {
    let n = arm.dof();
    let q = positions(arm, q);
    let rest = vec![0.0; n];
    let columns = unit_vectors(n).map(|unit| passivity_torque(arm, [0.0; 3], &q, qd, &unit, &rest));
    transposed(columns.collect())
}

/// G(q): the torque that holds the arm still, N·m or N.
pub fn gravity(arm: &Arm, q: &[f64]) -> Vec<f64> {
    let rest = vec![0.0; arm.dof()];
    passivity_torque(arm, arm.gravity, &positions(arm, q), &rest, &rest, &rest)
}

/// τ = D q̈ + C q̇ + G, N·m or N, without friction.
pub fn inverse_dynamics(arm: &Arm, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    passivity_torque(arm, arm.gravity, &positions(arm, q), qd, qd, qdd)
}

/// (kinetic, potential) energy, J; the potential is zero where every mass lies in the base frame's origin.
pub fn energy(arm: &Arm, q: &[f64], qd: &[f64]) -> (f64, f64) {
    let d = mass_matrix(arm, q);
    let mut kinetic = 0.0;
    for (row, &left) in d.iter().zip(qd) {
        for (&entry, &right) in row.iter().zip(qd) {
            kinetic += 0.5 * left * entry * right;
        }
    }
    let mut pose = Transform::IDENTITY;
    let mut potential = 0.0;
    let behind = arm.linkage.as_ref().map(|linkage| linkage.positions(q));
    for (joint, &q) in arm.moving().iter().zip(behind.as_deref().unwrap_or(q)) {
        let motion = match joint.kind {
            JointKind::Revolute => Transform::rotation(2, q),
            JointKind::Prismatic => Transform::translation([0.0, 0.0, q]),
        };
        pose = pose.then(&joint.pose).then(&motion);
        let moment = pose.turn(joint.body.first_moment);
        for i in 0..3 {
            potential -= arm.gravity[i] * (joint.body.mass * pose.translation[i] + moment[i]);
        }
    }
    (kinetic, potential)
}

fn unit_vectors(n: usize) -> impl Iterator<Item = Vec<f64>> {
    (0..n).map(move |j| (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect())
}

fn transposed(columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = columns.len();
    (0..n).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
}
