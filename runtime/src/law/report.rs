//! The report's robust law, equation (34).

use core::array::from_fn;

use super::exact::around;
use super::{
    CoriolisTerm, Gains, Law, Sample, Switching, Tracking, check_coulomb, check_nonnegative, check_symmetric,
};
use crate::vector::{abs, add, mat_vec};
use crate::{ConfigError, Model, Real};

/// Equation (16) with a simplified model, less ΔC1 s and a switching term that outweighs what the model leaves out:
/// with [`CoriolisTerm::Switching`] ΔC|s| stands in its bracket and ΔC1 s falls away.
///
/// − diag(sgn s) \[ΔD(|q̈_d| + P12|q̇_e|) + (ΔB + ΔC)|q̇| + ΔG + disturbance\].
///
/// ΔD, ΔB and ΔG are the model's own [`bounds`](Model::bounds).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportLaw<T, const N: usize> {
    /// P12, K and Pqq.
    pub gains: Gains<T, N>,
    /// ΔC of equation (30), by rows, N·m·s/rad: see [`Bounds::coriolis`](crate::Bounds::coriolis).
    pub delta_c: [[T; N]; N],
    /// What outweighs −sᵀ δC s: −ΔC1 s, or more switching.
    pub coriolis_term: CoriolisTerm<T, N>,
    /// Bound on torques that no model has, such as Coulomb friction: added to ΔG, N·m, not negative.
    pub disturbance: [T; N],
    /// sgn, or the boundary layer.
    pub switching: Switching<T, N>,
    /// Coulomb friction of each joint, [forwards ≥ 0, backwards ≤ 0], N·m, added in the desired direction of motion
    /// and not at rest; zeros leave it to the feedback.
    pub coulomb: [[T; 2]; N],
}

impl<T: Real, const N: usize> ReportLaw<T, N> {
    /// The size of the switching term, the bracket of (34), N·m.
    pub fn robust_gain<M: Model<N, Scalar = T>>(&self, model: &M, sample: &Sample<T, N>) -> [T; N] {
        self.bracket(model, sample, &Tracking::new(&self.gains.p12, sample))
    }

    fn bracket<M: Model<N, Scalar = T>>(
        &self,
        model: &M,
        sample: &Sample<T, N>,
        tracking: &Tracking<T, N>,
    ) -> [T; N] {
        let bounds = model.bounds();
        let acceleration = add(&abs(&sample.desired.qdd), &mat_vec(&self.gains.p12, &abs(&tracking.qd_e)));
        let inertia = mat_vec(&bounds.d, &acceleration);
        let speed = abs(&sample.qd);
        let coriolis = match self.coriolis_term {
            CoriolisTerm::Matrix(_) => mat_vec(&self.delta_c, &speed),
            CoriolisTerm::Switching => mat_vec(&self.delta_c, &add(&speed, &abs(&tracking.s))),
        };
        from_fn(|i| inertia[i] + bounds.b[i] * speed[i] + coriolis[i] + bounds.g[i] + self.disturbance[i])
    }

    /// (34) about a passivity torque, N·m.
    pub(super) fn around<M: Model<N, Scalar = T>>(
        &self,
        model: &M,
        passivity: &[T; N],
        sample: &Sample<T, N>,
        tracking: &Tracking<T, N>,
    ) -> [T; N] {
        let nominal = around(model, passivity, &self.gains, &self.coulomb, sample, tracking);
        let damping = match &self.coriolis_term {
            CoriolisTerm::Matrix(delta_c1) => mat_vec(delta_c1, &tracking.s),
            CoriolisTerm::Switching => [T::ZERO; N],
        };
        let size = self.bracket(model, sample, tracking);
        let side = self.switching.at(&tracking.s);
        from_fn(|i| nominal[i] - damping[i] - side[i] * size[i])
    }

    pub(super) fn check_numbers(&self) -> Result<(), ConfigError> {
        self.gains.check()?;
        check_nonnegative("delta_c", &self.delta_c)?;
        if let CoriolisTerm::Matrix(delta_c1) = &self.coriolis_term {
            check_symmetric("delta_c1", delta_c1)?;
        }
        check_nonnegative("disturbance", &self.disturbance.map(|x| [x; N]))?;
        self.switching.check()?;
        check_coulomb(&self.coulomb)
    }
}

impl<M: Model<N, Scalar = T>, T: Real, const N: usize> Law<M, N> for ReportLaw<T, N> {
    type State = ();

    fn initial_state(&self) {}

    fn torque(&self, model: &M, _state: &mut (), sample: &Sample<T, N>) -> [T; N] {
        let tracking = Tracking::new(&self.gains.p12, sample);
        let passivity = model.passivity_torque(&sample.q, &sample.qd, &tracking.v_r, &tracking.a_r);
        self.around(model, &passivity, sample, &tracking)
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.check_numbers()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::test_states::{GAINS, excess, states};
    use crate::test_arm::TwoLink;
    use crate::{Desired, ExactLaw};

    /// The law for the perturbed arm, at joint speeds up to `speed`.
    fn law(speed: f64, switching: Switching<f64, 2>) -> ReportLaw<f64, 2> {
        let delta_c = TwoLink::<f64>::perturbed().bounds.coriolis(&[speed; 2]);
        // The trace and the two off-diagonals together are at least λ_max(sym ΔC).
        let k = delta_c.iter().flatten().sum::<f64>();
        ReportLaw {
            gains: GAINS,
            delta_c,
            coriolis_term: CoriolisTerm::Matrix([[k, 0.0], [0.0, k]]),
            disturbance: [0.0; 2],
            switching,
            coulomb: [[0.0; 2]; 2],
        }
    }

    #[test]
    fn outweighs_every_error_inside_the_bounds() {
        for term in [None, Some(CoriolisTerm::Switching)] {
            let robust = law(3.0, Switching::Sign);
            let robust = ReportLaw { coriolis_term: term.unwrap_or(robust.coriolis_term), ..robust };
            Law::<TwoLink<f64>, 2>::check(&robust).unwrap();
            let worst = states().map(|sample| excess(&robust, &sample)).fold(f64::MIN, f64::max);
            assert!(worst < 1e-4, "V̇ exceeds −zᵀMz by {worst}");
        }
        // Without the robust terms the same model does exceed it.
        let plain = ExactLaw { gains: GAINS, coulomb: [[0.0; 2]; 2] };
        assert!(states().map(|sample| excess(&plain, &sample)).fold(f64::MIN, f64::max) > 1.0);
    }

    #[test]
    fn boundary_layer_costs_a_quarter_of_gain_times_width() {
        let width = 0.5;
        let layer = law(3.0, Switching::BoundaryLayer([width; 2]));
        for sample in states() {
            let gain = layer.robust_gain(&TwoLink::perturbed(), &sample);
            assert!(excess(&layer, &sample) < (gain[0] + gain[1]) * width / 4.0 + 1e-4);
        }
    }

    #[test]
    fn adds_the_terms_of_equation_34() {
        let model = TwoLink::<f64>::perturbed();
        let sample = Sample {
            q: [0.5, -1.0],
            qd: [1.0, -2.0],
            desired: Desired { q: [0.0, 0.0], qd: [0.5, 0.0], qdd: [-1.0, 2.0] },
            period: 1e-3,
        };
        let robust = ReportLaw {
            gains: Gains { p12: [[2.0, 0.0], [0.0, 2.0]], ..GAINS },
            delta_c: [[0.1, 0.2], [0.3, 0.4]],
            coriolis_term: CoriolisTerm::Matrix([[0.5, 0.25], [0.25, 1.0]]),
            disturbance: [0.0; 2],
            switching: Switching::Sign,
            coulomb: [[0.0; 2]; 2],
        };
        // |q̈_d| + P12|q̇_e| = (2, 6), |q̇| = (1, 2), s = (1.5, −4); ΔD = [0.25, 0.08; 0.08, 0.03].
        let bracket = [
            0.25 * 2.0 + 0.08 * 6.0 + 0.05 * 1.0 + 0.1 * 1.0 + 0.2 * 2.0 + 1.5,
            0.08 * 2.0 + 0.03 * 6.0 + 0.02 * 2.0 + 0.3 * 1.0 + 0.4 * 2.0 + 0.5,
        ];
        let added = [0.5 * 1.5 - 0.25 * 4.0 + bracket[0], 0.25 * 1.5 - 4.0 - bracket[1]];
        let plain =
            ExactLaw { gains: robust.gains, coulomb: robust.coulomb }.torque(&model, &mut (), &sample);
        let torque = robust.torque(&model, &mut (), &sample);
        for i in 0..2 {
            assert!((plain[i] - torque[i] - added[i]).abs() < 1e-12, "{plain:?} {torque:?} {added:?}");
        }
    }
}
