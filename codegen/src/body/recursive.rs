//! The exact torque by the polarised recursion, specialised to the arm's constants.

use crate::arm::{Arm, JointKind};
use crate::dynamics::{Position, passivity_torque};
use crate::graph::{Builder, Graph, Variable};

/// Runs the recursion over graph nodes: zeros, ones and repeated products of the arm's constants fold away.
pub fn recursive(arm: &Arm) -> Graph {
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
