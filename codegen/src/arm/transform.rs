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

/// `x`, or the nearest of −1, 0, 1 where it lies within [`SNAP`] of it.
fn snap(x: f64) -> f64 {
    let near = x.round();
    if (x - near).abs() < SNAP { near + 0.0 } else { x }
}
