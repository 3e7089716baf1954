//! Rigid transforms, with exact right angles.

use super::round::{NOISE, rounded};

/// A pose: x_parent = rotation · x_child + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Rotation, by rows; its columns are the child's axes in the parent.
    pub rotation: [[f64; 3]; 3],
    /// The child's origin in the parent, m.
    pub translation: [f64; 3],
}

/// Angles up to this one are told apart from right angles; of larger ones 2 ulp are more than any file means.
const LARGEST_ANGLE: f64 = 1e3;

impl Transform {
    /// The identity.
    pub const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// Rotation by `angle` (rad) about coordinate axis 0 (x), 1 (y) or 2 (z); an angle within 2 ulp of a multiple of
    /// π/2 is that right angle.
    pub fn rotation(axis: usize, angle: f64) -> Self {
        let (sin, cos) = right_angle(angle).unwrap_or_else(|| libm::sincos(angle));
        let mut out = Self::IDENTITY;
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        out.rotation[j][j] = cos;
        out.rotation[k][k] = cos;
        out.rotation[j][k] = 0.0 - sin;
        out.rotation[k][j] = sin;
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
        let least = if axis[0].abs() <= axis[1].abs() { 0 } else { 1 };
        // x of the new frame: along the parent's x (y) made perpendicular to the axis.
        let mut x = [0.0; 3];
        x[least] = 1.0;
        let along = axis[least];
        let x: [f64; 3] = std::array::from_fn(|i| x[i] - along * axis[i]);
        let norm = libm::sqrt(x.iter().map(|v| v * v).sum());
        let x = x.map(|v| v / norm);
        let y = cross(axis, x);
        // No negative zeros.
        let rotation = std::array::from_fn(|i| [x[i], y[i], axis[i]].map(|entry| entry + 0.0));
        Self { rotation, translation: [0.0; 3] }.rounded(NOISE)
    }

    /// The same place, its rotation replaced by the simplest one that a turn of `angle` rad or less reaches.
    #[must_use]
    pub fn rounded(&self, angle: f64) -> Self {
        Self { rotation: rounded(&self.rotation, angle), ..*self }
    }

    /// Whether the child's z axis is parallel to the parent's, the same or the opposite way.
    ///
    /// The other entries of its column say so: an entry next to 1 is 1 long before they vanish.
    pub fn is_along_z(&self) -> bool {
        self.rotation[0][2] == 0.0 && self.rotation[1][2] == 0.0
    }

    /// The pose of the parent in the child.
    pub fn inverse(&self) -> Self {
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| self.rotation[j][i]));
        let back = Self { rotation, translation: [0.0; 3] };
        // 0 − v and not −v: no negative zeros.
        Self { translation: back.turn(self.translation).map(|v| 0.0 - v), ..back }
    }

    /// `self` followed by `next`: the pose of next's child in self's parent. What rounding leaves where a zero belongs
    /// is taken away.
    pub fn then(&self, next: &Self) -> Self {
        let mut rotation = [[0.0; 3]; 3];
        for (i, row) in rotation.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = (0..3).map(|k| self.rotation[i][k] * next.rotation[k][j]).sum::<f64>() + 0.0;
            }
        }
        Self { rotation, translation: self.apply(next.translation) }.rounded(NOISE)
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

/// Sine and cosine of `angle` where it lies within 2 ulp of a multiple of π/2.
fn right_angle(angle: f64) -> Option<(f64, f64)> {
    let quarters = libm::round(angle / std::f64::consts::FRAC_PI_2);
    let near = quarters * std::f64::consts::FRAC_PI_2;
    let ulp = near.abs().next_up() - near.abs();
    if angle.abs() > LARGEST_ANGLE || (angle - near).abs() > 2.0 * ulp {
        return None;
    }
    // The remainder keeps the sign.
    Some(match (quarters % 4.0) as i8 {
        0 => (0.0, 1.0),
        1 | -3 => (1.0, 0.0),
        2 | -2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_are_exact_and_what_is_beside_them_is_not_lost() {
        use std::f64::consts::FRAC_PI_2;
        for quarters in -9_i32..=9 {
            let right = f64::from(quarters) * FRAC_PI_2;
            let exact = Transform::rotation(0, right).rotation;
            assert!(exact.iter().flatten().all(|entry| entry.fract() == 0.0), "{quarters}");
            let four = (quarters.rem_euclid(4)) as usize;
            assert_eq!([exact[1][1], exact[2][1]], [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][four]);
            for beside in [right.next_up().next_up(), right.next_down().next_down()] {
                assert_eq!(Transform::rotation(0, beside).rotation, exact);
            }
            for off in [1e-12, 4.4e-6, 1e-3] {
                let near = Transform::rotation(0, right + off).rotation;
                let turned =
                    Transform::rotation(0, right).inverse().then(&Transform::rotation(0, right + off));
                assert!((turned.rotation[2][1] - libm::sin(off)).abs() < 4e-15, "{near:?}");
            }
        }
    }

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
