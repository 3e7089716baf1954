//! A control step that a generator has written out: law and model as one straight line, with its constants folded.

mod controller;
#[cfg(feature = "std")]
mod fused;

pub use controller::StepController;
#[cfg(feature = "std")]
pub use fused::{MulAdd, mul_add};

use crate::reference::{Desired, ReferenceLimits};
use crate::{Real, Settings};

/// One control step of one arm, written out: the torque of a tracking law about a model, with every constant folded.
///
/// A generated module implements it on its model's type. [`StepController`] makes it a fixed-step loop. For gains that
/// change at run time there are the laws of [`crate::law`] under a [`Controller`](crate::Controller).
///
/// `N` is the number of joints, `P` that of the parameters that the law learns, 0 for a law that does not.
pub trait ControlStep<const N: usize, const P: usize = 0> {
    /// Number type.
    type Scalar: Real;

    /// Period, torque limits and fault policy. Every number in it is as [`Settings::check`] demands.
    const SETTINGS: Settings<Self::Scalar, N>;

    /// The box of the parameters, and where they start.
    const LEARNING: Learning<Self::Scalar, P>;

    /// What the desired motion must keep, where the step is to report a fault beyond it; `None` to take any motion.
    const REFERENCE: Option<ReferenceLimits<Self::Scalar, N>> = None;

    /// The torque for the measured position `q`, rad or m, velocity `qd`, rad/s or m/s, the desired motion, and the
    /// parameters `theta` that were learnt so far.
    fn step(
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        desired: &Desired<Self::Scalar, N>,
        theta: &[Self::Scalar; P],
    ) -> StepTorque<Self::Scalar, N, P>;

    /// The torque of gravity at `q`, N·m or N, for [`OnFault::Gravity`](crate::OnFault::Gravity).
    fn gravity_torque(q: &[Self::Scalar; N]) -> [Self::Scalar; N];
}

/// What a law that learns knows of its `P` parameters, in their units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learning<T, const P: usize> {
    /// Lowest θ.
    pub low: [T; P],
    /// Highest θ.
    pub high: [T; P],
    /// θ̂ at the start, inside the box.
    pub initial: [T; P],
}

impl<T> Learning<T, 0> {
    /// Of a law that does not learn.
    pub const NONE: Self = Self { low: [], high: [], initial: [] };
}

/// The outcome of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepTorque<T, const N: usize, const P: usize = 0> {
    /// What the law asks, N·m or N.
    pub asked: [T; N],
    /// The same within the torque limits.
    pub limited: [T; N],
    /// The sum of the inputs that no torque depends on; 0 if there are none. An infinite or NaN input makes this sum or a
    /// torque that is asked infinite or NaN, so one look at these is enough.
    pub unread: T,
    /// What this period takes off the parameters, in their units: T Pθθ⁻¹ Yᵀ s for a period T.
    pub correction: [T; P],
}

/// `x`, no less than `low` and no more than `high`; NaN stays NaN.
#[inline]
pub fn clamp<T: Real>(x: T, low: T, high: T) -> T {
    // One after the other: each is one instruction where the processor has a minimum that keeps its second operand.
    let x = if x > high { high } else { x };
    if x < low { low } else { x }
}

/// `above` where x > 0, `below` where x < 0, `otherwise` where x is 0 or NaN.
#[inline]
pub fn select<T: Real>(x: T, above: T, below: T, otherwise: T) -> T {
    if x > T::ZERO {
        above
    } else if x < T::ZERO {
        below
    } else {
        otherwise
    }
}

#[cfg(test)]
mod tests;
