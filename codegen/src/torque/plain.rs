//! The exact torque by the plain recursion: dearer than the one that is searched for, but what coarse sines and cosines do
//! to it is known.

use super::coupled::coupled;
use crate::arm::{Arm, JointKind};
use crate::dynamics::{Position, passivity_torque};
use crate::graph::{Builder, Graph, Variable};

/// Runs the recursion of the oracle over graph nodes.
pub fn plain(arm: &Arm) -> Graph {
    if let Some(linkage) = &arm.linkage {
        return coupled(arm, linkage, &plain(&linkage.chain));
    }
    let builder = Builder::new();
    let n = arm.dof();
    let positions: Vec<_> = arm
        .joints
        .iter()
        .enumerate()
        .map(|(j, joint)| match joint.kind {
            JointKind::Revolute => {
                let (sin, cos) = builder.sin_cos(j);
                Position::Revolute { sin, cos }
            }
            JointKind::Prismatic => Position::Prismatic(builder.input(Variable::Q(j))),
        })
        .collect();
    let inputs =
        |variable: fn(usize) -> Variable| -> Vec<_> { (0..n).map(|j| builder.input(variable(j))).collect() };
    let torque = passivity_torque(
        arm,
        arm.gravity,
        &positions,
        &inputs(Variable::Qd),
        &inputs(Variable::Vr),
        &inputs(Variable::Ar),
    );
    let outputs: Vec<_> =
        (1..).zip(torque).map(|(i, tau)| tau.named(&format!("tau{i}"), true).id()).collect();
    builder.finish(&outputs)
}
