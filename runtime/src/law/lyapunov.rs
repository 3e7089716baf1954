//! The function whose decrease proves convergence.

use super::{Gains, Sample, Tracking};
use crate::vector::{dot, mat_vec};
use crate::{Model, Real};

/// V = ½ sᵀ D(q) s + ½ q_eᵀ Pqq q_e, equation (12), J, with the mass matrix of `model`: N + 1 model calls.
pub fn lyapunov<M: Model<N>, const N: usize>(
    model: &M,
    gains: &Gains<M::Scalar, N>,
    sample: &Sample<M::Scalar, N>,
) -> M::Scalar {
    let Tracking { s, q_e, .. } = Tracking::new(&gains.p12, sample);
    let kinetic = dot(&s, &mat_vec(&model.mass_matrix(&sample.q), &s));
    let elastic = dot(&q_e, &mat_vec(&gains.pqq, &q_e));
    M::Scalar::from_f64(0.5) * (kinetic + elastic)
}
