//! Rigid bodies: the ten inertial parameters, how they move from frame to frame and how they add.

use super::{Body, Transform};
use crate::spec::SymmetricSpec;

/// A symmetric 3×3 matrix by rows.
pub(super) type Matrix = [[f64; 3]; 3];

impl Body {
    /// A body by its mass (kg), centre of mass (m) and inertia tensor about the centre of mass (kg·m², axes of the
    /// frame in which `com` stands): Σ = tr(I)/2·1 − I + m c cᵀ.
    pub fn from_com(mass: f64, com: [f64; 3], inertia: [[f64; 3]; 3]) -> Self {
        let half_trace = 0.5 * (inertia[0][0] + inertia[1][1] + inertia[2][2]);
        let pseudo_inertia = symmetric(|i, j| {
            let central = if i == j { half_trace - inertia[i][i] } else { -inertia[i][j] };
            central + mass * com[i] * com[j]
        });
        Self { mass, first_moment: com.map(|c| mass * c), pseudo_inertia }
    }

    /// The same body in the parent of its frame, where the frame stands at `pose`:
    /// Σ' = RΣRᵀ + (Rs)pᵀ + p(Rs)ᵀ + m p pᵀ, s' = Rs + m p.
    pub fn moved(&self, pose: &Transform) -> Self {
        let (r, p) = (&pose.rotation, pose.translation);
        let s = pose.turn(self.first_moment);
        let pseudo_inertia = symmetric(|i, j| {
            let mut turned = 0.0;
            for k in 0..3 {
                for l in 0..3 {
                    turned += r[i][k] * self.pseudo_inertia[k][l] * r[j][l];
                }
            }
            turned + s[i] * p[j] + p[i] * s[j] + self.mass * p[i] * p[j]
        });
        let first_moment = std::array::from_fn(|i| s[i] + self.mass * p[i]);
        Self { mass: self.mass, first_moment, pseudo_inertia }
    }

    /// Both bodies welded together; they stand in the same frame.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first_moment: std::array::from_fn(|i| self.first_moment[i] + other.first_moment[i]),
            pseudo_inertia: symmetric(|i, j| self.pseudo_inertia[i][j] + other.pseudo_inertia[i][j]),
        }
    }

    /// Every parameter times `k`.
    pub fn scaled(&self, k: f64) -> Self {
        Self {
            mass: k * self.mass,
            first_moment: self.first_moment.map(|s| k * s),
            pseudo_inertia: self.pseudo_inertia.map(|row| row.map(|s| k * s)),
        }
    }

    /// Centre of mass, m; the frame's origin for a massless body.
    pub fn com(&self) -> [f64; 3] {
        if self.mass > 0.0 { self.first_moment.map(|s| s / self.mass) } else { [0.0; 3] }
    }

    /// Inertia tensor about the centre of mass, axes of the frame, kg·m².
    pub fn inertia_at_com(&self) -> [[f64; 3]; 3] {
        let c = self.com();
        let central = symmetric(|i, j| self.pseudo_inertia[i][j] - self.mass * c[i] * c[j]);
        let trace = central[0][0] + central[1][1] + central[2][2];
        symmetric(|i, j| if i == j { trace - central[i][i] } else { -central[i][j] })
    }

    /// True where every parameter is a finite number.
    pub fn is_finite(&self) -> bool {
        self.mass.is_finite()
            && self.first_moment.iter().chain(self.pseudo_inertia.iter().flatten()).all(|v| v.is_finite())
    }
}

/// The symmetric matrix with the entries `upper(i, j)`, i ≤ j; exactly symmetric, whatever the rounding.
fn symmetric(upper: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| upper(i.min(j), i.max(j))))
}

/// The matrix that a specification writes by its six entries.
pub(super) fn matrix(s: &SymmetricSpec) -> Matrix {
    [[s.xx, s.xy, s.xz], [s.xy, s.yy, s.yz], [s.xz, s.yz, s.zz]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Matrix, b: &Matrix) -> bool {
        a.iter().flatten().zip(b.iter().flatten()).all(|(x, y)| (x - y).abs() < 1e-14)
    }

    #[test]
    fn moving_there_and_back_changes_nothing() {
        let inertia = [[0.3, 0.01, -0.02], [0.01, 0.2, 0.03], [-0.02, 0.03, 0.4]];
        let body = Body::from_com(2.0, [0.1, -0.2, 0.3], inertia);
        assert!(close(&body.inertia_at_com(), &inertia));
        let pose =
            Transform::roll_pitch_yaw([0.3, -0.7, 1.1]).then(&Transform::translation([0.5, -0.1, 0.2]));
        let back = body.moved(&pose).moved(&pose.inverse());
        assert!(close(&back.pseudo_inertia, &body.pseudo_inertia));
        assert!((0..3).all(|i| (back.com()[i] - body.com()[i]).abs() < 1e-15));
    }

    #[test]
    fn two_halves_of_a_rod_make_the_rod() {
        let rod = |mass: f64, length: f64, middle: f64| {
            let transverse = mass * length * length / 12.0;
            Body::from_com(
                mass,
                [middle, 0.0, 0.0],
                [[0.0; 3], [0.0, transverse, 0.0], [0.0, 0.0, transverse]],
            )
        };
        let whole = rod(2.0, 1.0, 0.5);
        let halves = rod(1.0, 0.5, 0.25).plus(&rod(1.0, 0.5, 0.75));
        assert!(close(&whole.pseudo_inertia, &halves.pseudo_inertia));
        assert!(close(&whole.inertia_at_com(), &halves.inertia_at_com()));
    }
}
