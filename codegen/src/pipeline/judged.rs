//! What is proved of the sampled loop of a controller.

use super::Means;
use super::certified::Certified;
use super::designed::with_problem;
use crate::bounds::{Bounds, Effort, ModelError, Rates};
use crate::check::{Control, InitialError};
use crate::control::{
    Design, Envelope, LoopErrors, RobustGain, SingleRounding, StepRounding, loop_rounding, room,
};
use crate::error::Error;
use crate::guarantee::{Kind, Sampled, SampledLoop, Statement, Wrong};
use crate::lagrangian::Lagrangian;
use crate::number::short;
use crate::numerics::linalg::weighed;
use crate::progress::{Silent, Stage};
use crate::spec::{GuaranteeSpec, ScalarSpec};

/// What is promised of `design`.
pub(super) fn statement_of(
    certified: &Certified,
    design: &Design,
    rounding: &StepRounding,
    means: Means,
) -> Statement {
    let _stage = Stage::new(means.progress, "guarantee of the sampled loop", 1);
    let checked = &certified.checked;
    let sampled = checked.motion.is_some().then(|| Judge::new(certified, design, rounding).errors());
    Statement::new(&checked.built.given, &design.torque_limit, sampled, &design.guarantee)
}

/// Whether a period so long that the frozen loop may be unstable must be refused unless the sampled loop is guaranteed.
pub(super) fn has_long_period(control: &Control, design: &Design) -> bool {
    design.period >= design.guarantee.period_max && !control.allow_long_period
}

/// # Errors
/// [`Error::Input`] for a period that is too long where the sampled loop is not guaranteed.
pub(super) fn stable(certified: &Certified, design: &Design, statement: &Statement) -> Result<(), Error> {
    let checked = &certified.checked;
    let long = checked.control.as_ref().is_some_and(|control| has_long_period(control, design));
    if !long || statement.sampled.is_some() {
        return Ok(());
    }
    let longest = short(design.guarantee.period_max);
    let learns = if design.adaptation.is_some() { "raise `control.adaptation.Ptheta`, " } else { "" };
    let problem = format!("is {} s, and the sampled loop is stable only below {longest} s", design.period);
    let help = format!(
        "shorten it, lower W, {learns}widen the boundary layer, or set `control.allow_long_period` and lose the guarantee"
    );
    Err(Error::input(&checked.loaded.path, "control.period", problem, help))
}

/// # Errors
/// [`Error::Input`] where the guarantee that the specification asks for does not hold.
pub(super) fn required(certified: &Certified, design: &Design, statement: &Statement) -> Result<(), Error> {
    let checked = &certified.checked;
    let Some(wanted) = checked.control.as_ref().and_then(|control| control.require_guarantee) else {
        return Ok(());
    };
    let promised = &design.guarantee;
    let (holds, reasons) = match wanted {
        GuaranteeSpec::Sampled => (statement.kind == Kind::Sampled, &statement.reasons),
        GuaranteeSpec::Continuous => (promised.holds, &promised.reasons),
    };
    if holds {
        return Ok(());
    }
    let list = |x: &[f64]| x.iter().map(|&e| short(e)).collect::<Vec<_>>().join(", ");
    let help = match (wanted, &promised.tube_needed) {
        (GuaranteeSpec::Sampled, _) if checked.motion.is_none() => {
            "write a motion, or \"continuous\"".to_string()
        }
        (GuaranteeSpec::Sampled, _) if design.adaptation.is_some() => {
            "write \"continuous\", or take law `report` or `tight`".to_string()
        }
        (GuaranteeSpec::Sampled, _) => {
            "shorten the period, lower the initial error, take a wider tube, or higher torque limits"
                .to_string()
        }
        (GuaranteeSpec::Continuous, tube) => {
            let tube = match tube {
                Some(tube) => format!("a tube of at least ({})", list(tube)),
                None => "other gains: no tube was found to be enough".to_string(),
            };
            let most: Vec<f64> = promised.initial_error_max.iter().map(|e| e * 0.9995).collect();
            format!("take {tube}, or an initial position error of at most ({})", list(&most))
        }
    };
    let asked = if wanted == GuaranteeSpec::Sampled { "sampled" } else { "continuous" };
    let problem = format!("asks for `{asked}`, which does not hold: {}", reasons.join("; "));
    Err(Error::input(&checked.loaded.path, "control.require_guarantee", problem, help))
}

/// A sampled loop, for some questions.
pub(super) struct Judge<'a> {
    certified: &'a Certified,
    design: &'a Design,
    rounding: &'a StepRounding,
    /// The model of the arm as specified, and bounds on what the emitted one leaves out of it.
    own: Lagrangian,
    bounds: Bounds,
}

impl<'a> Judge<'a> {
    pub(super) fn new(certified: &'a Certified, design: &'a Design, rounding: &'a StepRounding) -> Self {
        let Certified { checked, proved, .. } = certified;
        let own = own_model(&proved.lagrangian);
        // What is uncertain counts number by number: the bounds of the family would count it twice.
        let bounds = match proved.model.reduced.is_exact() && !checked.built.uncertain.is_empty() {
            true => {
                ModelError { lagrangian: &own, ..certified.error() }.bounds(&Effort::default(), &Silent).1
            }
            false => proved.bounds.clone(),
        };
        Self { certified, design, rounding, own, bounds }
    }

    /// Its errors, or why nothing is proved of them.
    pub(super) fn errors(&self) -> Result<Sampled, Vec<String>> {
        let control = self.certified.checked.control.as_ref();
        let initial = control.map(|control| control.initial_error.clone()).unwrap_or_default();
        self.errors_from(self.design, &initial)
    }

    /// The same with other numbers of the design, from other initial errors.
    pub(super) fn errors_from(
        &self,
        design: &Design,
        initial: &InitialError,
    ) -> Result<Sampled, Vec<String>> {
        let checked = &self.certified.checked;
        let (Some(control), Some(motion)) = (&checked.control, &checked.motion) else {
            return Err(vec!["there is no motion".to_string()]);
        };
        if design.adaptation.is_some() {
            let reason = "the errors of a law that learns are not followed from sample to sample";
            return Err(vec![reason.to_string()]);
        }
        let Some(tube) = self.tube() else { return Err(Vec::new()) };
        let built = &checked.built;
        SampledLoop {
            arm: &built.given,
            uncertainty: &built.uncertain,
            motion,
            tube: &tube,
            design,
            bounds: &self.certified.proved.bounds,
            initial: [&initial.position, &initial.velocity],
            settle: control.settle,
            wrong: &|errors| self.wrong(design, errors),
        }
        .judge()
    }

    /// How far the joints may be off the motion, by joint, rad or m: over a workspace as far as its limits. `None` without a motion.
    pub(super) fn tube(&self) -> Option<Vec<f64>> {
        let checked = &self.certified.checked;
        let motion = checked.motion.as_deref()?;
        let room = || room(&checked.domain, Some(motion), &checked.built.arm);
        Some(checked.domain.width().unwrap_or_else(|| room().iter().map(|room| room.max(0.0)).collect()))
    }

    /// What the emitted step is wrong by against the arm as specified.
    fn wrong(&self, design: &Design, errors: &LoopErrors) -> Wrong {
        let Self { certified, rounding: found, own, bounds, .. } = self;
        let checked = &certified.checked;
        let model = certified.torque_error(&errors.rates, Some((own, bounds)));
        let n = model.len();
        let single = (checked.loaded.spec.emit.scalar == ScalarSpec::F32).then(|| SingleRounding {
            step: found.torque.clone(),
            sign: found.sign,
            reference: found
                .reference
                .as_ref()
                .map_or_else(|| [(); 3].map(|()| vec![0.0; n]), |r| r.1.clone()),
        });
        let gain = most_gain(certified, design, &errors.rates, &errors.s);
        let Some(control) = &checked.control else { return Wrong { torque: model, s: vec![0.0; n] } };
        let means = Means { effort: &Effort::default(), progress: &Silent, cache: None, judges: true };
        let [rounded, s] = with_problem(certified, control, means, single.as_ref(), |problem| {
            loop_rounding(problem, design, errors, &gain)
        });
        let torque = model.iter().zip(rounded).map(|(model, rounded)| (model + rounded).next_up()).collect();
        Wrong { torque, s }
    }
}

/// The model of the arm as specified alone: what is uncertain of it is followed number by number.
fn own_model(lagrangian: &Lagrangian) -> Lagrangian {
    let ranges = vec![[0.0; 2]; lagrangian.ranges.len()];
    Lagrangian { ranges, ..lagrangian.clone() }
}

/// The switching gain by joint, N·m or N: the constant one, or a bound on the law's own while the errors stay in their
/// envelope. `None` for a law that does not switch or that learns, or where no level of V holds the errors.
pub(super) fn switching_gain(certified: &Certified, design: &Design) -> Option<Vec<f64>> {
    if !design.law.has_choice() {
        return None;
    }
    if let RobustGain::Constant(gain) = &design.robust_gain {
        return Some(gain.clone());
    }
    let Envelope { position_error, velocity_error, .. } = &design.envelope;
    let pulled = design.gains.p12.iter().map(|row| weighed(row, position_error));
    let s: Vec<f64> = velocity_error.iter().zip(pulled).map(|(speed, pulled)| speed + pulled).collect();
    Some(most_gain(certified, design, design.rates.as_ref()?, &s))
}

/// More than any switching gain of `design`, by joint, N·m or N.
fn most_gain(certified: &Certified, design: &Design, rates: &Rates, s: &[f64]) -> Vec<f64> {
    let bounds = &certified.proved.bounds;
    let model = bounds.torque(rates);
    let of = |i: usize| {
        let moved: Vec<f64> = rates.speed.iter().zip(s).map(|(speed, s)| speed + s).collect();
        let friction = bounds.b[i] * rates.speed[i] + design.disturbance[i];
        model[i] + weighed(&design.delta_c[i], &moved) + friction
    };
    (0..s.len()).map(of).collect()
}
