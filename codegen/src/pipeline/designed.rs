//! Stage 6: the controller, and what is promised of it.

use super::Means;
use super::certified::Certified;
use crate::check::Control;
use crate::control::{Design, DesignProblem, StepGraph, StepModel, design};
use crate::error::{Diagnostics, Error};
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
}

impl Designed {
    /// # Errors
    /// [`Error::Input`] where the gains overflow, no gains do what is asked for, or a required guarantee does not hold.
    pub fn new(certified: Certified, means: Means) -> Result<Self, Error> {
        let Some(control) = &certified.checked.control else {
            return Ok(Self { certified, design: None, step: None });
        };
        let state = || with_gain(&certified, control, means, false);
        let constant = || with_gain(&certified, control, means, true);
        let (design, step) = match control.robust_gain {
            RobustGainSpec::State => state()?,
            RobustGainSpec::Constant => constant()?,
            // Where nothing is left out, there is no bracket to replace.
            RobustGainSpec::Auto if certified.proved.bounds.is_zero() => state()?,
            RobustGainSpec::Auto => match (state(), constant()) {
                (Ok(own), Ok(other)) => cheaper(own, other),
                (own, Err(_)) => own?,
                (Err(_), other) => other?,
            },
        };
        Ok(Self { certified, design: Some(design), step: Some(step) })
    }
}

/// The one with fewer operations of those whose guarantee holds, or of both where neither does; the first where they tie.
fn cheaper(first: (Design, StepGraph), second: (Design, StepGraph)) -> (Design, StepGraph) {
    let rank = |(design, step): &(Design, StepGraph)| (!design.guarantee.holds, step.operations().cost());
    if rank(&second) < rank(&first) { second } else { first }
}

/// The controller whose ρ is constant, or the law's own bracket.
fn with_gain(
    certified: &Certified,
    control: &Control,
    means: Means,
    constant: bool,
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
        domain: &checked.domain,
        motion: checked.motion.as_deref(),
        uncertainty: &checked.built.uncertainty,
        regression: proved.regression.as_ref(),
        seek_tube: means.effort.seek_tube,
        torque_error: &|rates| error.met(&proved.certificates, &proved.bounds, rates).error,
        declared: proved.torque.as_ref(),
        progress: means.progress,
    };
    let design = design(&problem, constant)?;
    let mut faults = Diagnostics::of(&checked.loaded.path);
    if !design.is_finite() {
        let problem = "gives gains or bounds on the errors that overflow";
        faults.push("control", problem, "write gains and initial errors in SI units");
    }
    faults.finish(())?;
    let viscous: Vec<f64> = checked.built.arm.joints.iter().map(|joint| joint.viscous_friction).collect();
    let step = design.step(&StepModel {
        code: &proved.model.code,
        regressor: proved.regressor.as_ref(),
        bounds: &proved.bounds,
        viscous: &viscous,
    });
    Ok((design, step))
}
