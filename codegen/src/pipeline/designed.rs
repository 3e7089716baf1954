//! Stage 6: the controller, and what is promised of it.

use super::Means;
use super::certified::Certified;
use super::judged::{has_long_period, required, stable, statement_of};
use super::replaced::{Replaced, Saving};
use super::requested::{follows, judges, requested};
use super::step_rounding::rounded_design;
use crate::check::{Checked, Control, GainSource, Tuning};
use crate::control::{Design, DesignProblem, SingleRounding, StepGraph, StepModel, StepRounding, design};
use crate::error::{Diagnostics, Error};
use crate::guarantee::{Kind, Statement};
use crate::spec::RobustGainSpec;

/// A certified model with the controller that the specification asks for.
///
/// Holds: every gain is a finite number; where a guarantee is required, it holds.
#[derive(Clone, Debug)]
pub(super) struct Designed {
    /// The model.
    pub certified: Certified,
    /// The controller; `None` where there is none, or where only the model was asked for.
    pub design: Option<Design>,
    /// The controller's step: law and model as one graph.
    pub step: Option<StepGraph>,
    /// What that step rounds by.
    pub rounding: Option<StepRounding>,
    /// The step of the same law about the exact model; `None` without a controller, or for a law that learns.
    pub exact_step: Option<StepGraph>,
    /// What is promised of the controller; `None` without one, or until it is asked for.
    pub statement: Option<Statement>,
    /// Why the model is exact though a reduced one was found; `None` where it is the one that was asked for.
    pub replaced: Option<Replaced>,
}

impl Designed {
    /// # Errors
    /// [`Error::Input`] where the gains overflow, no gains do what is asked for, or a required guarantee does not hold.
    pub fn new(certified: Certified, means: Means) -> Result<Self, Error> {
        let Some(control) = &certified.checked.control else {
            return Ok(Self::without_controller(certified));
        };
        let judged = match &control.gains {
            GainSource::Requested(request) if means.judges && follows(&certified, control) => {
                requested(&certified, control, request, means)?
            }
            _ => Self::made(&certified, control, means)?,
        };
        let Judged { made: (design, step, rounding), mut statement } = judged;
        let asked = control.require_guarantee.is_some() || has_long_period(control, &design);
        if asked && judges(&certified, means) {
            let made = statement.unwrap_or_else(|| statement_of(&certified, &design, &rounding, means));
            stable(&certified, &design, &made)?;
            required(&certified, &design, &made)?;
            statement = Some(made);
        }
        let exact_step =
            (design.adaptation.is_none()).then(|| match certified.proved.model.reduced.is_exact() {
                true => step.clone(),
                false => design.exact_step(&certified.proved.exact, &viscous(&certified.checked)),
            });
        Ok(Self {
            certified,
            design: Some(design),
            step: Some(step),
            rounding: Some(rounding),
            exact_step,
            statement,
            replaced: None,
        })
    }

    /// The controller with the switching gain that the specification asks for.
    pub(super) fn made(certified: &Certified, control: &Control, means: Means) -> Result<Judged, Error> {
        let state = || rounded_design(certified, control, means, false);
        let constant = || rounded_design(certified, control, means, true);
        Ok(match control.robust_gain {
            RobustGainSpec::State => Judged::new(state()?),
            RobustGainSpec::Constant => Judged::new(constant()?),
            // Where nothing is left out, there is no bracket to replace.
            RobustGainSpec::Auto if certified.proved.bounds.is_zero() => Judged::new(state()?),
            RobustGainSpec::Auto => match state() {
                // Gains that were searched for are judged again, not searched for again.
                Ok(own) => match rounded_design(certified, &given(control, &own.0), means, true) {
                    Ok(other) => better(certified, own, other, means),
                    Err(_) => Judged::new(own),
                },
                // A search for gains takes long where it finds none; one is enough.
                Err(error) if matches!(control.gains, GainSource::Requested(_)) => return Err(error),
                Err(error) => Judged::new(constant().map_err(|_| error)?),
            },
        })
    }

    /// Judges the controller, if there is one and that was not done.
    pub fn state(&mut self, means: Means) {
        if let (None, Some(design), Some(rounding), true) =
            (&self.statement, &self.design, &self.rounding, judges(&self.certified, means))
        {
            self.statement = Some(statement_of(&self.certified, design, rounding, means));
        }
    }

    fn without_controller(certified: Certified) -> Self {
        Self {
            certified,
            design: None,
            step: None,
            rounding: None,
            exact_step: None,
            statement: None,
            replaced: None,
        }
    }

    /// Whether the step of the exact model is known only once its controller is designed: it has bounds of its own.
    pub fn needs_twin(&self) -> bool {
        let Certified { checked, setting, proved, .. } = &self.certified;
        let bounded =
            !checked.built.uncertainty.is_empty() || !setting.sines.rounds() || setting.angles.is_some();
        self.exact_step.is_some() && !proved.model.reduced.is_exact() && bounded
    }

    /// The controller with the same gains, but with a constant ρ or the law's own bracket.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no controller, or where it is refused so.
    #[cfg(any(feature = "simulate", test))]
    pub fn with_other_gain(&self, constant: bool) -> Result<Design, Error> {
        let checked = &self.certified.checked;
        let (Some(control), Some(design)) = (&checked.control, &self.design) else {
            return Err(Error::input(&checked.loaded.path, "control", "is missing", "add `control`"));
        };
        let means = Means {
            effort: &crate::bounds::Effort::default(),
            progress: &crate::progress::Silent,
            cache: None,
            judges: true,
        };
        rounded_design(&self.certified, &given(control, design), means, constant).map(|(design, ..)| design)
    }

    /// What the step saves against that of the exact model; `None` where there is nothing to compare.
    pub fn saving(&self) -> Option<Saving> {
        let [reduced, exact] =
            [&self.step, &self.exact_step].map(|step| step.as_ref().map(|step| step.operations().cost()));
        Some(Saving { reduced: reduced?, exact: exact? })
    }
}

/// The same with the numbers of `design` given.
pub(super) fn given(control: &Control, design: &Design) -> Control {
    Control { gains: GainSource::Given(tuning(design)), ..control.clone() }
}

/// The numbers of a design, as a specification gives them.
fn tuning(design: &Design) -> Tuning {
    Tuning {
        period: design.period,
        w: design.w.clone(),
        pqq: design.gains.pqq.clone(),
        omega: design.omega.clone(),
        boundary_layer: design.boundary_layer.clone(),
    }
}

/// A controller, its step, and what that rounds by.
type Made = (Design, StepGraph, StepRounding);

/// The same, with what is promised of it, where that was asked.
pub(super) struct Judged {
    made: Made,
    pub(super) statement: Option<Statement>,
}

impl Judged {
    fn new(made: Made) -> Self {
        Self { made, statement: None }
    }

    /// The same with what is promised of it.
    pub(super) fn stated(mut self, certified: &Certified, means: Means) -> Self {
        let (design, _, rounding) = &self.made;
        self.statement.get_or_insert_with(|| statement_of(certified, design, rounding, means));
        self
    }
}

/// The one with the stronger promise, and of equal ones that with fewer operations; the first where they tie.
fn better(certified: &Certified, first: Made, second: Made, means: Means) -> Judged {
    let cost = |(_, step, _): &Made| step.operations().cost();
    let (cheap, dear) = if cost(&second) < cost(&first) { (second, first) } else { (first, second) };
    let judged = |made: Made| Judged::new(made).stated(certified, means);
    if !judges(certified, means) {
        return Judged::new(cheap);
    }
    let cheap = judged(cheap);
    let strongest = if certified.checked.motion.is_some() { Kind::Sampled } else { Kind::Continuous };
    if cheap.statement.as_ref().is_some_and(|statement| statement.kind <= strongest) {
        return cheap;
    }
    let dear = judged(dear);
    let rank = |judged: &Judged| judged.statement.as_ref().map(|statement| statement.kind);
    if rank(&dear) < rank(&cheap) { dear } else { cheap }
}

fn viscous(checked: &Checked) -> Vec<f64> {
    checked.built.arm.joints.iter().map(|joint| joint.viscous_friction).collect()
}

/// The controller whose ρ is constant, or the law's own bracket; `single` is what its step in f32 may round by.
pub(super) fn design_with(
    certified: &Certified,
    control: &Control,
    means: Means,
    constant: bool,
    single: Option<&SingleRounding>,
) -> Result<(Design, StepGraph), Error> {
    let (checked, proved) = (&certified.checked, &certified.proved);
    let design = with_problem(certified, control, means, single, |problem| design(problem, constant))?;
    let viscous = viscous(checked);
    let step = design.step(&StepModel {
        code: &proved.model.code,
        regressor: proved.regressor.as_ref(),
        bounds: &proved.bounds,
        viscous: &viscous,
    });
    let mut faults = Diagnostics::of(&checked.loaded.path);
    if !(design.is_finite() && step.code.is_finite()) {
        let problem = "gives gains or bounds on the errors that overflow";
        faults.push("control", problem, "write gains, boundary layer and initial errors in SI units");
    }
    faults.finish((design, step))
}

/// What `f` makes of the problem that gains solve.
pub(super) fn with_problem<T>(
    certified: &Certified,
    control: &Control,
    means: Means,
    single: Option<&SingleRounding>,
    f: impl FnOnce(&DesignProblem) -> T,
) -> T {
    let (checked, proved) = (&certified.checked, &certified.proved);
    let rounding = certified.error().rounding();
    f(&DesignProblem {
        file: &checked.loaded.path,
        control,
        arm: &checked.built.arm,
        given: (&checked.built.given, &checked.built.uncertain),
        angles: certified.setting.angles.as_ref(),
        lagrangian: &proved.lagrangian,
        bounds: &proved.bounds,
        rounding: &rounding,
        single,
        domain: &checked.domain,
        motion: checked.motion.as_deref(),
        uncertainty: &checked.built.uncertainty,
        regression: proved.regression.as_ref(),
        seek_tube: means.effort.seek_tube,
        torque_error: &|rates| certified.torque_error(rates, None),
        progress: means.progress,
    })
}
