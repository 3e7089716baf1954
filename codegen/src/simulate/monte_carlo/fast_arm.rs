//! The exact arm for many runs: mass matrix and bias in arrays, without allocation.

use gramforge_runtime::{Bounds, Model};

use super::links::{Composite, Link, Pose, add, along, apply, cross};
use crate::arm::{Arm, Coupling, Joint, JointKind, MOST_JOINTS};
use crate::dynamics;
use crate::error::Error;
use crate::simulate::array::vector;

/// The exact model of an arm with `N` joints: zero bounds.
///
/// D by composite bodies, the bias by the Newton–Euler recursion: the numbers of [`dynamics`] up to rounding.
#[derive(Clone, Debug)]
pub(super) struct FastArm<const N: usize> {
    arm: Arm,
    /// The joints that move, base first.
    links: Vec<Link>,
    armature: [f64; N],
    viscous_friction: [f64; N],
    bounds: Bounds<f64, N>,
}

impl<const N: usize> FastArm<N> {
    /// The model of `arm`.
    ///
    /// # Errors
    /// [`Error::Internal`] where the arm has not `N` joints.
    pub(super) fn new(arm: Arm) -> Result<Self, Error> {
        let of_joints = |of: fn(&Joint) -> f64| -> Result<[f64; N], Error> {
            vector("the arm", &arm.joints.iter().map(of).collect::<Vec<_>>())
        };
        let itself = |coordinate| Coupling { coordinate, multiplier: 1.0, offset: 0.0 };
        let follows = |j: usize| match &arm.linkage {
            None => itself(j),
            Some(linkage) => linkage.couplings[j],
        };
        let links: Vec<Link> =
            arm.moving().iter().enumerate().map(|(j, joint)| Link::new(joint, follows(j))).collect();
        if links.len() > MOST_JOINTS {
            return Err(Error::Internal(format!("{} joints move", links.len())));
        }
        let armature = of_joints(|joint| joint.armature)?;
        let viscous_friction = of_joints(|joint| joint.viscous_friction)?;
        Ok(Self { links, armature, viscous_friction, bounds: Bounds::ZERO, arm })
    }

    /// The poses of the joints that move; those beyond the last are not used.
    fn poses(&self, q: &[f64; N]) -> [Pose; MOST_JOINTS] {
        let mut poses = [Pose::default(); MOST_JOINTS];
        poses.iter_mut().zip(&self.links).for_each(|(pose, link)| *pose = link.pose(q));
        poses
    }
}

impl<const N: usize> Model<N> for FastArm<N> {
    type Scalar = f64;

    fn passivity_torque(&self, q: &[f64; N], qd: &[f64; N], v_r: &[f64; N], a_r: &[f64; N]) -> [f64; N] {
        let q = dynamics::positions(&self.arm, q);
        let torque = dynamics::passivity_torque(&self.arm, self.arm.gravity, &q, qd, v_r, a_r);
        std::array::from_fn(|i| torque.get(i).copied().unwrap_or(f64::NAN))
    }

    fn viscous_friction(&self) -> [f64; N] {
        self.viscous_friction
    }

    fn bounds(&self) -> &Bounds<f64, N> {
        &self.bounds
    }

    fn dynamics_bias(&self, q: &[f64; N], qd: &[f64; N]) -> [f64; N] {
        let poses = self.poses(q);
        let mut wrenches = [([0.0; 3], [0.0; 3]); MOST_JOINTS];
        // ω, ω̇ and the acceleration of the origin, less gravity.
        let (mut w, mut dw, mut a) = ([0.0; 3], [0.0; 3], self.arm.gravity.map(|g| -g));
        for ((link, pose), wrench) in self.links.iter().zip(&poses).zip(&mut wrenches) {
            let rate = link.rate(qd);
            let swept = add(cross(dw, pose.origin), cross(w, cross(w, pose.origin)));
            (w, dw, a) = (pose.inward(w), pose.inward(dw), pose.inward(add(a, swept)));
            // ω × z q̇ has no z component.
            let bend = [w[1] * rate, -w[0] * rate];
            match link.kind {
                JointKind::Revolute => {
                    dw = [dw[0] + bend[0], dw[1] + bend[1], dw[2]];
                    w[2] += rate;
                }
                JointKind::Prismatic => a = [a[0] + 2.0 * bend[0], a[1] + 2.0 * bend[1], a[2]],
            }
            let Composite { mass, first, .. } = link.body;
            let turned = add(cross(dw, first), cross(w, cross(w, first)));
            let gyral = cross(w, apply(&link.inertia, w));
            let moment = add(add(apply(&link.inertia, dw), gyral), cross(first, a));
            *wrench = (add(a.map(|a| mass * a), turned), moment);
        }
        let mut bias = [0.0; N];
        let mut carried = ([0.0; 3], [0.0; 3]);
        for ((link, pose), wrench) in self.links.iter().zip(&poses).zip(&wrenches).rev() {
            let (force, moment) = (add(wrench.0, carried.0), add(wrench.1, carried.1));
            if let Some(sum) = bias.get_mut(link.follows.coordinate) {
                *sum += link.follows.multiplier * along(link.kind, force, moment);
            }
            carried = pose.wrench(force, moment);
        }
        bias
    }

    fn mass_matrix(&self, q: &[f64; N]) -> [[f64; N]; N] {
        let poses = self.poses(q);
        let mut out = [[0.0; N]; N];
        let mut carried: Option<Composite> = None;
        for (i, link) in self.links.iter().enumerate().rev() {
            let body = carried.map_or(link.body, |carried| link.body.plus(&carried));
            let (mut force, mut moment) = body.driven(link.kind);
            for (j, below) in self.links.iter().enumerate().take(i + 1).rev() {
                let entry =
                    link.follows.multiplier * below.follows.multiplier * along(below.kind, force, moment);
                let (row, column) = (link.follows.coordinate, below.follows.coordinate);
                out[row][column] += entry;
                if i != j {
                    out[column][row] += entry;
                }
                (force, moment) = poses[j].wrench(force, moment);
            }
            carried = Some(poses[i].moved(&body));
        }
        (0..N).for_each(|i| out[i][i] += self.armature[i]);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::prepare;
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use std::path::Path;

    /// Compares with the recursion at ten states of the arm of `file`.
    fn agrees<const N: usize>(file: &str) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
        let fast = FastArm::<N>::new(prepare(&path).unwrap().built.given).unwrap();
        for point in (0..10).map(|index| LowDiscrepancy::new(2 * N).point(index)) {
            let q: [f64; N] = std::array::from_fn(|i| 4.0 * point[i] - 2.0);
            let qd: [f64; N] = std::array::from_fn(|i| 6.0 * point[N + i] - 3.0);
            let inertia = dynamics::mass_matrix(&fast.arm, &q);
            let size = inertia.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (row, exact) in fast.mass_matrix(&q).iter().zip(&inertia) {
                for (entry, exact) in row.iter().zip(exact) {
                    assert!((entry - exact).abs() < 1e-13 * size, "{file}: {entry} {exact}");
                }
            }
            let bias = dynamics::inverse_dynamics(&fast.arm, &q, &qd, &[0.0; N]);
            let size = bias.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for (torque, exact) in fast.dynamics_bias(&q, &qd).iter().zip(&bias) {
                assert!((torque - exact).abs() < 1e-12 * size, "{file}: {torque} {exact}");
            }
        }
    }

    #[test]
    fn arms_have_the_dynamics_of_the_recursion() {
        agrees::<3>("generated/specs/arm3_exact.json");
        agrees::<6>("generated/specs/puma560_exact.json");
        agrees::<6>("tests/data/stanford.json");
        agrees::<7>("tests/data/panda.json");
        // Joints that follow others.
        agrees::<2>("tests/data/follower.json");
    }
}
