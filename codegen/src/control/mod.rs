//! The numbers of the tracking law and what they promise: gains, ΔC, ΔC1, switching, limits, guarantee.

mod adaptation;
mod anywhere;
mod design;
mod error_envelope;
mod family;
mod feedforward;
mod first_step;
mod form;
mod gain_synthesis;
mod gains;
mod guarantee;
mod inertia;
mod limits;
mod mix;
mod proposals;
mod reference;
mod region;
mod rounding;
mod search;
mod settling;
mod step;
#[cfg(test)]
mod tests;
mod tube_needed;
mod ultimate_bound;
mod verified;

use std::path::Path;

pub use adaptation::Adaptation;
pub use design::{Design, StepModel};
pub use error_envelope::Envelope;
pub use family::{least_eigenvalue, outweighs, smallest_multiple};
pub use form::InertiaBounds;
pub use gain_synthesis::two_digits;
pub use gains::Gains;
pub use guarantee::Guarantee;
pub use inertia::{Cell, Extremes, Inertia};
pub use proposals::proposals;
pub use reference::ReferenceLimits;
pub use region::room;
pub use step::{RobustGain, StepGraph};

use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, Rates, six_digits_up};
use crate::check::{Control, GainSource, Tuning};
use crate::domain::Domain;
use crate::error::{Diagnostics, Error};
use crate::lagrangian::Lagrangian;
use crate::motion::Motion;
use crate::progress::{self, Progress};
use crate::reduction::Regression;
use feedforward::Feedforward;
use rounding::Rounding;
pub(crate) use rounding::SingleRounding;
pub use rounding::{LoopErrors, loop_rounding};
pub use step::StepRounding;
pub(crate) use step::{StepStates, Surroundings, step_rounding};

/// What a law is designed from.
#[derive(Clone, Copy)]
pub struct DesignProblem<'a> {
    /// The specification, which faults name.
    pub file: &'a Path,
    /// Its controller.
    pub control: &'a Control,
    /// The arm that the model is made of.
    pub arm: &'a Arm,
    /// The arm as specified, before its rotations were rounded, and its family.
    pub given: (&'a Arm, &'a Uncertainty),
    /// What that rounding changes at most; `None` where it changes nothing.
    pub angles: Option<&'a Bounds>,
    /// The exact model.
    pub lagrangian: &'a Lagrangian,
    /// What the reduced model leaves out over the domain.
    pub bounds: &'a Bounds,
    /// What the model's code rounds by in f64, beside what `bounds` hold of it.
    pub rounding: &'a Bounds,
    /// What a step in f32 rounds by; `None` in f64.
    pub single: Option<&'a SingleRounding>,
    /// Where the bounds hold.
    pub domain: &'a Domain,
    /// The desired motion.
    pub motion: Option<&'a Motion>,
    /// All arms that the law must bear.
    pub uncertainty: &'a Uncertainty,
    /// The parameters of a law that learns.
    pub regression: Option<&'a Regression>,
    /// Whether to seek the smallest sufficient tube even where no guarantee is required.
    pub seek_tube: bool,
    /// What the model is off by at most, by joint, N·m or N, for rates up to these.
    pub torque_error: &'a dyn Fn(&Rates) -> Vec<f64>,
    /// Who is told how far the search for gains is.
    pub progress: &'a dyn Progress,
}

/// Designs the law and judges it.
///
/// # Errors
/// [`Error::Input`] where ΔC1 does not outweigh ΔC, the period is too long, or a required guarantee does not hold;
/// [`Error::Internal`] where a matrix that was checked before turns out singular.
pub fn design(problem: &DesignProblem, constant: bool) -> Result<Design, Error> {
    let DesignProblem { file, control, arm, .. } = *problem;
    let stage = Stage::new(problem, constant)?;
    let tuning = match &control.gains {
        GainSource::Requested(request) => gain_synthesis::tune(&stage, request)?,
        GainSource::Given(tuning) => tuning.clone(),
    };
    let told = if constant { "guarantee with a constant gain" } else { "guarantee" };
    let told = progress::Stage::new(problem.progress, told, 1);
    let (gains, judgement) = stage.judge(&tuning)?;
    drop(told);
    let guarantee::Judgement { envelope, delta_c, k_star, delta_c1, guarantee, rates, settled, gain, .. } =
        judgement;
    let robust_gain = match constant {
        true => RobustGain::Constant(stage.constant_gain(&gain, &rates)),
        false => RobustGain::State,
    };
    let reference = match problem.motion {
        Some(_) => None,
        None => ReferenceLimits::of(arm, problem.domain, &envelope.position_error),
    };
    let design = Design {
        reference,
        law: control.law,
        gains,
        w: tuning.w,
        omega: tuning.omega,
        envelope,
        rates: settled.then_some(rates),
        delta_c,
        k_star,
        coriolis_term: control.coriolis_term,
        robust_gain,
        delta_c1,
        disturbance: stage.disturbance,
        boundary_layer: tuning.boundary_layer,
        period: tuning.period,
        torque_limit: arm.joints.iter().map(|joint| joint.limits.torque).collect(),
        coulomb: stage.coulomb,
        on_fault: control.on_fault,
        adaptation: stage.adaptation,
        guarantee,
    };
    let mut faults = Diagnostics::of(file);
    design.check(control, &mut faults);
    faults.finish(design)
}

/// What gains are judged against.
struct Stage<'a> {
    problem: &'a DesignProblem<'a>,
    adaptation: Option<Adaptation>,
    /// Bound on the Coulomb friction that the command does not cancel, by joint, N·m or N.
    disturbance: Vec<f64>,
    /// What the motion itself takes; `None` without one.
    feedforward: Option<Feedforward>,
    /// Coulomb friction that the command compensates, forwards and backwards, by joint.
    coulomb: Vec<[f64; 2]>,
    /// What rounds.
    rounding: Rounding<'a>,
    /// Whether ρ is one number by joint.
    constant: bool,
}

impl<'a> Stage<'a> {
    fn new(problem: &'a DesignProblem<'a>, constant: bool) -> Result<Self, Error> {
        let DesignProblem { control, arm, .. } = *problem;
        let disturbance = |joint: &crate::arm::Joint| {
            let [forwards, backwards] = joint.coulomb_friction;
            // Compensated for the wrong direction, it counts in full from one side to the other.
            if control.compensate_coulomb { forwards - backwards } else { forwards.max(-backwards) }
        };
        let coulomb = |joint: &crate::arm::Joint| {
            if control.compensate_coulomb { joint.coulomb_friction } else { [0.0; 2] }
        };
        let (own, family) = problem.given;
        let along = |motion| Feedforward::new(own, family, motion);
        let coulomb: Vec<[f64; 2]> = arm.joints.iter().map(coulomb).collect();
        Ok(Self {
            problem,
            constant,
            feedforward: problem.motion.map(along).or_else(|| anywhere::anywhere(problem)),
            rounding: Rounding::new(problem, &coulomb),
            coulomb,
            adaptation: Adaptation::new(problem)?,
            disturbance: arm.joints.iter().map(disturbance).collect(),
        })
    }

    /// ρ by joint, N·m or N: what the model and friction are off by at most for rates up to `rates`, by its certificates or, as
    /// `gain`, by its entries: the smaller one.
    fn constant_gain(&self, gain: &[f64], rates: &Rates) -> Vec<f64> {
        let error = (self.problem.torque_error)(rates);
        let friction = |i: usize| self.problem.bounds.b[i] * rates.speed[i] + self.disturbance[i];
        let enough = |i: usize| (error[i] + friction(i)).next_up().next_up();
        gain.iter().enumerate().map(|(i, gain)| six_digits_up(enough(i)).min(*gain)).collect()
    }

    /// The gain matrices of `tuning` and what they promise.
    fn judge(&self, tuning: &Tuning) -> Result<(Gains, guarantee::Judgement), Error> {
        self.judged(tuning, false, None)
    }

    /// As much of a judgement as a comparison of gains needs; `facts` are those of the same gains with another layer.
    fn sketch(&self, tuning: &Tuning, facts: Option<&InertiaBounds>) -> Result<guarantee::Judgement, Error> {
        self.judged(tuning, true, facts).map(|(_, judgement)| judgement)
    }

    fn judged(
        &self,
        tuning: &Tuning,
        sketch: bool,
        facts: Option<&InertiaBounds>,
    ) -> Result<(Gains, guarantee::Judgement), Error> {
        let gains = Gains::new(tuning);
        let form = if gains.is_finite() { form::Form::new(&gains) } else { None };
        let form = form.ok_or_else(|| {
            let problem = "gives gains that overflow, or are too far apart to compute with";
            Error::input(self.problem.file, "control", problem, "write W, Pqq and Omega in SI units")
        })?;
        let judgement = guarantee::Parts {
            problem: self.problem,
            gains: &gains,
            form,
            disturbance: &self.disturbance,
            feedforward: self.feedforward.as_ref(),
            coulomb: &self.coulomb,
            rounding: &self.rounding,
            tuning,
            adaptation: self.adaptation.as_ref(),
            constant: self.constant,
            facts,
            sketch,
        }
        .judge()?;
        Ok((gains, judgement))
    }
}
