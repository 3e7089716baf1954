//! The law for a model without error, equation (16).

use core::array::from_fn;

use super::{Gains, Law, Sample, Tracking, check_coulomb, coulomb_torque};
use crate::vector::mat_vec;
use crate::{ConfigError, Model, Real};

/// τ = D a_r + C v_r + B q̇ + G − K s + Pqq q_e, equation (16): with an exact model V̇ is negative definite (17).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactLaw<T, const N: usize> {
    /// P12, K and Pqq.
    pub gains: Gains<T, N>,
    /// Coulomb friction of each joint, [forwards ≥ 0, backwards ≤ 0], N·m, added in the desired direction of motion
    /// and not at rest; zeros leave it to the feedback.
    pub coulomb: [[T; 2]; N],
}

impl<M: Model<N, Scalar = T>, T: Real, const N: usize> Law<M, N> for ExactLaw<T, N> {
    type State = ();

    fn initial_state(&self) {}

    fn torque(&self, model: &M, _state: &mut (), sample: &Sample<T, N>) -> [T; N] {
        let tracking = Tracking::new(&self.gains.p12, sample);
        feedforward_and_feedback(model, &self.gains, &self.coulomb, sample, &tracking)
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.gains.check()?;
        check_coulomb(&self.coulomb)
    }
}

/// The right side of (16), with which the robust laws start too.
pub(super) fn feedforward_and_feedback<M: Model<N>, const N: usize>(
    model: &M,
    gains: &Gains<M::Scalar, N>,
    coulomb: &[[M::Scalar; 2]; N],
    sample: &Sample<M::Scalar, N>,
    tracking: &Tracking<M::Scalar, N>,
) -> [M::Scalar; N] {
    let passivity = model.passivity_torque(&sample.q, &sample.qd, &tracking.v_r, &tracking.a_r);
    around(model, &passivity, gains, coulomb, sample, tracking)
}

/// The same about another passivity torque than the model's own.
pub(super) fn around<M: Model<N>, const N: usize>(
    model: &M,
    passivity: &[M::Scalar; N],
    gains: &Gains<M::Scalar, N>,
    coulomb: &[[M::Scalar; 2]; N],
    sample: &Sample<M::Scalar, N>,
    tracking: &Tracking<M::Scalar, N>,
) -> [M::Scalar; N] {
    let viscous = model.viscous_friction();
    let damping = mat_vec(&gains.damping, &tracking.s);
    let position = mat_vec(&gains.pqq, &tracking.q_e);
    from_fn(|i| {
        let friction = viscous[i] * sample.qd[i] + coulomb_torque(&coulomb[i], sample.desired.qd[i]);
        passivity[i] + friction - damping[i] + position[i]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::lyapunov;
    use crate::simulate::{Plant, RigidPlant};
    use crate::test_arm::TwoLink;
    use crate::vector::{along, dot};
    use crate::{Desired, QuinticReference, Reference};

    // W = 5I, Pqq and Ω full: Pqq = [2, 0.5; 0.5, 2], P12 = [3, 1; 1, 3].
    const GAINS: Gains<f64, 2> = Gains {
        p12: [[3.0, 1.0], [1.0, 3.0]],
        damping: [[5.0 + 5.5 / 8.0, -0.5 / 8.0], [-0.5 / 8.0, 5.0 + 5.5 / 8.0]],
        pqq: [[2.0, 0.5], [0.5, 2.0]],
    };
    const LAW: ExactLaw<f64, 2> = ExactLaw { gains: GAINS, coulomb: [[0.0; 2]; 2] };

    fn sample(q: [f64; 2], qd: [f64; 2], desired: Desired<f64, 2>) -> Sample<f64, 2> {
        Sample { q, qd, desired, period: 0.001 }
    }

    #[test]
    fn lyapunov_rate_is_equation_17() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; 2] };
        let motion = QuinticReference { from: [0.0, -1.2], to: [1.5, -2.2], duration: 5.0 };
        Law::<TwoLink<f64>, 2>::check(&LAW).unwrap();
        for (t, error, rate_error) in [(1.0, [0.3, -0.2], [-0.4, 1.1]), (3.7, [-0.1, 0.5], [2.0, 0.3])] {
            let desired = motion.at(t);
            let (q, qd) = (along(&desired.q, 1.0, &error), along(&desired.qd, 1.0, &rate_error));
            let now = sample(q, qd, desired);
            let torque = LAW.torque(&arm, &mut (), &now);
            let qdd = plant.acceleration(&q, &qd, &torque).unwrap();
            // V along the tangent of the closed loop's motion: its rate there is V̇.
            let h = 1e-5;
            let shifted = |h: f64| {
                lyapunov(&arm, &GAINS, &sample(along(&q, h, &qd), along(&qd, h, &qdd), motion.at(t + h)))
            };
            let rate = (shifted(h) - shifted(-h)) / (2.0 * h);

            let Tracking { s, q_e, .. } = Tracking::new(&GAINS.p12, &now);
            let omega_q_e = mat_vec(&GAINS.pqq, &mat_vec(&GAINS.p12, &q_e));
            let form = dot(&s, &mat_vec(&GAINS.damping, &s)) - 2.0 * dot(&s, &mat_vec(&GAINS.pqq, &q_e))
                + dot(&q_e, &omega_q_e);
            assert!(form > 0.1 && (rate + form).abs() < 1e-7 * form.max(1.0), "{rate} against −{form}");
        }
    }

    #[test]
    fn coulomb_torque_follows_the_desired_direction() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let law = ExactLaw { coulomb: [[2.0, -3.0], [0.5, -0.25]], ..LAW };
        let torques = |qd: [f64; 2]| {
            let now = sample([0.1, 0.2], [-1.0, 1.0], Desired { qd, ..Desired::at_rest([0.0; 2]) });
            let (with, without) = (law.torque(&arm, &mut (), &now), LAW.torque(&arm, &mut (), &now));
            [with[0] - without[0], with[1] - without[1]].map(|x| (x * 1e9).round() / 1e9)
        };
        assert_eq!(torques([1.0, -1.0]), [2.0, -0.25]);
        assert_eq!(torques([-1.0, 0.0]), [-3.0, 0.0]);
    }
}
