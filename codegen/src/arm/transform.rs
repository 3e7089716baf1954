//! Rigid transforms, with exact right angles.

/// A pose: x_parent = rotation · x_child + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Rotation, by rows; its columns are the child's axes in the parent.
    pub rotation: [[f64; 3]; 3],
    /// The child's origin in the parent, m.
    pub translation: [f64; 3],
}

/// Entries of a rotation nearer than this to −1, 0 or 1 are taken to be meant so: files write π/2 with few
/// digits, and a twist of 1e-12 rad would otherwise spread hundreds of spurious terms over the expansion.
const SNAP: f64 = 1e-11;

impl Transform {
    /// The identity.
    pub const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// Rotation by `angle` (rad) about coordinate axis 0 (x), 1 (y) or 2 (z).
    pub fn rotation(axis: usize, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let mut out = Self::IDENTITY;
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        out.rotation[j][j] = snap(cos);
        out.rotation[k][k] = snap(cos);
        out.rotation[j][k] = snap(-sin);
        out.rotation[k][j] = snap(sin);
        out
    }

    /// Translation by `offset`, m.
    pub fn translation(offset: [f64; 3]) -> Self {
        Self { translation: offset, ..Self::IDENTITY }
    }

    /// Fixed-axis roll, pitch, yaw (rad) as URDF means them: Rz(yaw) Ry(pitch) Rx(roll).
    pub fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> Self {
        Self::rotation(2, yaw).then(&Self::rotation(1, pitch)).then(&Self::rotation(0, roll))
    }

    /// A rotation that takes z to the unit vector `axis`: the identity for +z, exact right angles for the other
    /// coordinate axes.
    pub fn z_to(axis: [f64; 3]) -> Self {
        let axis = axis.map(snap);
        let least = if axis[0].abs() <= axis[1].abs() { 0 } else { 1 };
        // x of the new frame: along the parent's x (y) made perpendicular to the axis.
        let mut x = [0.0; 3];
        x[least] = 1.0;
        let along = axis[least];
        let x: [f64; 3] = std::array::from_fn(|i| x[i] - along * axis[i]);
        let norm = libm::sqrt(x.iter().map(|v| v * v).sum());
        let x = x.map(|v| snap(v / norm));
        let y = cross(axis, x);
        Self { rotation: std::array::from_fn(|i| [x[i], snap(y[i]), axis[i]]), translation: [0.0; 3] }
    }

    /// The pose of the parent in the child.
    pub fn inverse(&self) -> Self {
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| self.rotation[j][i]));
        let back = Self { rotation, translation: [0.0; 3] };
        // 0 − v and not −v: no negative zeros.
        Self { translation: back.turn(self.translation).map(|v| 0.0 - v), ..back }
    }

    /// `self` followed by `next`: the pose of next's child in self's parent.
    pub fn then(&self, next: &Self) -> Self {
        let mut rotation = [[0.0; 3]; 3];
        for (i, row) in rotation.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = snap((0..3).map(|k| self.rotation[i][k] * next.rotation[k][j]).sum());
            }
        }
        Self { rotation, translation: self.apply(next.translation) }
    }

    /// The point `x` of the child frame in the parent frame.
    pub fn apply(&self, x: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(x);
        std::array::from_fn(|i| turned[i] + self.translation[i])
    }

    /// The direction `x` of the child frame in the parent frame.
    pub fn turn(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| self.rotation[i][k] * x[k]).sum())
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `x`, or the nearest of −1, 0, 1 where it lies within [`SNAP`] of it.
fn snap(x: f64) -> f64 {
    let near = x.round();
    if (x - near).abs() < SNAP { near + 0.0 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_to_takes_z_to_the_axis_and_keeps_right_angles_exact() {
        let s = libm::sqrt(1.0 / 3.0);
        let axes = [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [s, s, s],
            [0.6, 0.0, -0.8],
        ];
        for axis in axes {
            let turn = Transform::z_to(axis);
            let z = turn.turn([0.0, 0.0, 1.0]);
            assert!((0..3).all(|i| (z[i] - axis[i]).abs() < 1e-15), "{axis:?}");
            let unit = turn.inverse().then(&turn);
            for i in 0..3 {
                for j in 0..3 {
                    assert!((unit.rotation[i][j] - Transform::IDENTITY.rotation[i][j]).abs() < 1e-15);
                    if axis.contains(&1.0) || axis.contains(&-1.0) {
                        assert_eq!(turn.rotation[i][j].fract(), 0.0);
                    }
                }
            }
            let r = turn.rotation;
            let x = [r[0][0], r[1][0], r[2][0]];
            let y = [r[0][1], r[1][1], r[2][1]];
            assert!((0..3).all(|i| (cross(x, y)[i] - axis[i]).abs() < 1e-15), "{axis:?} is left-handed");
        }
        assert_eq!(Transform::z_to([0.0, 0.0, 1.0]), Transform::IDENTITY);
    }
}
