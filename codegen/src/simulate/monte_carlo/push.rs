//! The torque at the joints that brings the whole error of the model to its bound.

use gramforge_runtime::{Desired, Model};

use super::fast_arm::FastArm;
use crate::bounds::{Bounds, Rates};
use crate::graph::{Graph, Tape};
use crate::spec::ScalarSpec;

/// What the emitted model is wrong by at most, and against which arm.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelErrorBound {
    /// By joint at any instant, N·m or N.
    pub torque: Vec<f64>,
    /// From each time on, s, where that is less: for which errors of the loop were followed. Empty where none were.
    pub followed: Vec<(f64, Vec<f64>)>,
    /// At the state of the instant, where that is less; `None` to leave it at the one for any instant.
    pub at_state: Option<BoundAtState>,
    /// The arm that this is the distance from.
    pub against: Against,
}

/// A bound that follows from those on the entries of D, h and G, and from the rates of the instant: an arm at rest has no
/// error of D or h to bear.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundAtState {
    /// What the model leaves out, entry by entry.
    pub entries: Bounds,
    /// What it rounds by, by joint, N·m or N.
    pub rounding: Vec<f64>,
}

/// The arm that the error of a model is counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The model is that of the arm: the whole bound is a disturbance.
    Exact,
    /// The arm as specified; what uncertain numbers do counts apart.
    Specified,
    /// Every arm of the family: in each run its own.
    Family,
}

/// The emitted passivity torque in the number type of the module.
pub(super) enum Emitted {
    Double(Tape<f64>),
    Single(Tape<f32>),
}

impl Emitted {
    pub(super) fn new(code: &Graph, scalar: ScalarSpec) -> Self {
        match scalar {
            ScalarSpec::F64 => Self::Double(Tape::new(code)),
            ScalarSpec::F32 => Self::Single(Tape::new(code)),
        }
    }
}

/// Pushes of one run.
pub(super) struct Push<'a, const N: usize> {
    /// For any instant.
    pub bound: [f64; N],
    /// From each step on, where that is less.
    pub followed: &'a [(usize, [f64; N])],
    /// For the state of the instant.
    pub at_state: Option<&'a BoundAtState>,
    /// The arm that the model's error is counted from; `None` where the model has none.
    pub exact: Option<&'a FastArm<N>>,
    /// The emitted passivity torque.
    pub code: &'a Emitted,
    pub p12: &'a [[f64; N]; N],
}

impl<const N: usize> Push<'_, N> {
    /// The torque to add for period `step`, N·m or N, so that with what the model is wrong by at this instant it makes the
    /// bound, on the side that `sides` says; and whether the model is wrong by more than the bound in some joint, to
    /// which nothing is added.
    pub(super) fn torque(
        &self,
        step: usize,
        q: &[f64; N],
        qd: &[f64; N],
        desired: &Desired<f64, N>,
        sides: &[i8; N],
    ) -> ([f64; N], bool) {
        let q_e: [f64; N] = std::array::from_fn(|i| q[i] - desired.q[i]);
        let qd_e: [f64; N] = std::array::from_fn(|i| qd[i] - desired.qd[i]);
        let pulled = |x: &[f64; N], i: usize| self.p12[i].iter().zip(x).map(|(p, x)| p * x).sum::<f64>();
        let v_r: [f64; N] = std::array::from_fn(|i| desired.qd[i] - pulled(&q_e, i));
        let a_r: [f64; N] = std::array::from_fn(|i| desired.qdd[i] - pulled(&qd_e, i));
        let error = self.model_error(q, qd, &v_r, &a_r);
        let bound = self.bound_at(step, qd, &v_r, &a_r);
        let beyond = |i: usize| error[i].abs() > bound[i];
        let torque = |i: usize| match beyond(i) {
            true => 0.0,
            false => f64::from(sides[i]) * bound[i] - error[i],
        };
        (std::array::from_fn(torque), (0..N).any(beyond))
    }

    /// What the model is wrong by at most in period `step` at these rates.
    fn bound_at(&self, step: usize, qd: &[f64; N], v_r: &[f64; N], a_r: &[f64; N]) -> [f64; N] {
        let followed = self.followed.iter().take_while(|(from, _)| *from <= step).last();
        let mut bound =
            followed.map_or(self.bound, |(_, most)| std::array::from_fn(|i| self.bound[i].min(most[i])));
        let Some(BoundAtState { entries, rounding }) = self.at_state else { return bound };
        let sizes = |x: &[f64; N]| x.iter().map(|x| x.abs()).collect();
        let rates =
            Rates { speed: sizes(qd), reference_speed: sizes(v_r), reference_acceleration: sizes(a_r) };
        for ((bound, own), rounding) in bound.iter_mut().zip(entries.torque(&rates)).zip(rounding) {
            *bound = bound.min(own + rounding);
        }
        bound
    }

    /// The emitted model's torque less that of the arm, at a reference velocity and acceleration.
    fn model_error(&self, q: &[f64; N], qd: &[f64; N], v_r: &[f64; N], a_r: &[f64; N]) -> [f64; N] {
        let Some(exact) = self.exact else { return [0.0; N] };
        let emitted: Vec<f64> = match self.code {
            Emitted::Double(code) => code.interpret(q, qd, v_r, a_r),
            Emitted::Single(code) => {
                let [q, qd, v_r, a_r] = [q, qd, v_r, a_r].map(|x| x.map(|x| x as f32));
                code.interpret(&q, &qd, &v_r, &a_r).into_iter().map(f64::from).collect()
            }
        };
        let torque = exact.passivity_torque(q, qd, v_r, a_r);
        std::array::from_fn(|i| emitted.get(i).map_or(f64::NAN, |emitted| emitted - torque[i]))
    }
}
