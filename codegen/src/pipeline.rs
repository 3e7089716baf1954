//! All stages in order: from a checked specification to a model, its bounds, its controller and its code.

use std::path::Path;

use crate::arm::{Arm, Built, JointKind, Uncertainty, indefinite, indefinite_among};
use crate::body::{self, Form, Regressor};
use crate::bounds::{
    Bounds, Certificate, Effort, Torque, certified, reach, recursion, torque_error, with_sines,
};
use crate::check::{examine, vector};
use crate::design::{Design, Problem, checked, design};
use crate::dynamics::mass_matrix;
use crate::emit::{Module, emit};
use crate::error::{Error, Faults};
use crate::graph::Graph;
use crate::lagrangian::{Lagrangian, expand_family};
use crate::load::{Loaded, load, spec_hash};
use crate::measure::{Domain, Measure};
use crate::motion::Motion;
use crate::reduction::{self, Dictionary, Reduced, Regression};
use crate::sines::Sines;
use crate::spec::{DictionarySpec, LawSpec, MeasureSpec, ModelSpec, RefitSpec, Spec};
use crate::tolerance::{self, Scale};

/// Half-width of the tube where the specification names no measure, rad or m.
pub(crate) const DEFAULT_TUBE: f64 = 0.05;

/// Where the torque error is what counts, no single coefficient is worth more boxes and more starts of a search.
const BOXES: usize = 2000;
const STARTS: usize = 4;

/// Positions of the domain at which D is looked at.
const POSITIONS: usize = 512;

/// The same for each vertex of the uncertain parameters' box.
const VERTEX_POSITIONS: usize = 64;

/// Everything that follows from one specification.
///
/// Holds: the arm's D(q) was positive definite wherever it was looked at; the motion keeps to the joints'
/// limits; ξ ≤ p.
#[derive(Clone, Debug)]
pub struct Generation {
    /// The specification.
    pub loaded: Loaded,
    /// The arm.
    pub arm: Arm,
    /// What is odd about the specification without being wrong.
    pub warnings: Vec<String>,
    /// The desired motion.
    pub motion: Option<Motion>,
    /// Where the model must hold.
    pub domain: Domain,
    /// The exact model.
    pub lagrangian: Lagrangian,
    /// The emitted model.
    pub reduced: Reduced,
    /// A certificate for each coefficient of [`Generation::lagrangian`].
    pub certificates: Vec<Certificate>,
    /// What the model leaves out over the domain at most.
    pub bounds: Bounds,
    /// What that costs in torque; `None` over a workspace where a joint lacks a limit.
    pub torque: Option<Torque>,
    /// The controller.
    pub design: Option<Design>,
    /// Form of the emitted body.
    pub form: Form,
    /// The emitted passivity torque.
    pub code: Graph,
    /// All arms that the controller must bear.
    pub uncertainty: Uncertainty,
    /// The parameters of a law that learns.
    pub regression: Option<Regression>,
    /// The torque as a function of them.
    pub regressor: Option<Regressor>,
    /// The cheapest exact passivity torque.
    pub exact_code: Graph,
}

impl Generation {
    /// Reads the specification at `path` and runs every stage.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the specification and the files that it names.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Self::new(load(path)?)
    }

    /// Runs every stage.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn new(loaded: Loaded) -> Result<Self, Error> {
        Self::with_effort(loaded, &Effort::default())
    }

    /// Runs every stage, with that much work for each bound.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn with_effort(loaded: Loaded, effort: &Effort) -> Result<Self, Error> {
        let mut faults = Faults::of(&loaded.path);
        let (built, motion) = examine(&loaded, &mut faults);
        let Some(Built { arm, uncertainty, warnings }) = built else { return Err(faults.into_error()) };
        let spec = &loaded.spec;
        if let Some(state) = indefinite(&arm, |q| mass_matrix(&arm, q)) {
            state.report(&mut faults);
            return Err(faults.into_error());
        }
        let lagrangian = expand_family(&arm, &uncertainty);
        check_count(spec, &lagrangian, &mut faults);
        if !faults.is_empty() {
            return Err(faults.into_error());
        }

        let domain = domain(spec, &arm)?;
        let sines = Sines::new(&spec.emit.trig);
        check_angles(&sines, &reach(&domain, motion.as_ref()), &arm, &mut faults);
        faults.finish(())?;
        let measure = Measure::new(&domain, motion.as_ref(), &arm);
        let refused = |report: &dyn Fn(&mut Faults)| {
            let mut faults = Faults::of(&loaded.path);
            report(&mut faults);
            Err(faults.into_error())
        };
        // The domain may hold states that the look at the limits has missed, such as a wrist stretched out.
        let stride = measure.points.len().div_ceil(POSITIONS).max(1);
        let positions = measure.points.iter().step_by(stride);
        if let Some(state) = indefinite_among(positions, |q| mass_matrix(&arm, q)) {
            return refused(&|faults| state.report(faults));
        }
        let stride = measure.points.len().div_ceil(VERTEX_POSITIONS).max(1);
        for u in uncertainty.vertices() {
            let member = uncertainty.at(&arm, &u);
            let positions = measure.points.iter().step_by(stride);
            if let Some(state) = indefinite_among(positions, |q| mass_matrix(&member, q)) {
                return refused(&|faults| state.report_member(&uncertainty, &u, faults));
            }
        }
        let learns = spec.control.as_ref().filter(|control| control.law == LawSpec::Adaptive);
        let points = match spec.refit {
            RefitSpec::Minimax => reduction::extremes(&measure, &domain, motion.as_ref()),
            RefitSpec::LeastSquares => measure.points.clone(),
        };
        let scale = Scale::new(&arm, &domain, motion.as_ref());
        let exact = body::exact(&arm, &lagrangian);
        let Model { reduced, form, mut code } = {
            let ask = Ask {
                spec,
                arm: &arm,
                lagrangian: &lagrangian,
                domain: &domain,
                motion: motion.as_ref(),
                measure: &measure,
                points: &points,
            };
            ask.model(scale.as_ref(), &exact)
        };
        let exact_code = exact.1;
        let regression = learns.map(|control| {
            let kind = control.adaptation.clone().unwrap_or_default().parameters;
            let reduced = reduction::reestimate(&lagrangian, reduced.clone(), &points, spec.refit);
            let names: Vec<String> = uncertainty.parameters.iter().map(|p| p.name.clone()).collect();
            (Regression::new(&lagrangian, &reduced, kind, &names), reduced)
        });
        let (regression, reduced) = match regression {
            Some((regression, reestimated)) => (Some(regression), reestimated),
            None => (None, reduced),
        };
        let effort_here = match spec.model.tolerance() {
            Some(_) => {
                Effort { boxes: effort.boxes.min(BOXES), starts: effort.starts.min(STARTS), ..*effort }
            }
            None => *effort,
        };
        // The arm whose recursion it is.
        let own_arm = reduced.dropped.as_ref().map_or(&arm, |dropped| &dropped.arm);
        let beyond = !sines.rounds() || reduced.dropped.is_some() && sines.beyond_ulp() > 0.0;
        // What the sines' error makes of the torque, where that is no matter of single coefficients.
        let mut coarse: Option<Bounds> = None;
        let (certificates, mut bounds) = if form == Form::Recursive && beyond {
            // What coarse sines do is known of the plain recursion alone.
            code = body::plain(own_arm);
            let own = recursion(own_arm, &reach(&domain, motion.as_ref()), sines.error);
            let out =
                recursive_bounds(&own, &lagrangian, &reduced, &domain, motion.as_ref(), &effort_here, &sines);
            coarse = Some(own);
            out
        } else {
            let certificates = certified(&lagrangian, &reduced, &domain, motion.as_ref(), &effort_here);
            let certificates =
                with_sines(certificates, &lagrangian, &reduced, &domain, motion.as_ref(), &sines);
            let bounds = Bounds::of(&lagrangian, &certificates);
            (certificates, bounds)
        };
        let torque = scale.map(|Scale { rates, peak }| {
            if form == Form::Recursive && reduced.is_exact() {
                return Torque { error: bounds.torque(&rates), peak };
            }
            let of_coefficients: Vec<Certificate> = match coarse {
                None => certificates.clone(),
                Some(_) => certificates.iter().map(without_sines).collect(),
            };
            let mut error =
                torque_error(&lagrangian, &reduced, &domain, motion.as_ref(), &of_coefficients, &rates);
            if let (Some(fraction), true) = (spec.model.tolerance(), uncertainty.parameters.is_empty()) {
                // The choice has proved as much, perhaps with more work, for sines within an ulp.
                for (i, (error, peak)) in error.iter_mut().zip(&peak).enumerate() {
                    let multipliers = rates.multipliers(&lagrangian, i);
                    let sines: f64 = of_coefficients.iter().zip(&multipliers).map(|(c, u)| c.sines * u).sum();
                    let proved = fraction * peak;
                    let proved = if sines == 0.0 { proved } else { (proved + sines).next_up() };
                    *error = error.min(proved);
                }
            }
            if let Some(own) = &coarse {
                let added = own.torque(&rates);
                error.iter_mut().zip(added).for_each(|(error, added)| *error = (*error + added).next_up());
            }
            Torque { error, peak }
        });
        if !uncertainty.viscous.is_empty() {
            bounds.b.clone_from(&uncertainty.viscous);
        }
        let mut regressor =
            regression.as_ref().map(|regression| body::regressor(&arm, &lagrangian, regression, form));
        if let Some(regressor) = &mut regressor {
            regressor.code.sines = sines.clone();
        }
        code.sines = sines;
        if !(reduced.is_finite() && bounds.is_finite()) {
            let mend = "write positions, speeds and the measure in SI units";
            return refused(&|faults| {
                faults.push("measure", "reaches states at which the model overflows", mend)
            });
        }
        let design = spec
            .control
            .as_ref()
            .map(|control| {
                design(&Problem {
                    file: &loaded.path,
                    control,
                    arm: &arm,
                    lagrangian: &lagrangian,
                    bounds: &bounds,
                    domain: &domain,
                    motion: motion.as_ref(),
                    uncertainty: &uncertainty,
                    regression: regression.as_ref(),
                    seek_tube: effort.seek_tube,
                })
            })
            .transpose()?;
        if design.as_ref().is_some_and(|design| !design.is_finite()) {
            let problem = "gives gains or bounds on the errors that overflow";
            let mend = "write gains and initial errors in SI units";
            return refused(&|faults| faults.push("control", problem, mend));
        }
        Ok(Self {
            arm,
            warnings,
            motion,
            domain,
            lagrangian,
            reduced,
            certificates,
            bounds,
            torque,
            design,
            uncertainty,
            regression,
            regressor,
            form,
            code,
            exact_code,
            loaded,
        })
    }

    /// The text of the generated module.
    ///
    /// # Errors
    /// [`Error::Input`] where a named file has become unreadable, [`Error::Internal`] for defects.
    pub fn module(&self) -> Result<String, Error> {
        emit(&Module {
            name: &self.loaded.spec.name,
            hash: &spec_hash(&self.loaded)?,
            arm: &self.arm,
            uncertainty: &self.uncertainty,
            lagrangian: &self.lagrangian,
            reduced: &self.reduced,
            bounds: &self.bounds,
            torque: self.torque.as_ref(),
            domain: &self.domain,
            form: self.form,
            code: &self.code,
            regressor: self.regressor.as_ref(),
            exact_code: &self.exact_code,
            motion: self.motion.as_ref(),
            design: self.design.as_ref(),
        })
    }
}

/// A model with its code.
struct Model {
    reduced: Reduced,
    form: Form,
    code: Graph,
}

/// What a model is chosen by.
struct Ask<'a> {
    spec: &'a Spec,
    arm: &'a Arm,
    lagrangian: &'a Lagrangian,
    domain: &'a Domain,
    motion: Option<&'a Motion>,
    measure: &'a Measure,
    points: &'a [Vec<f64>],
}

impl Ask<'_> {
    /// The model that the specification asks for; `exact` is the form and the code of the exact one.
    fn model(&self, scale: Option<&Scale>, exact: &(Form, Graph)) -> Model {
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
                let code = body::sparse(lagrangian, &model);
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
        let code = body::expanded(arm, lagrangian, &reduced);
        Model { reduced, form: Form::Expanded, code }
    }

    /// The cheapest model within the tolerance, which is about the arm's own parameters.
    fn cheapest(&self, scale: Option<&Scale>, exact: &(Form, Graph)) -> Model {
        let fraction = self.spec.model.tolerance().unwrap_or_default();
        let known = self.lagrangian.at_nominal();
        let (form, code) = exact;
        let ask = tolerance::Ask {
            arm: self.arm,
            lagrangian: &known,
            domain: self.domain,
            motion: self.motion,
            measure: self.measure,
            scale,
            exact: (*form, code),
        };
        let choice = tolerance::cheapest(&ask, fraction);
        Model { reduced: choice.reduced, form: choice.form, code: choice.code }
    }
}

/// The certificate with the sines' part taken out, never below what was certified without it.
fn without_sines(certificate: &Certificate) -> Certificate {
    let bound = if certificate.sines == 0.0 {
        certificate.bound
    } else {
        (certificate.bound - certificate.sines).max(0.0).next_up()
    };
    Certificate { bound, sines: 0.0, ..certificate.clone() }
}

/// Bounds on the plain recursion with sines off by more than rounding: `own`, what they do to it, with what it leaves out
/// and what uncertain parameters do.
fn recursive_bounds(
    own: &Bounds,
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
    effort: &Effort,
    sines: &Sines,
) -> (Vec<Certificate>, Bounds) {
    // Only what a law learns is in expanded form.
    let learnt = Reduced { combinations: vec![Vec::new(); reduced.combinations.len()], ..reduced.clone() };
    let certificates = certified(lagrangian, reduced, domain, motion, effort);
    let certificates = with_sines(certificates, lagrangian, &learnt, domain, motion, sines);
    let bounds = Bounds::of(lagrangian, &certificates).plus(own);
    let add = |(mut certificate, more): (Certificate, Certificate)| {
        certificate.bound = (certificate.bound + more.bound).next_up();
        certificate.sines = (certificate.sines + more.bound).next_up();
        certificate
    };
    (certificates.into_iter().zip(own.certificates(lagrangian)).map(add).collect(), bounds)
}

fn check_count(spec: &Spec, lagrangian: &Lagrangian, faults: &mut Faults) {
    let p = dictionary(spec).functions(lagrangian).len();
    let (field, functions) = match spec.model {
        ModelSpec::Shared { functions } => ("model.shared.functions", functions),
        ModelSpec::Separate { functions } => ("model.separate.functions", functions),
        ModelSpec::Exact | ModelSpec::Tolerance { .. } | ModelSpec::Auto => return,
    };
    if functions > p {
        let problem = format!("is {functions}, but the exact model has {p} functions");
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

/// Faults where the domain holds angles for which the sines chosen promise nothing.
fn check_angles(sines: &Sines, reach: &[f64], arm: &Arm, faults: &mut Faults) {
    let turning = arm.joints.iter().zip(reach).filter(|(joint, _)| joint.kind == JointKind::Revolute);
    for (joint, most) in turning.filter(|(_, most)| **most > sines.range) {
        faults.push(
            "emit.trig",
            format!("takes angles up to {:.1} rad, and {} may reach {most:.1} rad", sines.range, joint.name),
            "write \"libm\", or correct the motion or the limits",
        );
    }
}

fn domain(spec: &Spec, arm: &Arm) -> Result<Domain, Error> {
    Ok(match (&spec.measure, &spec.motion) {
        (Some(MeasureSpec::Workspace), _) | (None, None) => Domain::Workspace(arm.joint_box()),
        (Some(MeasureSpec::Trajectory), _) => Domain::Trajectory,
        (Some(MeasureSpec::Tube { position_error }), _) => {
            Domain::Tube(checked("measure.tube.position_error", vector(position_error, arm.dof()))?)
        }
        (None, Some(_)) => Domain::Tube(vec![DEFAULT_TUBE; arm.dof()]),
    })
}
