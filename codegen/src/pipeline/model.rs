//! The model that a specification asks for, with its code.

use crate::arm::Arm;
use crate::bounds::TorqueScale;
use crate::choose::{self, ToleranceRequest};
use crate::domain::{Domain, Measure};
use crate::error::Diagnostics;
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::motion::Motion;
use crate::progress::Progress;
use crate::reduction::{self, Dictionary, Reduced};
use crate::spec::{DictionarySpec, ModelSpec, RefitSpec, Spec};
use crate::torque::{self, Form};

/// A model with its code.
pub(super) struct Model {
    pub reduced: Reduced,
    pub form: Form,
    pub code: Graph,
}

/// What a model is chosen by.
pub(super) struct ModelRequest<'a> {
    pub spec: &'a Spec,
    pub arm: &'a Arm,
    pub lagrangian: &'a Lagrangian,
    pub domain: &'a Domain,
    pub motion: Option<&'a Motion>,
    pub measure: &'a Measure,
    pub points: &'a [Vec<f64>],
    pub progress: &'a dyn Progress,
}

impl ModelRequest<'_> {
    /// The model that the specification asks for; `exact` is the form and the code of the exact one.
    pub fn model(&self, scale: Option<&TorqueScale>, exact: &(Form, Graph)) -> Model {
        let Self { spec, arm, lagrangian, measure, points, .. } = *self;
        let minimax = spec.refit == RefitSpec::Minimax;
        let reduced = match spec.model {
            ModelSpec::Exact => {
                let (form, code) = exact.clone();
                return Model { reduced: reduction::exact(lagrangian), form, code };
            }
            ModelSpec::Auto | ModelSpec::Tolerance { .. } => {
                return self.cheapest(scale, exact);
            }
            ModelSpec::Shared { functions } | ModelSpec::Separate { functions }
                if spec.dictionary != DictionarySpec::Harmonic =>
            {
                let separate = matches!(spec.model, ModelSpec::Separate { .. });
                let candidates = dictionary(spec).functions(lagrangian);
                let mut model =
                    reduction::over_dictionary(lagrangian, measure, candidates, functions, separate);
                if minimax {
                    model = reduction::minimax_sparse(lagrangian, model, functions, points);
                }
                let code = torque::sparse(lagrangian, &model);
                return Model { reduced: model.reduced(lagrangian), form: Form::Sparse, code };
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
        let code = torque::expanded(arm, lagrangian, &reduced);
        Model { reduced, form: Form::Expanded, code }
    }

    /// The cheapest model within the tolerance, which is about the arm's own parameters.
    fn cheapest(&self, scale: Option<&TorqueScale>, exact: &(Form, Graph)) -> Model {
        let fraction = self.spec.model.tolerance().unwrap_or_default();
        let known = self.lagrangian.at_nominal();
        let request = ToleranceRequest {
            arm: self.arm,
            lagrangian: &known,
            domain: self.domain,
            motion: self.motion,
            measure: self.measure,
            scale,
            exact: (exact.0, &exact.1),
            progress: self.progress,
        };
        let choice = choose::cheapest(&request, fraction);
        Model { reduced: choice.reduced, form: choice.form, code: choice.code }
    }
}

/// Faults where more functions are asked for than there are.
pub(super) fn check_count(spec: &Spec, lagrangian: &Lagrangian, faults: &mut Diagnostics) {
    let p = dictionary(spec).functions(lagrangian).len();
    let (field, functions) = match spec.model {
        ModelSpec::Shared { functions } => ("model.shared.functions", functions),
        ModelSpec::Separate { functions } => ("model.separate.functions", functions),
        ModelSpec::Exact | ModelSpec::Tolerance { .. } | ModelSpec::Auto => return,
    };
    if functions > p {
        let whose = match spec.dictionary {
            DictionarySpec::Harmonic => "exact model",
            DictionarySpec::Product => "dictionary `product`",
            DictionarySpec::Union => "dictionary `union`",
        };
        let problem = format!("is {functions}, but the {whose} has {p} functions");
        faults.push(field, problem, format!("write a number from 1 to {p}, or `\"exact\"`"));
    }
}

/// The functions among which the reduction chooses.
pub(crate) fn dictionary(spec: &Spec) -> Dictionary {
    match spec.dictionary {
        DictionarySpec::Harmonic => Dictionary::Harmonic,
        DictionarySpec::Product => Dictionary::Product,
        DictionarySpec::Union => Dictionary::Union,
    }
}
