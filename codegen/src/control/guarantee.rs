//! What is promised of the closed loop, and why not where nothing is.

use super::adaptation::{Adaptation, Learning, regression};
use super::error_envelope::{ClosedLoop, Envelope, Fixed, Load};
use super::feedforward::Feedforward;
use super::form::{Form, InertiaBounds, inertia_bounds, initial_level};
use super::inertia::Inertia;
use super::limits::Longest;
use super::region::{cells, outside, position_bound, start};
use super::rounding::Rounding;
use super::tube_needed::shape;
use super::{DesignProblem, family};
use crate::bounds::{Rates, six_digits_up};
use crate::check::InitialError;
use crate::error::Error;
use crate::number;
use crate::spec::LawSpec;

/// The promises about a closed loop without torque limits, and whether they hold.
///
/// They are those of the continuous law, with the lag of a torque held for one period counted to first order; a period
/// below `period_max` keeps the sampled loop stable at every frozen D of the domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Guarantee {
    /// Whether q stays inside the domain of the bounds from every initial error of the specification.
    pub holds: bool,
    /// Why not; empty where it holds.
    pub reasons: Vec<String>,
    /// Longest period with T (λ_max(D⁻¹K) + λ_max(P12)) < 2 over the domain, s; K is the whole gain on s, with ΔC1, the
    /// slope ρ/φ inside the layer and what is learnt within a period. The sign function has no slope to count: its
    /// chatter counts in `final_error`.
    pub period_max: f64,
    /// Whether nothing in the domain is proved to be faster than that period supposes.
    pub period_certified: bool,
    /// Bound on |q_e| by joint, rad or m, once the effect of the initial errors has died away: a short motion may end
    /// before that. Rounding in f64 is counted, so it is 0 only where nothing is computed.
    pub final_error: Vec<f64>,
    /// Largest initial position error for which the domain is enough, by joint, rad or m: the specification's own, or
    /// the tube where it names none, scaled; the initial velocity error as specified.
    pub initial_error_max: Vec<f64>,
    /// Smallest tube that the errors never leave, by joint, rad or m, with the bounds of the present one; `None` where
    /// none was found, or none was sought.
    pub tube_needed: Option<Vec<f64>>,
    /// Bounds on D over the domain.
    pub inertia: InertiaBounds,
}

/// The bounds on D over the domain, the errors under the law, ΔC and ΔC1 that go with them, and the promises.
pub(super) struct Judgement {
    pub(super) envelope: Envelope,
    pub(super) delta_c: Vec<Vec<f64>>,
    pub(super) k_star: f64,
    pub(super) delta_c1: Vec<Vec<f64>>,
    /// The largest switching gain ρ, N·m or N.
    pub(super) gain: Vec<f64>,
    /// Whether some level of V holds it.
    pub(super) settled: bool,
    /// The largest rates that multiply the model while the errors stay in the envelope.
    pub(super) rates: Rates,
    /// The largest share of a torque limit that the first step may ask; 0 where there are none.
    pub(super) first_step: f64,
    pub(super) guarantee: Guarantee,
}

/// The constant gain that is enough for the errors of `envelope`. Written with six digits, it is no larger than what chatter and
/// period are judged with.
fn fixed(load: &mut Load, envelope: &Envelope) -> Fixed {
    load.gain.iter_mut().for_each(|gain| *gain = six_digits_up(*gain));
    Fixed {
        rho: load.gain.clone(),
        position_error: envelope.position_error.clone(),
        velocity_error: envelope.velocity_error.clone(),
    }
}

pub(super) struct Parts<'a> {
    pub(super) problem: &'a DesignProblem<'a>,
    pub(super) gains: &'a super::Gains,
    pub(super) form: Form,
    pub(super) disturbance: &'a [f64],
    /// What the motion itself takes; `None` without one.
    pub(super) feedforward: Option<&'a Feedforward>,
    /// Coulomb friction that the command compensates.
    pub(super) coulomb: &'a [[f64; 2]],
    /// What rounds.
    pub(super) rounding: &'a Rounding<'a>,
    pub(super) tuning: &'a crate::check::Tuning,
    pub(super) adaptation: Option<&'a Adaptation>,
    /// Whether ρ is one number by joint.
    pub(super) constant: bool,
    /// The bounds on D, where the same gains were judged before.
    pub(super) facts: Option<&'a InertiaBounds>,
    /// Pass over final error, largest initial error and smallest tube, which a comparison of gains does not need.
    pub(super) sketch: bool,
}

impl Parts<'_> {
    /// What is said of a sign function whose chatter may raise V.
    fn chatter(&self, closed_loop: &ClosedLoop, load: &Load, envelope: &Envelope) -> Option<String> {
        let chatter = closed_loop.ultimate_bound(load, true) + closed_loop.parameter_energy();
        let raises =
            self.problem.control.law.is_robust() && self.layer().is_none() && chatter > envelope.level;
        raises.then(|| {
            format!(
                "the sign function, held for {} s, may raise V from {} J to {} J: take a boundary layer or a shorter period",
                self.tuning.period,
                number::short(envelope.level),
                number::short(chatter)
            )
        })
    }

    pub(super) fn judge(self) -> Result<Judgement, Error> {
        let DesignProblem { arm, domain, motion, bounds, control, .. } = *self.problem;
        let n = arm.dof();
        let own = domain.width().unwrap_or(vec![0.0; n]);
        let over = cells(domain, &own);
        let (inertia, position_bound) = self.inertia(&own);
        let facts = match self.facts {
            Some(facts) => facts.clone(),
            None => inertia_bounds(&inertia, over.clone(), self.gains, &self.form),
        };
        let InitialError { position, velocity } = &control.initial_error;
        let level = |position: &[f64]| {
            let cell = start(domain, motion, position);
            initial_level(&inertia, self.gains, cell, position, velocity)
        };
        let mut closed_loop = self.closed_loop(&facts, &position_bound)?;
        let v_max = level(position);
        let level_found = closed_loop.invariant_level(v_max, position)?;
        let settled = level_found.is_some();
        let mut reasons: Vec<String> = (!settled).then(|| unsettled(control.law)).into_iter().collect();
        let envelope = level_found.map_or_else(|| closed_loop.envelope_at(v_max, position), Ok)?;
        let delta_c = bounds.coriolis(&envelope.speed);
        let k_star = family::smallest_multiple(&delta_c);
        let delta_c1 = control.delta_c1.clone().unwrap_or_else(|| family::multiple_of_identity(k_star, n));
        let mut load = closed_loop.load(&envelope.position_error, &envelope.velocity_error, &delta_c);
        let (rates, _) = closed_loop.rates(&envelope.position_error, &envelope.velocity_error);
        if self.constant {
            closed_loop.fixed = Some(fixed(&mut load, &envelope));
        }
        // Gains that hold no level of V are out of a comparison, whatever their period.
        let longest = if self.sketch && !settled {
            Longest { period: 0.0, certified: false }
        } else {
            self.longest_period(&inertia, over.clone(), &delta_c1, &closed_loop, &load.gain)
        };
        let (final_error, initial_error_max) = if self.sketch {
            (envelope.position_error.clone(), position.clone())
        } else {
            (
                closed_loop.final_error(&inertia, over, &envelope, &delta_c)?,
                self.largest_initial_error(&closed_loop, &shape(position, &own), level)?,
            )
        };
        reasons.extend(self.period_reasons(facts.certified, &longest));
        let (first_step, short) = self.drives(&closed_loop, &delta_c, &delta_c1);
        reasons.extend(short);
        reasons.extend(self.chatter(&closed_loop, &load, &envelope));
        let leaves = outside(domain, motion, arm, &envelope.position_error);
        let wanted = !self.sketch && (self.problem.seek_tube || control.require_guarantee.is_some());
        let tube_needed = match facts.certified && wanted {
            true if leaves.is_empty() || domain.width().is_none() => Some(envelope.position_error.clone()),
            true => self.smallest_tube(&inertia, &envelope, position, &position_bound)?,
            false => None,
        };
        if !leaves.is_empty() {
            reasons.push(leaves.join("; "));
        }
        let guarantee = Guarantee {
            holds: reasons.is_empty(),
            reasons,
            period_max: longest.period,
            period_certified: longest.certified,
            final_error,
            initial_error_max,
            tube_needed,
            inertia: facts,
        };
        Ok(Judgement {
            envelope,
            delta_c,
            k_star,
            delta_c1,
            gain: load.gain,
            settled,
            rates,
            first_step,
            guarantee,
        })
    }

    /// D over a domain of the half width `width`, and the largest |q| that it is enclosed for, by joint.
    fn inertia(&self, width: &[f64]) -> (Inertia, Vec<f64>) {
        let DesignProblem { arm, domain, control, lagrangian, uncertainty, angles, .. } = *self.problem;
        let wide: Vec<f64> =
            width.iter().zip(&control.initial_error.position).map(|(a, b)| a.max(*b).max(1.0)).collect();
        let position_bound = position_bound(&cells(domain, &wide), arm.dof());
        let inertia = Inertia::of_family(arm, uncertainty, lagrangian, &position_bound, angles);
        (inertia, position_bound)
    }

    pub(super) fn closed_loop<'b>(
        &'b self,
        inertia: &'b InertiaBounds,
        position_bound: &[f64],
    ) -> Result<ClosedLoop<'b>, Error> {
        let DesignProblem { arm, motion, bounds, control, .. } = *self.problem;
        let limit = |of: fn(&crate::arm::Limits) -> Option<f64>| -> Vec<f64> {
            arm.joints.iter().map(|joint| of(&joint.limits).unwrap_or(0.0)).collect()
        };
        let learning = |adaptation| {
            Ok(Learning::new(adaptation, regression(self.problem)?, self.problem.lagrangian, position_bound))
        };
        Ok(ClosedLoop {
            law: control.law,
            term: control.coriolis_term,
            constant: self.constant,
            fixed: None,
            gains: self.gains,
            form: &self.form,
            bounds,
            inertia,
            speed: motion.map_or_else(|| limit(|l| l.velocity), |m| m.largest_speed()),
            acceleration: motion.map_or_else(|| limit(|l| l.acceleration), |m| m.largest_acceleration()),
            disturbance: self.disturbance,
            rounding: self.rounding,
            layer: self.layer(),
            period: self.tuning.period,
            lag: self.feedforward.map_or_else(|| vec![0.0; arm.dof()], |taken| taken.lag(self.tuning.period)),
            learning: self.adaptation.map(learning).transpose()?,
        })
    }

    pub(super) fn layer(&self) -> Option<&[f64]> {
        self.tuning.boundary_layer.as_deref()
    }

    pub(super) fn has_matrix(&self) -> bool {
        let control = self.problem.control;
        !self.constant
            && control.law.has_bracket()
            && control.coriolis_term == crate::spec::CoriolisTermSpec::Matrix
    }
}

/// What is said of a law that holds no level of V.
fn unsettled(law: LawSpec) -> String {
    let more = match law {
        LawSpec::Exact => {
            "raise W or Omega, or take law `report` or `tight`, which outweigh what the model leaves out"
        }
        LawSpec::Report | LawSpec::Tight => "raise W or Omega, or narrow the boundary layer",
        LawSpec::Adaptive => {
            "raise W or Omega, narrow the boundary layer or the intervals of uncertainty, or lower Ptheta"
        }
    };
    format!("no level of V is found that the law keeps it below: {more}")
}
