//! What a control step rounds by in its number type, over the states that its law may meet.

use super::super::{Adaptation, Envelope};
use super::StepGraph;
use crate::bounds::{Instant, Rates, largest};
use crate::domain::Domain;
use crate::graph::{Graph, Inputs, Variable};
use crate::motion::{ReferenceError, Ticks};
use crate::numerics::interval::Interval;
use crate::numerics::rounded::Format;

/// The states for which a step's rounding is bounded.
#[derive(Clone, Debug, PartialEq)]
pub struct StepStates {
    /// Largest |q_e| by joint, rad or m.
    pub position_error: Vec<f64>,
    /// Largest |q̇_e| by joint, rad/s or m/s.
    pub velocity_error: Vec<f64>,
}

/// What the emitted step rounds by.
#[derive(Clone, Debug, PartialEq)]
pub struct StepRounding {
    /// Bound by joint, N·m or N, on how far the torque that the step asks for is from that of the same step in real numbers, for
    /// the same numbers as inputs.
    pub torque: Vec<f64>,
    /// A law that switches by the sign of s may take the wrong one where |s| is no larger than this, rad/s or m/s; beside `torque`.
    /// 0 for the other laws.
    pub sign: f64,
    /// The states, inside the domain, for which that holds.
    pub states: StepStates,
    /// The desired motion by the number of the period, and how far it is from the motion; `None` in f64 or without a motion.
    pub(crate) reference: Option<(Ticks, ReferenceError)>,
}

impl StepRounding {
    /// Bounds by joint on how far the desired position, velocity and acceleration of the code are from the motion; `None` in f64 or
    /// without a motion.
    pub fn reference_error(&self) -> Option<&ReferenceError> {
        self.reference.as_ref().map(|(_, error)| error)
    }
}

/// What the states of a step lie in, beside the domain.
pub struct Surroundings<'a> {
    /// Where the bounds of the model hold.
    pub domain: &'a Domain,
    /// What the law keeps the errors below.
    pub envelope: &'a Envelope,
    /// The motion's own rates, or over a workspace without one the joints' limits.
    pub rates: &'a Rates,
    /// What the law learns.
    pub adaptation: Option<&'a Adaptation>,
}

impl StepStates {
    /// Errors up to those that the law keeps to; where it keeps to none, as far as the tube goes, and speeds that are wrong by as
    /// much as the desired ones.
    pub fn new(surroundings: &Surroundings) -> Self {
        let Surroundings { domain, envelope, rates, .. } = *surroundings;
        let width = domain.width();
        let or = |kept: f64, other: f64| if kept.is_finite() { kept.min(other) } else { other };
        let position = |(i, &kept): (usize, &f64)| match (&width, domain) {
            (Some(width), _) if width[i] > 0.0 => width[i],
            (_, Domain::Workspace(limits)) => or(kept, limits[i][1] - limits[i][0]),
            _ => or(kept, crate::domain::DEFAULT_TUBE),
        };
        let velocity = |(kept, &speed): (&f64, &f64)| if kept.is_finite() { *kept } else { speed };
        Self {
            position_error: envelope.position_error.iter().enumerate().map(position).collect(),
            velocity_error: envelope.velocity_error.iter().zip(&rates.speed).map(velocity).collect(),
        }
    }
}

/// Bounds by joint, N·m or N: no torque that the law asks for, computed in `format` from numbers of that format, is further from
/// the torque that the step has in real numbers, at any state of `states`; and the largest |s| of which rounding may change the
/// sign, where the law switches by it.
pub fn step_rounding(
    step: &StepGraph,
    states: &StepStates,
    surroundings: &Surroundings,
    format: Format,
) -> (Vec<f64>, f64) {
    let mut code: Graph = step.code.clone();
    code.outputs = step.asked();
    let Surroundings { domain, rates, adaptation, .. } = *surroundings;
    // Around a motion the errors are those of the law; the tube is a part of the positions.
    let around = match domain.motion_shared() {
        Some(motion) => Domain::Tube(motion, states.position_error.clone()),
        None => domain.clone(),
    };
    let mut all = largest(&around, step.joints, |instant| {
        let found = code.rounding(&Inside { instant, states, rates, adaptation }, format);
        found.outputs.into_iter().chain([found.sign]).collect()
    });
    let sign = all.pop().unwrap_or(f64::INFINITY);
    (all, sign)
}

struct Inside<'a> {
    instant: &'a Instant,
    states: &'a StepStates,
    rates: &'a Rates,
    adaptation: Option<&'a Adaptation>,
}

impl Inside<'_> {
    fn position_error(&self, j: usize) -> Interval {
        match &self.instant.desired {
            Some(_) => self.instant.error[j],
            None => Interval::about(0.0, self.states.position_error[j]),
        }
    }

    fn velocity_error(&self, j: usize) -> Interval {
        Interval::about(0.0, self.states.velocity_error[j])
    }

    fn desired_speed(&self, j: usize) -> Interval {
        let [_, qd, _] = match &self.instant.desired {
            Some(desired) => desired,
            None => return Interval::about(0.0, self.rates.speed[j]),
        };
        qd[j]
    }
}

impl Inputs for Inside<'_> {
    fn input(&self, variable: Variable) -> Interval {
        let desired = self.instant.desired.as_ref();
        match variable {
            Variable::Q(j) => self.instant.q[j],
            Variable::Qd(j) => self.desired_speed(j) + self.velocity_error(j),
            Variable::DesiredQ(j) => match desired {
                Some([q, ..]) => q[j],
                None => self.instant.q[j] + self.position_error(j),
            },
            Variable::DesiredQd(j) => self.desired_speed(j),
            Variable::DesiredQdd(j) => match desired {
                Some([.., qdd]) => qdd[j],
                None => Interval::about(0.0, self.rates.reference_acceleration[j]),
            },
            Variable::Theta(k) => match self.adaptation {
                Some(adaptation) => Interval { low: adaptation.low[k], high: adaptation.high[k] },
                None => Interval::ZERO,
            },
            Variable::Vr(_) | Variable::Ar(_) => Interval::ZERO,
        }
    }

    fn error(&self, measured: Variable) -> Option<Interval> {
        match measured {
            Variable::Q(j) => Some(self.position_error(j)),
            Variable::Qd(j) => Some(self.velocity_error(j)),
            _ => None,
        }
    }
}
