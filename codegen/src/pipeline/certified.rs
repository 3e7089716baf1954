//! Stage 5: what the model leaves out, proved.

use super::Means;
use super::modelled::Modelled;
use crate::bounds::{Bounds, Certificate, ModelError, Torque};
use crate::error::{Diagnostics, Error};
use crate::progress::Stage;

/// A model with bounds on its errors.
///
/// Holds: no bound is exceeded by any state of the domain, and every bound is a finite number.
#[derive(Clone, Debug)]
pub(super) struct Certified {
    /// The model.
    pub modelled: Modelled,
    /// A certificate for each coefficient.
    pub certificates: Vec<Certificate>,
    /// What the model leaves out over the domain at most.
    pub bounds: Bounds,
    /// What that costs in torque; `None` over a workspace where a joint lacks a limit.
    pub torque: Option<Torque>,
}

impl Modelled {
    /// What bounds follow from.
    pub(super) fn error(&self) -> ModelError<'_> {
        let expanded = &self.sampled.expanded;
        ModelError {
            loaded: &expanded.checked.loaded,
            arm: &expanded.checked.built.arm,
            uncertainty: &expanded.checked.built.uncertainty,
            lagrangian: &expanded.lagrangian,
            reduced: &self.model.reduced,
            domain: &self.sampled.turn,
            form: self.model.form,
            sines: &self.sampled.sines,
            angles: self.sampled.angles.as_ref(),
        }
    }
}

impl Certified {
    /// # Errors
    /// [`Error::Input`] where the model overflows within the domain.
    pub fn new(mut modelled: Modelled, means: Means) -> Result<Self, Error> {
        let error = modelled.error();
        let (certificates, mut bounds) = error.bounds(means.effort, means.progress);
        let stage = Stage::new(means.progress, "torque error", 1);
        let scale = modelled.sampled.scale.clone();
        let torque = scale.map(|scale| error.torque(&certificates, &bounds, scale));
        drop(stage);
        let beyond = torque.as_ref().and_then(|torque| error.beyond_tolerance(torque));
        modelled.warnings.extend(beyond);
        let checked = &modelled.sampled.expanded.checked;
        if !checked.built.uncertainty.viscous.is_empty() {
            bounds.b.clone_from(&checked.built.uncertainty.viscous);
        }
        let bounds = bounds.rounded_up();
        if !(modelled.model.reduced.is_finite() && bounds.is_finite()) {
            let mut faults = Diagnostics::of(&checked.loaded.path);
            let help = "write positions, speeds and the measure in SI units";
            faults.push("measure", "reaches states at which the model overflows", help);
            return Err(faults.into_error());
        }
        Ok(Self { certificates, bounds, torque, modelled })
    }
}
