//! What errors and speeds can reach while V does not grow, equations (41)–(43).

use super::checked;
use super::gains::Gains;
use super::linalg::inverse;
use crate::arm::Arm;
use crate::check::vector;
use crate::dynamics::mass_matrix;
use crate::error::Error;
use crate::spec::InitialErrorSpec;

/// Positions at which D is looked at; it is looked at, not bounded, so the envelope is an estimate.
const POSITIONS: usize = 512;

/// Largest errors and speeds by joint, as estimated from D at sampled positions of the domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// V_max(0) of equation (41), J.
    pub v_max: f64,
    /// Largest |q_e|, rad or m.
    pub position_error: Vec<f64>,
    /// Largest |q̇_e|, rad/s or m/s.
    pub velocity_error: Vec<f64>,
    /// Largest |q̇| = largest |q̇_d| + largest |q̇_e|, for equation (30).
    pub speed: Vec<f64>,
}

/// The envelope for the largest initial error, as long as V̇ ≤ 0, around a motion with the given largest |q̇_d|.
///
/// V ≥ ½ sᵀ D s gives |s_i| ≤ √(2V (D⁻¹)_ii), V ≥ ½ q_eᵀ Pqq q_e gives |q_e,i| ≤ √(2V (Pqq⁻¹)_ii), and
/// q̇_e = −P12 q_e + s is a stable filter, which for diagonal P12 gives |q_e,i| ≤ max(|q_e,i(0)|, |s_i|/P12_ii).
///
/// # Errors
/// [`Error::Internal`] where D or Pqq turns out singular after their checks.
pub fn envelope(
    arm: &Arm,
    desired_speed: &[f64],
    positions: &[Vec<f64>],
    gains: &Gains,
    initial: &InitialErrorSpec,
) -> Result<Envelope, Error> {
    let n = arm.dof();
    let singular = |what: &str| Error::Internal(format!("{what} is singular after its check"));
    let q_0 = checked("control.initial_error.position", vector(&initial.position, n))?;
    let qd_0 = checked("control.initial_error.velocity", vector(&initial.velocity, n))?;
    let s_0: Vec<f64> = (0..n)
        .map(|i| qd_0[i] + gains.p12[i].iter().zip(&q_0).map(|(p, q)| p.abs() * q).sum::<f64>())
        .collect();
    let mut kinetic = 0.0_f64;
    let mut mobility = vec![0.0_f64; n];
    let stride = positions.len().div_ceil(POSITIONS).max(1);
    for q in positions.iter().step_by(stride) {
        let d = mass_matrix(arm, q);
        kinetic = kinetic.max(largest_over_box(&d, &s_0));
        let inverse = inverse(&d).ok_or_else(|| singular("D"))?;
        for (largest, (i, row)) in mobility.iter_mut().zip(inverse.iter().enumerate()) {
            *largest = largest.max(row[i]);
        }
    }
    let v_max = kinetic + largest_over_box(&gains.pqq, &q_0);
    let compliance = inverse(&gains.pqq).ok_or_else(|| singular("Pqq"))?;
    let diagonal = |m: &[Vec<f64>]| (0..n).all(|i| (0..n).all(|j| i == j || m[i][j] == 0.0));
    let s: Vec<f64> = mobility.iter().map(|m| libm::sqrt(2.0 * v_max * m)).collect();
    let position_error: Vec<f64> = (0..n)
        .map(|i| {
            let level = libm::sqrt(2.0 * v_max * compliance[i][i]);
            let filter = q_0[i].max(s[i] / gains.p12[i][i]);
            if diagonal(&gains.p12) { level.min(filter) } else { level }
        })
        .collect();
    let velocity_error: Vec<f64> = (0..n)
        .map(|i| s[i] + gains.p12[i].iter().zip(&position_error).map(|(p, q)| p.abs() * q).sum::<f64>())
        .collect();
    let speed = desired_speed.iter().zip(&velocity_error).map(|(d, e)| d + e).collect();
    Ok(Envelope { v_max, position_error, velocity_error, speed })
}

/// max ½ xᵀ M x over |x_i| ≤ b_i: the form is convex, so a corner attains it.
fn largest_over_box(m: &[Vec<f64>], b: &[f64]) -> f64 {
    let n = b.len();
    let corner = |signs: usize| -> f64 {
        let x: Vec<f64> = (0..n).map(|i| if signs >> i & 1 == 1 { -b[i] } else { b[i] }).collect();
        let row = |i: usize| -> f64 { (0..n).map(|j| m[i][j] * x[j]).sum() };
        0.5 * (0..n).map(|i| x[i] * row(i)).sum::<f64>()
    };
    (0..1_usize << n).map(corner).fold(0.0, f64::max)
}
