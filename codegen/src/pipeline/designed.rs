//! Stage 6: the controller, and what is promised of it.

use super::Means;
use super::certified::Certified;
use crate::control::{Design, DesignProblem, design};
use crate::error::{Diagnostics, Error};

/// A certified model with the controller that the specification asks for.
///
/// Holds: every gain is a finite number; where a guarantee is required, it holds.
#[derive(Clone, Debug)]
pub(super) struct Designed {
    /// The model.
    pub certified: Certified,
    /// The controller; `None` where there is none, or where only the model was asked for.
    pub design: Option<Design>,
}

impl Designed {
    /// # Errors
    /// [`Error::Input`] where the gains overflow, no gains do what is asked for, or a required guarantee does not hold.
    pub fn new(certified: Certified, means: Means) -> Result<Self, Error> {
        let (checked, proved) = (&certified.checked, &certified.proved);
        let Some(control) = &checked.control else { return Ok(Self { certified, design: None }) };
        let rounding = certified.error().rounding();
        let design = design(&DesignProblem {
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
            progress: means.progress,
        })?;
        let mut faults = Diagnostics::of(&checked.loaded.path);
        if !design.is_finite() {
            let problem = "gives gains or bounds on the errors that overflow";
            faults.push("control", problem, "write gains and initial errors in SI units");
        }
        faults.finish(())?;
        Ok(Self { certified, design: Some(design) })
    }
}
