//! Stage 6: the controller, and what is promised of it.

use super::Means;
use super::certified::Certified;
use super::replaced::{Replaced, Saving};
use super::step_rounding::rounded_design;
use crate::bounds::Effort;
use crate::check::{Checked, Control, GainSource, Tuning};
use crate::control::{Design, DesignProblem, SingleRounding, StepGraph, StepModel, StepRounding, design};
use crate::error::{Diagnostics, Error};
use crate::progress::Silent;
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
        let state = || rounded_design(&certified, control, means, false);
        let constant = || rounded_design(&certified, control, means, true);
        let (design, step, rounding) = match control.robust_gain {
            RobustGainSpec::State => state()?,
            RobustGainSpec::Constant => constant()?,
            // Where nothing is left out, there is no bracket to replace.
            RobustGainSpec::Auto if certified.proved.bounds.is_zero() => state()?,
            RobustGainSpec::Auto => match state() {
                // Gains that were searched for are judged again, not searched for again.
                Ok(own) => match rounded_design(&certified, &given(control, &own.0), means, true) {
                    Ok(other) => cheaper(own, other),
                    Err(_) => own,
                },
                // A search for gains takes long where it finds none; one is enough.
                Err(error) if matches!(control.gains, GainSource::Requested(_)) => return Err(error),
                Err(error) => constant().map_err(|_| error)?,
            },
        };
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
            replaced: None,
        })
    }

    fn without_controller(certified: Certified) -> Self {
        Self { certified, design: None, step: None, rounding: None, exact_step: None, replaced: None }
    }

    /// Whether the step of the exact model is known only once its controller is designed: it has bounds of its own.
    pub fn needs_twin(&self) -> bool {
        let Certified { checked, setting, proved } = &self.certified;
        let bounded =
            !checked.built.uncertainty.is_empty() || !setting.sines.rounds() || setting.angles.is_some();
        self.exact_step.is_some() && !proved.model.reduced.is_exact() && bounded
    }

    /// The controller with the same gains, but with a constant ρ or the law's own bracket.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no controller, or where it is refused so.
    pub fn with_other_gain(&self, constant: bool) -> Result<Design, Error> {
        let checked = &self.certified.checked;
        let (Some(control), Some(design)) = (&checked.control, &self.design) else {
            return Err(Error::input(&checked.loaded.path, "control", "is missing", "add `control`"));
        };
        let means = Means { effort: &Effort::default(), progress: &Silent, cache: None };
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
type Judged = (Design, StepGraph, StepRounding);

/// The one with fewer operations of those whose guarantee holds, or of both where neither does; the first where they tie.
fn cheaper(first: Judged, second: Judged) -> Judged {
    let rank = |(design, step, _): &Judged| (!design.guarantee.holds, step.operations().cost());
    if rank(&second) < rank(&first) { second } else { first }
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
    let error = certified.error();
    let rounding = error.rounding();
    let problem = DesignProblem {
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
        torque_error: &|rates| error.torque_error(&proved.certificates, &proved.bounds, rates),
        progress: means.progress,
    };
    let design = design(&problem, constant)?;
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
