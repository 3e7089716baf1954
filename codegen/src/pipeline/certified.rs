//! Stage 5: what the model leaves out, proved.

use serde::{Deserialize, Serialize};

use super::Means;
use super::expanded::Expanded;
use super::modelled::Modelled;
use super::sampled::Sampled;
use crate::bounds::{Bounds, Certificate, ModelError, Torque, position_bound, rounded_angles};
use crate::check::Checked;
use crate::domain::Domain;
use crate::error::{Diagnostics, Error};
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::model::Model;
use crate::progress::Stage;
use crate::reduction::Regression;
use crate::torque::Regressor;
use crate::trig::Trig;

/// A model with bounds on its errors.
///
/// Holds: no bound is exceeded by any state of the domain, and every bound is a finite number.
#[derive(Clone, Debug)]
pub(super) struct Certified {
    /// The specification.
    pub checked: Checked,
    /// How sines are taken.
    pub sines: Trig,
    /// The domain within one turn of each joint, where bounds are sought.
    pub turn: Domain,
    /// What rounding the arm's rotations changes at most; `None` where it changes nothing.
    pub angles: Option<Bounds>,
    /// The model and what is proved of it.
    pub proved: Proved,
}

/// A model and what is proved of it: what took the time, and what gains do not change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Proved {
    /// The exact model.
    pub lagrangian: Lagrangian,
    /// The emitted model.
    pub model: Model,
    /// The cheapest exact passivity torque.
    pub exact: Graph,
    /// The parameters of a law that learns.
    pub regression: Option<Regression>,
    /// The torque as a function of them.
    pub regressor: Option<Regressor>,
    /// What is odd about the specification without being wrong.
    pub warnings: Vec<String>,
    /// A certificate for each coefficient.
    pub certificates: Vec<Certificate>,
    /// What the model leaves out over the domain at most.
    pub bounds: Bounds,
    /// What that costs in torque; `None` over a workspace where a joint lacks a limit.
    pub torque: Option<Torque>,
}

impl Modelled {
    /// What bounds follow from.
    fn error(&self) -> ModelError<'_> {
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
    /// [`Error::Input`] where the model overflows within the domain, or the rounding of rotations alone takes more than
    /// the tolerance.
    pub fn new(mut modelled: Modelled, means: Means) -> Result<Self, Error> {
        let error = modelled.error();
        let (certificates, mut bounds) = error.bounds(means.effort, means.progress);
        let stage = Stage::new(means.progress, "torque error", 1);
        let scale = modelled.sampled.scale.clone();
        let torque = scale.map(|scale| error.torque(&certificates, &bounds, scale));
        drop(stage);
        let mut faults = Diagnostics::of(&modelled.sampled.expanded.checked.loaded.path);
        let mut warnings = Vec::new();
        if let Some(torque) = &torque {
            error.judge_tolerance(torque, &mut faults, &mut warnings);
        }
        modelled.warnings.extend(warnings);
        let checked = &modelled.sampled.expanded.checked;
        if !checked.built.uncertainty.viscous.is_empty() {
            bounds.b.clone_from(&checked.built.uncertainty.viscous);
        }
        let bounds = bounds.rounded_up();
        if !(modelled.model.reduced.is_finite() && bounds.is_finite()) {
            let help = "write positions, speeds and the measure in SI units";
            faults.push("measure", "reaches states at which the model overflows", help);
        }
        faults.finish(())?;
        let Modelled { sampled, model, exact, regression, regressor, warnings } = modelled;
        let Sampled { expanded, sines, turn, angles, .. } = sampled;
        let Expanded { checked, lagrangian, .. } = expanded;
        let proved = Proved {
            lagrangian,
            model,
            exact,
            regression,
            regressor,
            warnings,
            certificates,
            bounds,
            torque,
        };
        Ok(Self { checked, sines, turn, angles, proved })
    }

    /// What an earlier run has proved of the same specification, but for its gains.
    pub fn restored(checked: Checked, mut proved: Proved) -> Self {
        let built = &checked.built;
        let sines = Trig::new(&checked.loaded.spec.emit.trig);
        let turn = checked.domain.within_a_turn(&built.arm, 1.0);
        let angles = rounded_angles(
            (&built.arm, &built.uncertainty),
            (&built.given, &built.uncertain),
            &position_bound(&turn),
        );
        let learnt = proved.regressor.as_mut().map(|regressor| &mut regressor.code);
        for code in learnt.into_iter().chain([&mut proved.model.code]) {
            code.sines = sines.clone();
        }
        Self { sines, turn, angles, proved, checked }
    }

    /// What bounds follow from.
    pub fn error(&self) -> ModelError<'_> {
        ModelError {
            loaded: &self.checked.loaded,
            arm: &self.checked.built.arm,
            uncertainty: &self.checked.built.uncertainty,
            lagrangian: &self.proved.lagrangian,
            reduced: &self.proved.model.reduced,
            domain: &self.turn,
            form: self.proved.model.form,
            sines: &self.sines,
            angles: self.angles.as_ref(),
        }
    }
}
