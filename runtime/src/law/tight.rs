//! The law that bounds the model's error at the state at hand, instead of (34)'s bracket.

use core::array::from_fn;

use super::exact::feedforward_and_feedback;
use super::{Gains, Law, Sample, Switching, Tracking, check_coulomb, check_nonnegative};
use crate::vector::{abs, dot};
use crate::{ConfigError, Model, Real};

/// Equation (16) with a simplified model, less the switching term diag(sgn s) ρ with
///
/// ρ_i = Σ_j ΔD_ij|a_r,j| + Σ_jk Δh_ijk|v_r,j||q̇_k| + ΔB_i|q̇_i| + ΔG_i + disturbance_i.
///
/// The model's error is δD a_r + δC v_r + δB q̇ + δG with δC_ij = Σ_k δh_ijk q̇_k, so ρ outweighs it as it stands: no
/// bound on the speed, no ΔC1, and the V̇ of (17) as under (34).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TightLaw<T, const N: usize> {
    /// P12, K and Pqq.
    pub gains: Gains<T, N>,
    /// Bound on torques that no model has, such as Coulomb friction: added to ΔG, N·m, not negative.
    pub disturbance: [T; N],
    /// sgn, or the boundary layer.
    pub switching: Switching<T, N>,
    /// Coulomb friction of each joint, [forwards ≥ 0, backwards ≤ 0], N·m, added in the desired direction of motion
    /// and not at rest; zeros leave it to the feedback.
    pub coulomb: [[T; 2]; N],
}

impl<T: Real, const N: usize> TightLaw<T, N> {
    /// ρ, the size of the switching term, N·m.
    pub fn robust_gain<M: Model<N, Scalar = T>>(&self, model: &M, sample: &Sample<T, N>) -> [T; N] {
        self.gain(model, sample, &Tracking::new(&self.gains.p12, sample))
    }

    fn gain<M: Model<N, Scalar = T>>(
        &self,
        model: &M,
        sample: &Sample<T, N>,
        tracking: &Tracking<T, N>,
    ) -> [T; N] {
        let bounds = model.bounds();
        let (speed, v_r, a_r) = (abs(&sample.qd), abs(&tracking.v_r), abs(&tracking.a_r));
        from_fn(|i| {
            let coriolis: [T; N] = from_fn(|j| dot(&bounds.h[i][j], &speed));
            dot(&bounds.d[i], &a_r)
                + dot(&coriolis, &v_r)
                + bounds.b[i] * speed[i]
                + bounds.g[i]
                + self.disturbance[i]
        })
    }
}

impl<M: Model<N, Scalar = T>, T: Real, const N: usize> Law<M, N> for TightLaw<T, N> {
    type State = ();

    fn initial_state(&self) {}

    fn torque(&self, model: &M, _state: &mut (), sample: &Sample<T, N>) -> [T; N] {
        let tracking = Tracking::new(&self.gains.p12, sample);
        let nominal = feedforward_and_feedback(model, &self.gains, &self.coulomb, sample, &tracking);
        let size = self.gain(model, sample, &tracking);
        let side = self.switching.at(&tracking.s);
        from_fn(|i| nominal[i] - side[i] * size[i])
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.gains.check()?;
        check_nonnegative("disturbance", &self.disturbance.map(|x| [x; N]))?;
        self.switching.check()?;
        check_coulomb(&self.coulomb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Desired;
    use crate::law::test_states::{GAINS, excess, states};
    use crate::test_arm::TwoLink;

    fn law(switching: Switching<f64, 2>) -> TightLaw<f64, 2> {
        TightLaw { gains: GAINS, disturbance: [0.0; 2], switching, coulomb: [[0.0; 2]; 2] }
    }

    #[test]
    fn outweighs_every_error_inside_the_bounds() {
        let robust = law(Switching::Sign);
        Law::<TwoLink<f64>, 2>::check(&robust).unwrap();
        let worst = states().map(|sample| excess(&robust, &sample)).fold(f64::MIN, f64::max);
        assert!(worst < 1e-4, "V̇ exceeds −zᵀMz by {worst}");
    }

    #[test]
    fn boundary_layer_costs_a_quarter_of_gain_times_width() {
        let layer = law(Switching::BoundaryLayer([0.5; 2]));
        for sample in states() {
            let gain = layer.robust_gain(&TwoLink::perturbed(), &sample);
            assert!(excess(&layer, &sample) < (gain[0] + gain[1]) * 0.5 / 4.0 + 1e-4);
        }
    }

    #[test]
    fn gain_has_the_terms_of_its_definition() {
        // v_r = (−1, 1), a_r = (−3, 4) with P12 = [3, 1; 1, 3]; |q̇| = (1, 2); h bounds 0.05.
        let sample = Sample {
            q: [0.5, -0.5],
            qd: [1.0, -2.0],
            desired: Desired { q: [0.0; 2], qd: [0.0; 2], qdd: [-2.0, -1.0] },
            period: 1e-3,
        };
        let gain = law(Switching::Sign).robust_gain(&TwoLink::perturbed(), &sample);
        let expected = [
            0.25 * 3.0 + 0.08 * 4.0 + 0.05 * (1.0 * 2.0 + 1.0 * 1.0 + 1.0 * 2.0) + 0.05 + 1.5,
            0.08 * 3.0 + 0.03 * 4.0 + 0.05 * 1.0 + 0.02 * 2.0 + 0.5,
        ];
        for i in 0..2 {
            assert!((gain[i] - expected[i]).abs() < 1e-12, "{gain:?} {expected:?}");
        }
    }
}
