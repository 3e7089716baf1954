//! Stage 4: the model that the specification asks for, with its code.

use super::sampled::Sampled;
use super::{Means, Wanted, angles};
use crate::bounds::TorqueScale;
use crate::check::Checked;
use crate::choose::{self, ToleranceRequest};
use crate::error::{Diagnostics, Error};
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::model::Model;
use crate::progress::Stage;
use crate::reduction::{self, Dictionary, Regression};
use crate::spec::{DictionarySpec, LawSpec, ModelSpec, RefitSpec, ScalarSpec, Spec};
use crate::torque::{self, Form, Regressor};

/// The emitted model beside the exact one.
///
/// Holds: every parameter of the model is a finite number; its code takes sines as the specification says.
#[derive(Clone, Debug)]
pub(super) struct Modelled {
    /// What it was chosen by.
    pub sampled: Sampled,
    /// The model.
    pub model: Model,
    /// The cheapest exact passivity torque.
    pub exact: Graph,
    /// The parameters of a law that learns.
    pub regression: Option<Regression>,
    /// The torque as a function of them.
    pub regressor: Option<Regressor>,
    /// How much of the model stands on each kept function.
    pub shares: Vec<f64>,
    /// What is odd about the specification without being wrong.
    pub warnings: Vec<String>,
}

impl Modelled {
    /// # Errors
    /// [`Error::Input`] where a parameter overflows.
    pub fn new(mut sampled: Sampled, wanted: Wanted, means: Means) -> Result<Self, Error> {
        let scalar = sampled.expanded.checked.loaded.spec.emit.scalar;
        let checked = &sampled.expanded.checked;
        let (lagrangian, built) = (&sampled.expanded.lagrangian, &checked.built);
        let stage = Stage::new(means.progress, "reduction", 1);
        let exact = {
            let _stage = Stage::new(means.progress, "exact code", 1);
            torque::exact(&built.arm, lagrangian)
        };
        if scalar == ScalarSpec::F32 {
            let setting = &sampled.setting;
            let fma = checked.loaded.spec.emit.fma;
            let code = if fma { exact.1.fused() } else { exact.1.clone() };
            let code = Graph { sines: setting.sines.clone(), ..code };
            let reserved = |scale: TorqueScale| scale.reserving_code(&code, &setting.turn, scalar.format());
            sampled.scale = sampled.scale.map(reserved);
        }
        let mut warnings = sampled.expanded.warnings.clone();
        warnings.extend(angles::advice(&checked.loaded, &built.arm, &built.given, &exact.1));
        let mut model = match wanted {
            Wanted::Asked => requested(&sampled, &exact, means),
            Wanted::Exact => unreduced(lagrangian, &exact),
        };
        let regression = learns(&checked.loaded.spec).then(|| regression(&sampled, &mut model));
        drop(stage);
        if model.form == Form::Recursive && !sampled.setting.sines.rounds() {
            // What coarse sines do is known of the plain recursion alone.
            model.code = torque::plain(&built.arm);
        }
        let mut regressor = regression
            .as_ref()
            .map(|regression| torque::regressor(&built.arm, lagrangian, regression, model.form));
        if let Some(regressor) = &mut regressor {
            regressor.code.sines = sampled.setting.sines.clone();
        }
        model.code.sines = sampled.setting.sines.clone();
        if !model.reduced.is_finite() {
            return Err(overflow(checked));
        }
        let mut exact = exact.1;
        if checked.loaded.spec.emit.fma {
            let learnt = regressor.as_mut().map(|regressor| &mut regressor.code);
            for code in learnt.into_iter().chain([&mut model.code, &mut exact]) {
                *code = code.fused();
            }
        }
        let shares = reduction::shares(lagrangian, &model.reduced, &sampled.measure);
        Ok(Self { model, exact, regression, regressor, shares, warnings, sampled })
    }
}

/// What is said where the model's numbers overflow.
pub(super) fn overflow(checked: &Checked) -> Error {
    let mut faults = Diagnostics::of(&checked.loaded.path);
    let help = "write positions, speeds and the measure in SI units";
    faults.push("measure", "reaches states at which the model overflows", help);
    faults.into_error()
}

fn learns(spec: &Spec) -> bool {
    spec.control.as_ref().is_some_and(|control| control.law == LawSpec::Adaptive)
}

/// What law `adaptive` learns; `model` follows it.
fn regression(sampled: &Sampled, model: &mut Model) -> Regression {
    let checked = &sampled.expanded.checked;
    let (spec, lagrangian) = (&checked.loaded.spec, &sampled.expanded.lagrangian);
    let adaptation = spec.control.as_ref().and_then(|control| control.adaptation.clone());
    model.reduced = reduction::reestimate(lagrangian, model.reduced.clone(), &sampled.points, spec.refit);
    let names: Vec<String> = checked.built.uncertainty.parameters.iter().map(|p| p.name.clone()).collect();
    Regression::new(lagrangian, &model.reduced, adaptation.unwrap_or_default().parameters, &names)
}

/// The exact model in the form that costs least.
fn unreduced(lagrangian: &Lagrangian, exact: &(Form, Graph)) -> Model {
    let (form, code) = exact.clone();
    Model { reduced: reduction::exact(lagrangian), form, code }
}

/// The model that the specification asks for; `exact` is the form and the code of the exact one.
fn requested(sampled: &Sampled, exact: &(Form, Graph), means: Means) -> Model {
    let Sampled { expanded, measure, points, .. } = sampled;
    let (spec, lagrangian) = (&expanded.checked.loaded.spec, &expanded.lagrangian);
    let minimax = spec.refit == RefitSpec::Minimax;
    let reduced = match spec.model {
        ModelSpec::Exact => return unreduced(lagrangian, exact),
        ModelSpec::Auto | ModelSpec::Tolerance { .. } => return cheapest(sampled, exact, means),
        ModelSpec::Shared { functions } | ModelSpec::Separate { functions }
            if spec.dictionary != DictionarySpec::Harmonic =>
        {
            return over_dictionary(sampled, functions);
        }
        ModelSpec::Shared { functions } => {
            let reduced = reduction::shared(lagrangian, measure, functions);
            if minimax { reduction::minimax(lagrangian, reduced, points) } else { reduced }
        }
        ModelSpec::Separate { functions } => {
            let reduced = reduction::separate(lagrangian, measure, functions);
            if minimax { reduction::minimax_each(lagrangian, reduced, points) } else { reduced }
        }
    };
    let code = torque::expanded(&expanded.checked.built.arm, lagrangian, &reduced);
    Model { reduced, form: Form::Expanded, code }
}

/// A model of `functions` functions among more than the ψ of the exact one.
fn over_dictionary(sampled: &Sampled, functions: usize) -> Model {
    let Sampled { expanded, measure, points, .. } = sampled;
    let (spec, lagrangian) = (&expanded.checked.loaded.spec, &expanded.lagrangian);
    let separate = matches!(spec.model, ModelSpec::Separate { .. });
    let candidates = Dictionary::of(spec.dictionary).functions(lagrangian);
    let mut sparse = reduction::over_dictionary(lagrangian, measure, candidates, functions, separate);
    if spec.refit == RefitSpec::Minimax {
        sparse = reduction::minimax_sparse(lagrangian, sparse, functions, points);
    }
    let code = torque::sparse(lagrangian, &sparse);
    Model { reduced: sparse.reduced(lagrangian), form: Form::Sparse, code }
}

/// The cheapest model within the tolerance, which is about the arm's own parameters.
fn cheapest(sampled: &Sampled, exact: &(Form, Graph), means: Means) -> Model {
    let checked = &sampled.expanded.checked;
    let known = sampled.expanded.lagrangian.at_nominal();
    let request = ToleranceRequest {
        arm: &checked.built.arm,
        lagrangian: &known,
        domain: &checked.domain,
        measure: &sampled.measure,
        scale: sampled.scale.as_ref(),
        exact: (exact.0, &exact.1),
        progress: means.progress,
    };
    choose::cheapest(&request, checked.loaded.spec.model.tolerance().unwrap_or_default())
}
