//! The arms that a run may meet: the box of all uncertain numbers, of inertia and of viscous friction.

use crate::arm::{Arm, Uncertainty};
use crate::dynamics::inverse_dynamics;

/// All arms of a specification.
#[derive(Clone, Debug)]
pub struct Family<'a> {
    /// The arm as specified.
    pub arm: &'a Arm,
    /// Its uncertain numbers of inertia.
    pub uncertainty: &'a Uncertainty,
    /// By joint, what the viscous friction may differ by from the arm's own, lowest and highest, N·m·s/rad or N·s/m;
    /// empty where it is known.
    pub viscous: Vec<[f64; 2]>,
}

impl Family<'_> {
    /// Lowest and highest value of every uncertain number, counted from the arm's own: those of inertia first, then the
    /// viscous friction of each joint whose friction is uncertain.
    pub(super) fn ranges(&self) -> Vec<[f64; 2]> {
        let inertia = self.uncertainty.parameters.iter().map(|parameter| [parameter.low, parameter.high]);
        inertia.chain(self.rubbing().map(|(_, range)| range)).collect()
    }

    /// The arm where the uncertain numbers have these values.
    pub(super) fn at(&self, values: &[f64]) -> Arm {
        let (inertia, friction) = values.split_at(self.uncertainty.parameters.len().min(values.len()));
        let mut arm = self.uncertainty.at(self.arm, inertia);
        for ((joint, _), change) in self.rubbing().zip(friction) {
            arm.joints[joint].viscous_friction += change;
        }
        arm
    }

    /// By uncertain number, the torque that its value 1 takes along a motion, N·m or N: the model is linear in it.
    pub(super) fn torques(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<Vec<f64>> {
        let inertia = (0..self.uncertainty.parameters.len())
            .map(|k| inverse_dynamics(&self.uncertainty.alone(self.arm, k), q, qd, qdd));
        let friction = self.rubbing().map(|(joint, _)| {
            let own = |(i, qd): (usize, &f64)| if i == joint { *qd } else { 0.0 };
            qd.iter().enumerate().map(own).collect()
        });
        inertia.chain(friction).collect()
    }

    fn rubbing(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        self.viscous.iter().copied().enumerate().filter(|(_, range)| *range != [0.0; 2])
    }
}
