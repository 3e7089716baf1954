//! Where a link's frame stands: a revolute joint leaves its place along the axis and its angle about it open, a
//! prismatic joint its whole place.

use super::{Arm, JointKind, Transform};

/// Where along its axis the frame of a revolute joint stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// At the foot of the common normal with the next axis (parallel axes: level with its frame).
    #[default]
    Next,
    /// At the foot of the common normal with the axis before (parallel axes: level with its frame).
    Before,
    /// Where the description has put it.
    Given,
}

/// sin² of the angle between axes whose common normal may stand so far away that digits would be lost.
const NEARLY_PARALLEL: f64 = 1e-3;

/// Offsets below this part of the longest one are rounding left over from moving frames.
const NEGLIGIBLE: f64 = 4e-15;

impl Arm {
    /// The same arm with the moved frame of joint `i` replaced by the frame that stands at `change` in it. `change`
    /// keeps the joint's axis: a turn about z and, for a revolute joint, a shift along z.
    pub(crate) fn reframe(&mut self, i: usize, change: &Transform) {
        let back = change.inverse();
        if let Some(joint) = self.joints.get_mut(i) {
            joint.pose = joint.pose.then(change);
            joint.body = joint.body.moved(&back);
        }
        match self.joints.get_mut(i + 1) {
            Some(next) => next.pose = back.then(&next.pose),
            None => self.tip = back.then(&self.tip),
        }
    }

    /// The same arm, each frame at the place `origins` names and turned so that the next axis stands square to one of
    /// its own: then fewest constants differ from 0 and ±1.
    pub(crate) fn placed(&self, origins: &[Origin]) -> Self {
        let mut arm = self.clone();
        let n = arm.dof();
        let longest = arm.longest();
        for i in (0..n).rev() {
            if let Some(angle) = arm.turn(i) {
                arm.reframe(i, &Transform::rotation(2, angle));
            }
            let next = i + 1 < n && origins.get(i) == Some(&Origin::Next);
            if next && arm.joints[i].kind == JointKind::Revolute {
                let along = feet(&arm.joints[i + 1].pose).0;
                arm.reframe(i, &Transform::translation([0.0, 0.0, along]));
            }
        }
        for i in 1..n {
            let before = match origins.get(i) {
                Some(Origin::Before) => true,
                Some(Origin::Next) => i + 1 == n,
                Some(Origin::Given) | None => false,
            };
            if before && arm.joints[i].kind == JointKind::Revolute {
                let along = feet(&arm.joints[i].pose).1;
                arm.reframe(i, &Transform::translation([0.0, 0.0, along]));
            }
        }
        for joint in &mut arm.joints {
            for offset in &mut joint.pose.translation {
                if offset.abs() < NEGLIGIBLE * longest {
                    *offset = 0.0;
                }
            }
        }
        arm
    }

    /// The longest offset between joints, m.
    pub(super) fn longest(&self) -> f64 {
        self.joints.iter().flat_map(|joint| joint.pose.translation).fold(0.0, |most, p| most.max(p.abs()))
    }

    /// The angle by which frame i must turn for the next axis to lie square; `None` where it does already.
    fn turn(&self, i: usize) -> Option<f64> {
        let next = &self.joints.get(i + 1)?.pose;
        let axis = next.rotation.map(|row| row[2]);
        if axis[0] != 0.0 && axis[1] != 0.0 {
            return Some(libm::atan2(axis[0], -axis[1]));
        }
        let [x, y, _] = next.translation;
        let skew = NEGLIGIBLE * self.longest();
        (next.is_along_z() && x.abs() > skew && y.abs() > skew).then(|| libm::atan2(y, x))
    }
}

/// Feet of the common normal between the z axis and that of the frame at `pose`: how far along the former, and how far
/// along the latter. Of nearly parallel axes the feet level with the other's frame.
fn feet(pose: &Transform) -> (f64, f64) {
    let p = pose.translation;
    let z = pose.rotation.map(|row| row[2]);
    let square = 1.0 - z[2] * z[2];
    if square < NEARLY_PARALLEL {
        return (p[2], 0.0 - p[2] * z[2]);
    }
    let along = p[0] * z[0] + p[1] * z[1] + p[2] * z[2];
    let second = (p[2] * z[2] - along) / square;
    (p[2] + second * z[2], second)
}
