//! The numbers of the tracking law and what they promise: gains, ΔC, ΔC1, switching, limits, guarantee.

mod adaptation;
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
pub use error_envelope::Envelope;
pub use family::{least_eigenvalue, outweighs, smallest_multiple};
pub use form::InertiaBounds;
pub use gains::Gains;
pub use guarantee::Guarantee;
pub use inertia::{Cell, Extremes, Inertia};
pub use step::{RobustGain, StepGraph, StepParts};

use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, Rates, Torque, six_digits_up};
use crate::check::{Control, GainSource, Tuning};
use crate::domain::Domain;
use crate::error::{Diagnostics, Error};
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::motion::Motion;
use crate::number::short;
use crate::progress::{self, Progress};
use crate::reduction::Regression;
use crate::spec::{CoriolisTermSpec, LawSpec, OnFaultSpec};
use crate::torque::Regressor;
use feedforward::Feedforward;
use rounding::Rounding;

/// Everything a controller needs beside its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Which law.
    pub law: LawSpec,
    /// P12, K and Pqq.
    pub gains: Gains,
    /// W of equation (16), n×n, N·m·s/rad.
    pub w: Vec<Vec<f64>>,
    /// Ω of equation (16), n×n, N·m/(rad·s).
    pub omega: Vec<Vec<f64>>,
    /// What the errors and speeds stay below, given the initial error.
    pub envelope: Envelope,
    /// The largest rates that multiply the model while the errors stay in the envelope, feedback included; `None` where no
    /// level of V holds them.
    pub rates: Option<Rates>,
    /// ΔC of equation (30), n×n, N·m·s/rad.
    pub delta_c: Vec<Vec<f64>>,
    /// k* = λ_max(sym ΔC), N·m·s/rad.
    pub k_star: f64,
    /// The variant of (34).
    pub coriolis_term: CoriolisTermSpec,
    /// What a robust law switches with.
    pub robust_gain: RobustGain,
    /// ΔC1, n×n: the specification's, which was verified, or k*·I.
    pub delta_c1: Vec<Vec<f64>>,
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
    /// What law `adaptive` learns.
    pub adaptation: Option<Adaptation>,
    /// What all that promises.
    pub guarantee: Guarantee,
}

/// The model that a step computes with.
#[derive(Clone, Copy, Debug)]
pub struct StepModel<'a> {
    /// The passivity torque.
    pub code: &'a Graph,
    /// The same as a function of what the law learns.
    pub regressor: Option<&'a Regressor>,
    /// What it leaves out.
    pub bounds: &'a Bounds,
    /// Viscous friction of each joint, N·m·s/rad or N·s/m.
    pub viscous: &'a [f64],
}

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
    /// The same for the measure's own rates; `None` over a workspace where a joint lacks a limit.
    pub declared: Option<&'a Torque>,
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
    let rates = settled.then_some(rates);
    let robust_gain = match constant {
        true => RobustGain::Constant(stage.constant_gain(&gain, rates.as_ref())),
        false => RobustGain::State,
    };
    let design = Design {
        law: control.law,
        gains,
        w: tuning.w,
        omega: tuning.omega,
        envelope,
        rates,
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
            feedforward: problem.motion.map(along),
            rounding: Rounding::new(problem, &coulomb),
            coulomb,
            adaptation: Adaptation::new(problem)?,
            disturbance: arm.joints.iter().map(disturbance).collect(),
        })
    }

    /// ρ by joint, N·m or N: what the model is off by at most for rates up to `rates`, which is no more than `gain`, or at
    /// the measure's own rates where no level of V holds the errors. Friction counts with it.
    fn constant_gain(&self, gain: &[f64], rates: Option<&Rates>) -> Vec<f64> {
        let DesignProblem { bounds, declared, .. } = *self.problem;
        let friction = |speed: &[f64], i: usize| bounds.b[i] * speed[i] + self.disturbance[i];
        let known = rates.is_some();
        let proved = match (rates, declared) {
            (Some(rates), _) => Some(((self.problem.torque_error)(rates), rates)),
            (None, declared) => declared.map(|torque| (torque.error.clone(), &torque.rates)),
        };
        let Some((error, rates)) = proved else { return gain.to_vec() };
        let of = |(i, gain): (usize, &f64)| {
            let enough = (error[i] + friction(&rates.speed, i)).next_up().next_up();
            // Where a level of V holds, both are bounds at the same rates.
            six_digits_up(if known { enough.min(*gain) } else { enough })
        };
        gain.iter().enumerate().map(of).collect()
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

impl Design {
    /// The step of this law about the model `code` with these `bounds`.
    pub fn step(&self, model: &StepModel) -> StepGraph {
        StepParts {
            law: self.law,
            gains: &self.gains,
            robust_gain: &self.robust_gain,
            coriolis_term: self.coriolis_term,
            delta_c: &self.delta_c,
            delta_c1: &self.delta_c1,
            bounds: model.bounds,
            disturbance: &self.disturbance,
            boundary_layer: self.boundary_layer.as_deref(),
            viscous: model.viscous,
            coulomb: &self.coulomb,
            torque_limit: &self.torque_limit,
            period: self.period,
            adaptation: self.adaptation.as_ref(),
            code: model.code,
            regressor: model.regressor,
        }
        .graph()
    }

    /// The step of the same law about the exact model, whose code is `code`, with nothing left out.
    pub fn exact_step(&self, code: &Graph, viscous: &[f64]) -> StepGraph {
        let n = viscous.len();
        let zero = vec![vec![0.0; n]; n];
        let bounds = Bounds { d: zero.clone(), h: vec![zero.clone(); n], b: vec![0.0; n], g: vec![0.0; n] };
        let exact =
            Self { robust_gain: RobustGain::State, delta_c: zero.clone(), delta_c1: zero, ..self.clone() };
        exact.step(&StepModel { code, regressor: None, bounds: &bounds, viscous })
    }

    /// True where everything that is computed is a finite number.
    pub fn is_finite(&self) -> bool {
        let Envelope { v_max, position_error, velocity_error, speed, level } = &self.envelope;
        let lists = [position_error, velocity_error, speed].into_iter().chain(&self.delta_c);
        self.gains.is_finite() && lists.flatten().chain([v_max, level, &self.k_star]).all(|v| v.is_finite())
    }

    fn check(&self, control: &Control, faults: &mut Diagnostics) {
        let least = least_eigenvalue(&self.delta_c1, &self.delta_c);
        if control.delta_c1.is_some() && !outweighs(least, &self.delta_c) {
            faults.push(
                "control.delta_c1",
                format!(
                    "does not outweigh ΔC: for some δC with |δC| ≤ ΔC the least eigenvalue of ΔC1 + sym(δC) is {least:.6}"
                ),
                format!(
                    "add {:.6} to its diagonal, or leave it out for {:.6} times the identity",
                    -least, self.k_star
                ),
            );
        }
        let promised = &self.guarantee;
        if self.period >= promised.period_max && !control.allow_long_period {
            faults.push(
                "control.period",
                format!(
                    "is {} s, and the sampled loop is stable only below {} s",
                    self.period,
                    short(promised.period_max)
                ),
                format!(
                    "shorten it, lower W, {}widen the boundary layer, or set `control.allow_long_period` and lose the guarantee",
                    if self.adaptation.is_some() { "raise `control.adaptation.Ptheta`, " } else { "" }
                ),
            );
        } else if control.require_guarantee && !promised.holds {
            let list = |x: &[f64]| x.iter().map(|&e| short(e)).collect::<Vec<_>>().join(", ");
            let tube = match &promised.tube_needed {
                Some(tube) => format!("a tube of at least ({})", list(tube)),
                None => "other gains: no tube was found to be enough".to_string(),
            };
            faults.push(
                "control.require_guarantee",
                format!("is set, and nothing is guaranteed: {}", promised.reasons.join("; ")),
                format!(
                    "take {tube}, or an initial position error of at most ({})",
                    promised
                        .initial_error_max
                        .iter()
                        .map(|e| short(e * 0.9995))
                        .collect::<Vec<_>>()
                        .join(", ")
                ),
            );
        }
    }
}
