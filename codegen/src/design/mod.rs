//! The numbers of the tracking law: gains, ΔC, ΔC1, switching, limits.

mod envelope;
mod gains;
mod linalg;

pub use envelope::{Envelope, envelope};
pub use gains::Gains;
use linalg::symmetric_eigenvalues;

use crate::arm::Arm;
use crate::bounds::Bounds;
use crate::check::vector;
use crate::error::Error;
use crate::spec::{ControlSpec, LawSpec, OnFaultSpec};

/// Everything a controller needs beside its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Which law.
    pub law: LawSpec,
    /// P12, K and Pqq.
    pub gains: Gains,
    /// What the errors and speeds stay below, given the initial error.
    pub envelope: Envelope,
    /// ΔC of equation (30), n×n, N·m·s/rad.
    pub delta_c: Vec<Vec<f64>>,
    /// The k of ΔC1 = k·I: k* = λ_max(sym ΔC), N·m·s/rad.
    pub k_star: f64,
    /// Bound on the Coulomb friction that the command does not cancel, by joint, N·m or N.
    pub disturbance: Vec<f64>,
    /// φ of the boundary layer by joint; `None` for the sign function.
    pub boundary_layer: Option<Vec<f64>>,
    /// Control period, s.
    pub period: f64,
    /// Largest torque by joint, N·m or N.
    pub torque_limit: Vec<Option<f64>>,
    /// Coulomb friction to compensate, forwards and backwards, by joint; zero where not asked for.
    pub coulomb: Vec<[f64; 2]>,
    /// What to command when a measurement is not finite.
    pub on_fault: OnFaultSpec,
}

/// Designs the law from the specification's gains, the bounds of the model and what the errors can reach.
///
/// # Errors
/// [`Error::Internal`] where a matrix that was checked before turns out singular.
pub fn design(
    control: &ControlSpec,
    arm: &Arm,
    bounds: &Bounds,
    envelope: Envelope,
) -> Result<Design, Error> {
    let n = arm.dof();
    let gains = Gains::new(control, n)?;
    let delta_c = bounds.coriolis(&envelope.speed);
    let k_star = symmetric_eigenvalues(&symmetric_part(&delta_c)).last().copied().unwrap_or(0.0).max(0.0);
    let coulomb = |joint: &crate::arm::Joint| {
        if control.compensate_coulomb { joint.coulomb_friction } else { [0.0; 2] }
    };
    let disturbance = |joint: &crate::arm::Joint| {
        let [forwards, backwards] = joint.coulomb_friction;
        // Compensated for the wrong direction, it counts in full from one side to the other.
        if control.compensate_coulomb { forwards - backwards } else { forwards.max(-backwards) }
    };
    let layer = |phi| checked("control.boundary_layer", vector(phi, n));
    let boundary_layer = control.boundary_layer.as_ref().map(layer).transpose()?;
    Ok(Design {
        law: control.law,
        gains,
        envelope,
        delta_c,
        k_star,
        disturbance: arm.joints.iter().map(disturbance).collect(),
        boundary_layer,
        period: control.period,
        torque_limit: arm.joints.iter().map(|joint| joint.limits.torque).collect(),
        coulomb: arm.joints.iter().map(coulomb).collect(),
        on_fault: control.on_fault,
    })
}

impl Design {
    /// True where everything that is computed is a finite number.
    pub fn is_finite(&self) -> bool {
        let Envelope { v_max, position_error, velocity_error, speed } = &self.envelope;
        let lists = [position_error, velocity_error, speed].into_iter().chain(&self.delta_c);
        self.gains.is_finite() && lists.flatten().chain([v_max, &self.k_star]).all(|v| v.is_finite())
    }

    /// ΔC1 = k*·I, n×n by rows.
    pub fn delta_c1(&self) -> Vec<Vec<f64>> {
        let n = self.delta_c.len();
        (0..n).map(|i| (0..n).map(|j| if i == j { self.k_star } else { 0.0 }).collect()).collect()
    }
}

/// What the specification's check has left in order.
///
/// # Errors
/// [`Error::Internal`] where it has not.
pub(crate) fn checked<T>(field: &str, value: Option<T>) -> Result<T, Error> {
    value.ok_or_else(|| Error::Internal(format!("{field} has the wrong size after its check")))
}

fn symmetric_part(m: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = m.len();
    (0..n).map(|i| (0..n).map(|j| 0.5 * (m[i][j] + m[j][i])).collect()).collect()
}
