//! The torque of an arm some of whose joints follow others, from the code of its chain.

use super::harmonics::{Harmonics, sum};
use crate::arm::{Arm, JointKind, Linkage};
use crate::graph::{Builder, Expr, Graph, Leaf, Variable};

/// The graph `chain` of the joints behind `arm` with their positions and rates made of its coordinates', its torques τ'
/// gathered to Jᵀ τ', and the armature of the coordinates added.
pub(super) fn coupled(arm: &Arm, linkage: &Linkage, chain: &Graph) -> Graph {
    let builder = Builder::new();
    let mut leaves =
        Leaves { harmonics: Harmonics::of_parts(&builder, arm.parts()), builder: &builder, arm, linkage };
    let leaf = |leaf| match leaf {
        Leaf::Input(variable) => leaves.input(variable),
        Leaf::Sin(i) => leaves.turn(i).0,
        Leaf::Cos(i) => leaves.turn(i).1,
    };
    // The torques get names of their own below.
    let name = |name: &str| (!name.starts_with("tau")).then(|| format!("chain_{name}"));
    let made = builder.embed(chain, leaf, name);
    let mut torques: Vec<Expr> = arm
        .joints
        .iter()
        .enumerate()
        .map(|(j, joint)| builder.constant(joint.armature) * builder.input(Variable::Ar(j)))
        .collect();
    for (&output, coupling) in chain.outputs.iter().zip(&linkage.couplings) {
        if let Some(torque) = torques.get_mut(coupling.coordinate) {
            *torque = *torque + builder.constant(coupling.multiplier) * made[output];
        }
    }
    let outputs: Vec<_> =
        (1..).zip(torques).map(|(i, tau)| tau.named(&format!("tau{i}"), true).id()).collect();
    builder.finish(&outputs).factored()
}

/// What the chain's inputs are made of.
struct Leaves<'a, 'g> {
    builder: &'g Builder,
    harmonics: Harmonics<'g>,
    arm: &'a Arm,
    linkage: &'a Linkage,
}

impl<'g> Leaves<'_, 'g> {
    fn input(&self, variable: Variable) -> Expr<'g> {
        let (i, of): (usize, fn(usize) -> Variable) = match variable {
            Variable::Q(i) => (i, Variable::Q),
            Variable::Qd(i) => (i, Variable::Qd),
            Variable::Vr(i) => (i, Variable::Vr),
            Variable::Ar(i) => (i, Variable::Ar),
            // No torque of a model has other inputs.
            other => return self.builder.input(other),
        };
        let coupling = &self.linkage.couplings[i];
        let scaled = self.builder.constant(coupling.multiplier) * self.builder.input(of(coupling.coordinate));
        match variable {
            Variable::Q(_) => scaled + self.builder.constant(coupling.offset),
            _ => scaled,
        }
    }

    /// Sine and cosine of the chain's joint `i`.
    fn turn(&mut self, i: usize) -> (Expr<'g>, Expr<'g>) {
        let coupling = &self.linkage.couplings[i];
        debug_assert!(self.arm.joints[coupling.coordinate].kind == JointKind::Revolute);
        let part = f64::from(self.arm.parts()[coupling.coordinate]);
        // Whole by construction of the linkage.
        let turned = self.harmonics.multiple(coupling.coordinate, (coupling.multiplier * part) as i8);
        if coupling.offset == 0.0 {
            return turned;
        }
        let (sin, cos) = libm::sincos(coupling.offset);
        sum(turned, (self.builder.constant(sin), self.builder.constant(cos)))
    }
}
