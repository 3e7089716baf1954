//! Stage 5: what the model leaves out, proved.

use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::Means;
use super::expanded::Expanded;
use super::modelled::{Modelled, overflow};
use super::sampled::Sampled;
use super::setting::Setting;
use crate::bounds::{Bounds, Certificate, ModelError, Rates, Torque};
use crate::check::Checked;
use crate::error::{Diagnostics, Error};
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::model::Model;
use crate::progress::Stage;
use crate::reduction::Regression;
use crate::torque::Regressor;

/// A torque error that was computed.
#[derive(Clone, Debug)]
struct Known {
    /// Whether it is that of the arm as specified alone, not of its family.
    alone: bool,
    /// The rates for which it holds.
    rates: Rates,
    /// By joint, N·m or N.
    error: Vec<f64>,
}

/// A model with bounds on its errors.
///
/// Holds: no bound is exceeded by any state of the domain, and every bound is a finite number.
#[derive(Clone, Debug)]
pub(super) struct Certified {
    /// The specification.
    pub checked: Checked,
    /// Domain, sines and rounded rotations.
    pub setting: Setting,
    /// The model and what is proved of it.
    pub proved: Proved,
    /// Torque errors by the rates that were asked for: each takes seconds.
    known: Arc<Mutex<Vec<Known>>>,
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
    /// How much of the model stands on each kept function, in their order.
    pub shares: Vec<f64>,
    /// What is odd about the specification without being wrong.
    pub warnings: Vec<String>,
    /// A certificate for each coefficient.
    pub certificates: Vec<Certificate>,
    /// What the model leaves out over the domain at most.
    pub bounds: Bounds,
    /// What that costs in torque; `None` over a workspace where a joint lacks a limit.
    pub torque: Option<Torque>,
}

impl Certified {
    /// # Errors
    /// [`Error::Input`] where the model overflows within the domain, or the rounding of rotations alone takes more than
    /// the tolerance.
    pub fn new(mut modelled: Modelled, means: Means) -> Result<Self, Error> {
        let Sampled { expanded, setting, scale, .. } = &modelled.sampled;
        let error = setting.error(&expanded.checked, &expanded.lagrangian, &modelled.model);
        let (certificates, mut bounds) = error.bounds(means.effort, means.progress);
        let stage = Stage::new(means.progress, "torque error", 1);
        let torque = scale.clone().map(|scale| error.torque(&certificates, &bounds, scale));
        drop(stage);
        let checked = &expanded.checked;
        let mut faults = Diagnostics::of(&checked.loaded.path);
        let mut warnings = Vec::new();
        if let Some(torque) = &torque {
            error.judge_tolerance(torque, &mut faults, &mut warnings);
        }
        if !checked.built.uncertainty.viscous.is_empty() {
            bounds.b.clone_from(&checked.built.uncertainty.viscous);
        }
        let bounds = bounds.rounded_up();
        faults.finish(())?;
        if !bounds.is_finite() {
            return Err(overflow(checked));
        }
        modelled.warnings.extend(warnings);
        let Modelled { sampled, model, exact, regression, regressor, shares, warnings } = modelled;
        let Sampled { expanded, setting, .. } = sampled;
        let Expanded { checked, lagrangian, .. } = expanded;
        let proved = Proved {
            lagrangian,
            model,
            exact,
            regression,
            regressor,
            shares,
            warnings,
            certificates,
            bounds,
            torque,
        };
        Ok(Self { checked, setting, proved, known: Arc::default() })
    }

    /// What an earlier run has proved of the same specification, but for its gains.
    pub fn restored(checked: Checked, mut proved: Proved) -> Self {
        let setting = Setting::new(&checked);
        let learnt = proved.regressor.as_mut().map(|regressor| &mut regressor.code);
        for code in learnt.into_iter().chain([&mut proved.model.code]) {
            code.sines = setting.sines.clone();
        }
        Self { setting, proved, checked, known: Arc::default() }
    }

    /// Whether the specification leaves the choice of the model open and a reduced one was chosen.
    pub fn is_chosen_reduced(&self) -> bool {
        self.checked.loaded.spec.model.tolerance().is_some() && !self.proved.model.reduced.is_exact()
    }

    /// Bound on the torque error by joint for rates up to `rates`, N·m or N: of the family, or with `alone` of another model and bounds,
    /// those of the arm as specified. What f32 code rounds by is not part of it.
    pub fn torque_error(&self, rates: &Rates, alone: Option<(&Lagrangian, &Bounds)>) -> Vec<f64> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |known: &&Known| known.alone == alone.is_some() && known.rates == *rates;
        if let Some(found) = known().iter().find(same) {
            return found.error.clone();
        }
        let Proved { certificates, bounds, torque, .. } = &self.proved;
        // Not from what is known by now: the same bound whatever was asked for before.
        let pays =
            torque.as_ref().is_none_or(|torque| self.error().search_pays(certificates, bounds, torque));
        let error = match alone {
            Some((lagrangian, bounds)) => {
                ModelError { lagrangian, ..self.error() }.torque_error(certificates, bounds, rates, pays)
            }
            None => self.error().torque_error(certificates, bounds, rates, pays),
        };
        known().push(Known { alone: alone.is_some(), rates: rates.clone(), error: error.clone() });
        error
    }

    /// What bounds follow from.
    pub fn error(&self) -> ModelError<'_> {
        self.setting.error(&self.checked, &self.proved.lagrangian, &self.proved.model)
    }
}
