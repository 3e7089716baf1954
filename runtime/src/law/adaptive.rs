//! The adaptive law, equations (46) and (49).

use super::{Law, ReportLaw, Sample, Switching, Tracking};
use crate::regression::AdaptiveModel;
use crate::{ConfigError, Estimate, Real, Requirement};

/// Equation (34) with parameters θ̂ that are learnt: θ̂̇ = −Pθθ⁻¹ Yᵀ s, held in a box that is known to contain θ.
///
/// V1 = V + ½ θ_eᵀ Pθθ θ_e with θ_e = θ̂ − θ falls as V does under (34). What keeps a real loop from drifting:
///
/// - θ̂ is projected onto its box, which only lowers V1;
/// - joints with |s_i| inside the boundary layer teach nothing: what s does there is ripple and noise;
/// - one Euler step a control period, in a sum that loses no small step ([`Estimate`]); one that is not finite is not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveLaw<T, const N: usize, const P: usize> {
    /// The remaining terms of (34); its bounds are those with θ at its true value.
    pub robust: ReportLaw<T, N>,
    /// Diagonal of Pθθ⁻¹, positive.
    pub rate: [T; P],
    /// Lowest θ.
    pub low: [T; P],
    /// Highest θ.
    pub high: [T; P],
    /// θ̂ at the start, inside the box.
    pub initial: [T; P],
}

impl<T: Real, const N: usize, const P: usize> AdaptiveLaw<T, N, P> {
    /// The part of s that teaches: s_i where it is outside the boundary layer, else 0; all of it without a layer.
    fn lesson(&self, s: &[T; N]) -> [T; N] {
        match &self.robust.switching {
            Switching::Sign => *s,
            Switching::BoundaryLayer(phi) => {
                core::array::from_fn(|i| if s[i].abs() > phi[i] { s[i] } else { T::ZERO })
            }
        }
    }
}

impl<M, T: Real, const N: usize, const P: usize> Law<M, N> for AdaptiveLaw<T, N, P>
where
    M: AdaptiveModel<N, P, Scalar = T>,
{
    type State = Estimate<T, P>;

    fn initial_state(&self) -> Estimate<T, P> {
        Estimate::new(self.initial)
    }

    fn torque(&self, model: &M, estimate: &mut Estimate<T, P>, sample: &Sample<T, N>) -> [T; N] {
        estimate.project(&self.low, &self.high, &self.initial);
        let tracking = Tracking::new(&self.robust.gains.p12, sample);
        let regression = model.regression(&sample.q, &sample.qd, &tracking.v_r, &tracking.a_r);
        let torque = self.robust.around(model, &regression.torque(estimate.theta()), sample, &tracking);
        let gradient = regression.gradient(&self.lesson(&tracking.s));
        let correction = core::array::from_fn(|k| sample.period * self.rate[k] * gradient[k]);
        estimate.correct(&correction, &self.low, &self.high);
        torque
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.robust.check_numbers()?;
        let error = |parameter, requirement| Err(ConfigError { parameter, joint: None, requirement });
        if !self.rate.iter().all(|&x| x > T::ZERO && x.is_finite()) {
            return error("rate", Requirement::Positive);
        }
        for (parameter, values) in [("low", &self.low), ("high", &self.high), ("initial", &self.initial)] {
            if !values.iter().all(|x| x.is_finite()) {
                return error(parameter, Requirement::Finite);
            }
        }
        let inside = |k: usize| self.low[k] <= self.initial[k] && self.initial[k] <= self.high[k];
        if (0..P).all(inside) { Ok(()) } else { error("initial", Requirement::InsideBox) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::CoriolisTerm;
    use crate::law::test_states::GAINS;
    use crate::simulate::{JointState, RigidPlant, Simulation};
    use crate::test_arm::TwoLink;
    use crate::{Controller, Model, OnFault, QuinticReference, Regression, Settings};

    /// The two-link arm with its gravity torque scaled by 1 + θ.
    #[derive(Clone, Copy)]
    struct Scaled(TwoLink<f64>);

    impl Model<2> for Scaled {
        type Scalar = f64;
        fn passivity_torque(&self, q: &[f64; 2], qd: &[f64; 2], v_r: &[f64; 2], a_r: &[f64; 2]) -> [f64; 2] {
            self.0.passivity_torque(q, qd, v_r, a_r)
        }
        fn viscous_friction(&self) -> [f64; 2] {
            self.0.viscous_friction()
        }
        fn bounds(&self) -> &crate::Bounds<f64, 2> {
            &crate::Bounds::ZERO
        }
    }

    impl AdaptiveModel<2, 1> for Scaled {
        fn regression(
            &self,
            q: &[f64; 2],
            qd: &[f64; 2],
            v_r: &[f64; 2],
            a_r: &[f64; 2],
        ) -> Regression<f64, 2, 1> {
            Regression { base: self.passivity_torque(q, qd, v_r, a_r), columns: [self.gravity(q)] }
        }
    }

    fn law(switching: Switching<f64, 2>) -> AdaptiveLaw<f64, 2, 1> {
        let robust = ReportLaw {
            gains: GAINS,
            delta_c: [[0.0; 2]; 2],
            coriolis_term: CoriolisTerm::Matrix([[0.0; 2]; 2]),
            disturbance: [0.0; 2],
            switching,
            coulomb: [[0.0; 2]; 2],
        };
        AdaptiveLaw { robust, rate: [0.05], low: [-0.3], high: [0.3], initial: [0.0] }
    }

    /// θ̂ and the position error after `seconds` on an arm whose gravity is 1.2 times the model's.
    fn end(law: AdaptiveLaw<f64, 2, 1>, seconds: f64) -> (f64, f64) {
        let arm = TwoLink::<f64>::EXAMPLE;
        let heavy = TwoLink { weight: arm.weight.map(|g| 1.2 * g), ..arm };
        let plant = RigidPlant { model: heavy, coulomb: [[0.0; 2]; 2] };
        let settings = Settings { period: 1e-3, torque_limit: [None; 2], on_fault: OnFault::Hold };
        let mut controller = Controller::new(Scaled(arm), law, settings).unwrap();
        let motion = QuinticReference { from: [0.0, -1.2], to: [1.0, -0.5], duration: 2.0 };
        let start = JointState { q: [0.1, -1.1], qd: [0.0; 2] };
        let mut simulation = Simulation::new(plant, start, 1e-3, 1).unwrap();
        let mut error = 0.0;
        while simulation.time() < seconds {
            let record = simulation.step(&mut controller, &motion).unwrap();
            let theta = controller.law_state().theta()[0];
            assert!((-0.3..=0.3).contains(&theta));
            error = (record.state.q[0] - record.desired.q[0]).abs();
        }
        (controller.law_state().theta()[0], error)
    }

    #[test]
    fn learns_the_load_and_stops_at_its_box() {
        let (theta, error) = end(law(Switching::Sign), 20.0);
        assert!((theta - 0.2).abs() < 1e-3 && error < 1e-5, "{theta} {error}");
        let narrow = AdaptiveLaw { high: [0.1], ..law(Switching::Sign) };
        let (theta, error) = end(narrow, 20.0);
        assert!(theta == 0.1 && error > 1e-4, "{theta} {error}");
    }

    #[test]
    fn a_quiet_joint_teaches_nothing() {
        let wide = law(Switching::BoundaryLayer([100.0; 2]));
        assert_eq!(end(wide, 1.0).0, 0.0);
    }

    #[test]
    fn refuses_a_start_outside_the_box_and_goes_back_to_it_on_reset() {
        let outside = AdaptiveLaw { initial: [0.4], ..law(Switching::Sign) };
        let error = Law::<Scaled, 2>::check(&outside).unwrap_err();
        assert_eq!((error.parameter, error.requirement), ("initial", Requirement::InsideBox));

        let settings = Settings { period: 1e-3, torque_limit: [None; 2], on_fault: OnFault::Hold };
        let model = Scaled(TwoLink::EXAMPLE);
        let mut controller = Controller::new(model, law(Switching::Sign), settings).unwrap();
        controller.step(&[0.5; 2], &[0.0; 2], &crate::Desired::at_rest([0.0; 2])).unwrap();
        let learnt = *controller.law_state();
        assert!(learnt.theta() != &[0.0]);
        controller.reset();
        assert_eq!(controller.law_state(), &Estimate::new([0.0]));
        controller.restore(learnt);
        assert_eq!(controller.law_state(), &learnt);
        for (stored, used) in [(9.0, 0.3), (f64::NAN, 0.0)] {
            controller.restore(Estimate::new([stored]));
            controller.step(&[0.0; 2], &[0.0; 2], &crate::Desired::at_rest([0.0; 2])).unwrap();
            assert_eq!(controller.law_state().theta(), &[used]);
        }
    }
}
