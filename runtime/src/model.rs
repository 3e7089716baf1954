//! What a generated module implements.

use core::array::from_fn;

use crate::Real;
use crate::vector::{add, scale, sub, unit};

/// A dynamic model D̂(q) q̈ + Ĉ(q, q̇) q̇ + Ĝ(q) + B̂ q̇ = τ of an arm with `N` joints, with bounds on what it leaves out.
///
/// Ĉ is the Christoffel form of equation (1); positions in rad (m for prismatic joints), torques in N·m (N).
///
/// The required methods are what a control law needs. The provided ones recover the separate terms from
/// [`passivity_torque`](Model::passivity_torque) by linearity; they serve simulators and tests, cost several calls, and
/// carry the rounding error of a difference: about one unit in the last place of the gravity torque.
pub trait Model<const N: usize> {
    /// Number type.
    type Scalar: Real;

    /// The passivity torque D̂(q) a_r + Ĉ(q, q̇) v_r + Ĝ(q), without friction, N·m.
    fn passivity_torque(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        v_r: &[Self::Scalar; N],
        a_r: &[Self::Scalar; N],
    ) -> [Self::Scalar; N];

    /// Diagonal of B̂, viscous friction, N·m·s/rad.
    fn viscous_friction(&self) -> [Self::Scalar; N];

    /// Bounds on |D − D̂|, |h − ĥ|, |B − B̂|, |G − Ĝ| inside the domain the module states.
    fn bounds(&self) -> &Bounds<Self::Scalar, N>;

    /// Ĝ(q), the torque of gravity, N·m: one call.
    fn gravity(&self, q: &[Self::Scalar; N]) -> [Self::Scalar; N] {
        let zero = [Self::Scalar::ZERO; N];
        self.passivity_torque(q, &zero, &zero, &zero)
    }

    /// Ĉ(q, q̇) q̇ + Ĝ(q), N·m: one call.
    fn dynamics_bias(&self, q: &[Self::Scalar; N], qd: &[Self::Scalar; N]) -> [Self::Scalar; N] {
        self.passivity_torque(q, qd, qd, &[Self::Scalar::ZERO; N])
    }

    /// D̂(q), by rows, kg·m²: N + 1 calls. Symmetric up to rounding.
    fn mass_matrix(&self, q: &[Self::Scalar; N]) -> [[Self::Scalar; N]; N] {
        let zero = [Self::Scalar::ZERO; N];
        let gravity = self.gravity(q);
        let columns: [_; N] = from_fn(|j| sub(&self.passivity_torque(q, &zero, &zero, &unit(j)), &gravity));
        from_fn(|i| from_fn(|j| columns[j][i]))
    }

    /// Ĉ(q, q̇), by rows, N·m·s/rad: the Christoffel matrix c_ij = Σ_k h_ijk q̇_k of equation (1), N + 1 calls.
    fn coriolis(&self, q: &[Self::Scalar; N], qd: &[Self::Scalar; N]) -> [[Self::Scalar; N]; N] {
        let zero = [Self::Scalar::ZERO; N];
        let gravity = self.gravity(q);
        let columns: [_; N] = from_fn(|j| sub(&self.passivity_torque(q, qd, &unit(j), &zero), &gravity));
        from_fn(|i| from_fn(|j| columns[j][i]))
    }

    /// The left side of equation (1), D̂ q̈ + Ĉ q̇ + B̂ q̇ + Ĝ, N·m: one call.
    fn inverse_dynamics(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        qdd: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        add(&self.passivity_torque(q, qd, qd, qdd), &scale(&self.viscous_friction(), qd))
    }
}

impl<M: Model<N> + ?Sized, const N: usize> Model<N> for &M {
    type Scalar = M::Scalar;

    fn passivity_torque(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        v_r: &[Self::Scalar; N],
        a_r: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        (**self).passivity_torque(q, qd, v_r, a_r)
    }

    fn viscous_friction(&self) -> [Self::Scalar; N] {
        (**self).viscous_friction()
    }

    fn bounds(&self) -> &Bounds<Self::Scalar, N> {
        (**self).bounds()
    }

    // A model may override these with something cheaper; a reference to it must not lose that.
    fn gravity(&self, q: &[Self::Scalar; N]) -> [Self::Scalar; N] {
        (**self).gravity(q)
    }

    fn dynamics_bias(&self, q: &[Self::Scalar; N], qd: &[Self::Scalar; N]) -> [Self::Scalar; N] {
        (**self).dynamics_bias(q, qd)
    }

    fn mass_matrix(&self, q: &[Self::Scalar; N]) -> [[Self::Scalar; N]; N] {
        (**self).mass_matrix(q)
    }

    fn coriolis(&self, q: &[Self::Scalar; N], qd: &[Self::Scalar; N]) -> [[Self::Scalar; N]; N] {
        (**self).coriolis(q, qd)
    }

    fn inverse_dynamics(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        qdd: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        (**self).inverse_dynamics(q, qd, qdd)
    }
}

/// Element-by-element bounds on what a model leaves out, equations (26)–(32).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<T, const N: usize> {
    /// ΔD, kg·m².
    pub d: [[T; N]; N],
    /// Δh_ijk, kg·m².
    pub h: [[[T; N]; N]; N],
    /// ΔB of the diagonal viscous friction, N·m·s/rad.
    pub b: [T; N],
    /// ΔG, N·m.
    pub g: [T; N],
}

impl<T: Real, const N: usize> Bounds<T, N> {
    /// The bounds of a model that leaves nothing out.
    pub const ZERO: Self =
        Self { d: [[T::ZERO; N]; N], h: [[[T::ZERO; N]; N]; N], b: [T::ZERO; N], g: [T::ZERO; N] };

    /// ΔC by rows, N·m·s/rad: ΔC_ij = Σ_k Δh_ijk max|q̇_k|, equation (30), for the largest joint speeds, rad/s.
    pub fn coriolis(&self, max_speed: &[T; N]) -> [[T; N]; N] {
        from_fn(|i| from_fn(|j| crate::vector::dot(&self.h[i][j], max_speed)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_arm::TwoLink;
    use crate::vector::mat_vec;

    const STATES: [([f64; 2], [f64; 2]); 4] = [
        ([0.3, -1.1], [0.7, -0.4]),
        ([2.0, 0.0], [-1.5, 2.5]),
        ([-2.9, 1.6], [3.0, 3.0]),
        ([0.0, 3.1], [-0.2, -4.0]),
    ];

    fn assert_close(a: &[f64; 2], b: &[f64; 2], tolerance: f64) {
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() <= tolerance, "{a:?} against {b:?}");
        }
    }

    #[test]
    fn provided_methods_give_the_closed_forms() {
        let arm = TwoLink::<f64>::EXAMPLE;
        for (q, qd) in STATES {
            assert_close(&arm.gravity(&q), &arm.closed_gravity(&q), 1e-14);
            for (row, closed) in arm.mass_matrix(&q).iter().zip(&arm.closed_mass_matrix(&q)) {
                assert_close(row, closed, 1e-13);
            }
            for (row, closed) in arm.coriolis(&q, &qd).iter().zip(&arm.closed_coriolis(&q, &qd)) {
                assert_close(row, closed, 1e-13);
            }
            let bias = add(&mat_vec(&arm.closed_coriolis(&q, &qd), &qd), &arm.closed_gravity(&q));
            assert_close(&arm.dynamics_bias(&q, &qd), &bias, 1e-13);
        }
    }

    #[test]
    fn inverse_dynamics_is_equation_1() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let (q, qd) = STATES[0];
        let qdd = [1.3, -2.2];
        let inertia = mat_vec(&arm.closed_mass_matrix(&q), &qdd);
        let coriolis = mat_vec(&arm.closed_coriolis(&q, &qd), &qd);
        let gravity = arm.closed_gravity(&q);
        let expected = from_fn(|i| inertia[i] + coriolis[i] + gravity[i] + arm.friction[i] * qd[i]);
        assert_close(&arm.inverse_dynamics(&q, &qd, &qdd), &expected, 1e-13);
    }

    #[test]
    fn mass_rate_less_twice_coriolis_is_skew() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let step = 1e-5;
        for (q, qd) in STATES {
            let after = arm.mass_matrix(&from_fn(|i| q[i] + step * qd[i]));
            let before = arm.mass_matrix(&from_fn(|i| q[i] - step * qd[i]));
            let coriolis = arm.coriolis(&q, &qd);
            let skew: [[f64; 2]; 2] =
                from_fn(|i| from_fn(|j| (after[i][j] - before[i][j]) / (2.0 * step) - 2.0 * coriolis[i][j]));
            for i in 0..2 {
                for j in 0..2 {
                    assert!((skew[i][j] + skew[j][i]).abs() < 1e-8, "{skew:?}");
                }
            }
        }
    }

    #[test]
    fn coriolis_bound_holds_for_a_perturbed_arm() {
        let (arm, nominal) = (TwoLink::<f64>::EXAMPLE, TwoLink::<f64>::perturbed());
        let bound = nominal.bounds.coriolis(&[3.0, 4.0]);
        for (q, qd) in STATES {
            let (exact, simplified) = (arm.coriolis(&q, &qd), nominal.coriolis(&q, &qd));
            for i in 0..2 {
                for j in 0..2 {
                    assert!((exact[i][j] - simplified[i][j]).abs() <= bound[i][j] + 1e-12);
                }
            }
        }
        assert!(bound[0][1] > 0.0 && bound[1][1] == 0.0);
    }

    #[test]
    fn a_reference_is_the_same_model() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let (q, qd) = STATES[2];
        assert_eq!(Model::coriolis(&&arm, &q, &qd), arm.coriolis(&q, &qd));
        assert_eq!(Model::mass_matrix(&&arm, &q), arm.mass_matrix(&q));
    }
}
