//! The report's robust law, equation (34).

use core::array::from_fn;

use super::exact::feedforward_and_feedback;
use super::{Gains, Law, Sample, Switching, Tracking, check_coulomb, check_nonnegative, check_symmetric};
use crate::vector::{abs, add, mat_vec};
use crate::{ConfigError, Model, Real};

/// Equation (16) with a simplified model, less ΔC1 s and a switching term that outweighs what the model leaves out:
///
/// − diag(sgn s) \[ΔD(|q̈_d| + P12|q̇_e|) + (ΔB + ΔC)|q̇| + ΔG\].
///
/// ΔD, ΔB and ΔG are the model's own [`bounds`](Model::bounds).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportLaw<T, const N: usize> {
    /// P12, K and Pqq.
    pub gains: Gains<T, N>,
    /// ΔC of equation (30), by rows, N·m·s/rad: see [`Bounds::coriolis`](crate::Bounds::coriolis).
    pub delta_c: [[T; N]; N],
    /// ΔC1, by rows, N·m·s/rad: symmetric, and ΔC1 + sym(δC) positive definite for every |δC| ≤ ΔC, which k·I is for
    /// every k > λ_max(sym ΔC).
    pub delta_c1: [[T; N]; N],
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
        let coriolis = mat_vec(&self.delta_c, &speed);
        from_fn(|i| inertia[i] + bounds.b[i] * speed[i] + coriolis[i] + bounds.g[i])
    }
}

impl<M: Model<N, Scalar = T>, T: Real, const N: usize> Law<M, N> for ReportLaw<T, N> {
    type State = ();

    fn initial_state(&self) {}

    fn torque(&self, model: &M, _state: &mut (), sample: &Sample<T, N>) -> [T; N] {
        let tracking = Tracking::new(&self.gains.p12, sample);
        let nominal = feedforward_and_feedback(model, &self.gains, &self.coulomb, sample, &tracking);
        let damping = mat_vec(&self.delta_c1, &tracking.s);
        let size = self.bracket(model, sample, &tracking);
        let side = self.switching.at(&tracking.s);
        from_fn(|i| nominal[i] - damping[i] - side[i] * size[i])
    }

    fn check(&self) -> Result<(), ConfigError> {
        self.gains.check()?;
        check_nonnegative("delta_c", &self.delta_c)?;
        check_symmetric("delta_c1", &self.delta_c1)?;
        self.switching.check()?;
        check_coulomb(&self.coulomb)
    }
}
