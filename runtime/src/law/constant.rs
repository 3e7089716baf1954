//! The robust law whose switching gain is one number by joint.

use core::array::from_fn;

use super::exact::feedforward_and_feedback;
use super::{Gains, Law, Sample, Switching, Tracking, check_coulomb, check_nonnegative};
use crate::{ConfigError, Model, Real};

/// Equation (16) with a simplified model, less the switching term diag(sgn s) ρ with a constant ρ.
///
/// Where ρ_i is at least what the model is off by, δD a_r + δC v_r + δB q̇ + δG with all disturbances, the V̇ of (17)
/// holds as under (34). It costs less than a bracket, and switches harder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantGainLaw<T, const N: usize> {
    /// P12, K and Pqq.
    pub gains: Gains<T, N>,
    /// ρ, N·m or N, not negative.
    pub robust_gain: [T; N],
    /// sgn, or the boundary layer.
    pub switching: Switching<T, N>,
    /// Coulomb friction of each joint, [forwards ≥ 0, backwards ≤ 0], N·m, added in the desired direction of motion
    /// and not at rest; zeros leave it to the feedback.
    pub coulomb: [[T; 2]; N],
}

impl<M: Model<N, Scalar = T>, T: Real, const N: usize> Law<M, N> for ConstantGainLaw<T, N> {
    type State = ();

    fn initial_state(&self) {}

    fn torque(&self, model: &M, _state: &mut (), sample: &Sample<T, N>) -> [T; N] {
        let tracking = Tracking::new(&self.gains.p12, sample);
        let nominal = feedforward_and_feedback(model, &self.gains, &self.coulomb, sample, &tracking);
        let side = self.switching.at(&tracking.s);
        from_fn(|i| nominal[i] - side[i] * self.robust_gain[i])
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.gains.check()?;
        check_nonnegative("robust_gain", &self.robust_gain.map(|x| [x; N]))?;
        self.switching.check()?;
        check_coulomb(&self.coulomb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::test_states::{GAINS, excess, states};
    use crate::test_arm::TwoLink;
    use crate::{Requirement, TightLaw};

    /// The law whose ρ is the largest that law tight takes at the states of the tests, times `share`.
    fn law(share: f64) -> ConstantGainLaw<f64, 2> {
        let tight = TightLaw {
            gains: GAINS,
            disturbance: [0.0; 2],
            switching: Switching::Sign,
            coulomb: [[0.0; 2]; 2],
        };
        let mut robust_gain = [0.0_f64; 2];
        for sample in states() {
            let gain = tight.robust_gain(&TwoLink::perturbed(), &sample);
            robust_gain = from_fn(|i| robust_gain[i].max(share * gain[i]));
        }
        ConstantGainLaw { gains: GAINS, robust_gain, switching: Switching::Sign, coulomb: [[0.0; 2]; 2] }
    }

    #[test]
    fn outweighs_every_error_up_to_its_gain() {
        let worst = |law: &ConstantGainLaw<f64, 2>| {
            states().map(|sample| excess(law, &sample)).fold(f64::MIN, f64::max)
        };
        Law::<TwoLink<f64>, 2>::check(&law(1.0)).unwrap();
        assert!(worst(&law(1.0)) < 1e-4);
        assert!(worst(&law(0.0)) > 1.0);
    }

    #[test]
    fn refuses_a_negative_gain() {
        let bad = ConstantGainLaw { robust_gain: [1.0, -1.0], ..law(1.0) };
        let error = Law::<TwoLink<f64>, 2>::check(&bad).unwrap_err();
        assert_eq!((error.parameter, error.joint), ("robust_gain", Some(1)));
        assert_eq!(error.requirement, Requirement::NonNegative);
    }
}
