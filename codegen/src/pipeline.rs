//! All stages in order: from a checked specification to a model, its bounds, its controller and its code.

mod angles;
mod left;
mod model;
mod threads;
mod verdict;

use std::path::Path;

use crate::arm::{Arm, Built, JointKind, Uncertainty, indefinite, indefinite_among};
use crate::body::{self, Form, Regressor};
use crate::bounds::{Bounds, Certificate, Effort, Met, Torque, reach, rounded_angles};
use crate::check::{examine, model, read, vector};
use crate::design::{Design, Problem, checked, design};
use crate::dynamics::mass_matrix;
use crate::emit::{Module, emit};
use crate::error::{Error, Faults};
use crate::graph::Graph;
use crate::lagrangian::{Lagrangian, expand_family};
use crate::load::{Loaded, spec_hash};
use crate::measure::{Domain, Measure};
use crate::motion::Motion;
use crate::progress::{Progress, Silent, Stage};
use crate::reduction::{self, Reduced, Regression};
use crate::sines::Sines;
use crate::spec::{LawSpec, MeasureSpec, RefitSpec, Spec};
use crate::tolerance::Scale;
use left::Left;
#[cfg(feature = "cli")]
pub(crate) use model::dictionary;
use model::{Ask, Model, check_count};

/// Half-width of the tube where the specification names no measure, rad or m.
pub(crate) const DEFAULT_TUBE: f64 = 0.05;

/// Positions of the domain at which D is looked at.
const POSITIONS: usize = 512;

/// The same for each vertex of the uncertain parameters' box.
const VERTEX_POSITIONS: usize = 64;

/// Pieces of a motion from which on the module's size is told, and what one of one joint adds to its text, bytes.
const LONG_MOTION: usize = 2_000;
const BYTES_A_PIECE: usize = 80;

/// Everything that follows from one specification.
///
/// Holds: the arm's D(q) was positive definite wherever it was looked at; the motion keeps to the joints'
/// limits; ξ ≤ p.
#[derive(Clone, Debug)]
pub struct Generation {
    /// The specification.
    pub loaded: Loaded,
    /// The arm that every model here is made for: its rotations are rounded as `arm.round_angles` says.
    pub arm: Arm,
    /// The arm as the specification gives it.
    pub given: Arm,
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
    /// What it costs at the rates that the law meets; `None` without a controller, or where no level of V holds the errors.
    pub met: Option<Met>,
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
        Self::new(read(path)?)
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
        Self::with_progress(loaded, effort, &Silent)
    }

    /// The same, telling `progress` how far it is.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn with_progress(loaded: Loaded, effort: &Effort, progress: &dyn Progress) -> Result<Self, Error> {
        Self::staged(loaded, effort, progress, true)
    }

    /// The model alone: as [`Generation::with_progress`], but gains, guarantee and whether D can be inverted are not
    /// looked at, and [`Generation::design`] is `None`.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn model(loaded: Loaded, effort: &Effort, progress: &dyn Progress) -> Result<Self, Error> {
        Self::staged(loaded, effort, progress, false)
    }

    fn staged(loaded: Loaded, effort: &Effort, progress: &dyn Progress, looped: bool) -> Result<Self, Error> {
        threads::check()?;
        let mut faults = Faults::of(&loaded.path);
        let (built, motion) =
            if looped { examine(&loaded, &mut faults) } else { model(&loaded, &mut faults) };
        let Some(Built { arm, uncertainty, given, uncertain, mut warnings }) = built else {
            return Err(faults.into_error());
        };
        let spec = &loaded.spec;
        let control = spec.control.as_ref().filter(|_| looped);
        // A motion's domain is looked at below, where its points are known; the joints' limits may reach far beyond it.
        if control.is_some()
            && is_workspace(spec)
            && let Some(state) = indefinite(&arm, |q| mass_matrix(&arm, q))
        {
            state.report(&arm, &mut faults);
            return Err(faults.into_error());
        }
        warnings.extend(motion.as_ref().and_then(|motion| long(&loaded, motion)));
        let stage = Stage::new(progress, "expansion", 1);
        let lagrangian = expand_family(&arm, &uncertainty);
        drop(stage);
        check_count(spec, &lagrangian, &mut faults);
        if !faults.is_empty() {
            return Err(faults.into_error());
        }

        let domain = domain(spec, &arm)?;
        let sines = Sines::new(&spec.emit.trig);
        check_angles(&sines, &reach(&domain, motion.as_ref()), &arm, &mut faults);
        faults.finish(())?;
        let stage = Stage::new(progress, "measure", 1);
        let measure = Measure::new(&domain, motion.as_ref(), &arm);
        let refused = |report: &dyn Fn(&mut Faults)| {
            let mut faults = Faults::of(&loaded.path);
            report(&mut faults);
            Err(faults.into_error())
        };
        // The domain may hold states that the look at the limits has missed, such as a wrist stretched out.
        let seen = |most: usize| {
            let stride = measure.points.len().div_ceil(most).max(1);
            measure.points.iter().step_by(stride).filter(|_| control.is_some())
        };
        if let Some(state) = indefinite_among(seen(POSITIONS), |q| mass_matrix(&arm, q)) {
            return refused(&|faults| state.report(&arm, faults));
        }
        for u in uncertainty.vertices() {
            let member = uncertainty.at(&arm, &u);
            if let Some(state) = indefinite_among(seen(VERTEX_POSITIONS), |q| mass_matrix(&member, q)) {
                return refused(&|faults| state.report_member(&uncertainty, &u, faults));
            }
        }
        drop(stage);
        let learns = spec.control.as_ref().filter(|control| control.law == LawSpec::Adaptive);
        let stage = Stage::new(progress, "reduction", 1);
        let points = match spec.refit {
            RefitSpec::Minimax => reduction::extremes(&measure, &domain, motion.as_ref()),
            RefitSpec::LeastSquares => measure.points.clone(),
        };
        let turn = domain.within_a_turn(&arm, 1.0);
        let reach = reach(&turn, motion.as_ref());
        let angles = rounded_angles((&arm, &uncertainty), (&given, &uncertain), &reach);
        let scale = Scale::new(&arm, &domain, motion.as_ref())
            .map(|scale| scale.reserving((&arm, &lagrangian), &reach, angles.as_ref(), &sines));
        let exact = {
            let _stage = Stage::new(progress, "exact code", 1);
            body::exact(&arm, &lagrangian)
        };
        warnings.extend(angles::advice(&loaded, &arm, &given, &exact.1));
        let Model { reduced, form, mut code } = {
            let ask = Ask {
                spec,
                arm: &arm,
                lagrangian: &lagrangian,
                domain: &domain,
                motion: motion.as_ref(),
                measure: &measure,
                points: &points,
                progress,
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
        drop(stage);
        if form == Form::Recursive && !sines.rounds() {
            // What coarse sines do is known of the plain recursion alone.
            code = body::plain(&arm);
        }
        let left = Left {
            loaded: &loaded,
            arm: &arm,
            uncertainty: &uncertainty,
            lagrangian: &lagrangian,
            reduced: &reduced,
            domain: &turn,
            motion: motion.as_ref(),
            form,
            sines: &sines,
            angles: angles.as_ref(),
        };
        let (certificates, mut bounds) = left.bounds(effort, progress);
        let stage = Stage::new(progress, "torque error", 1);
        let torque = scale.map(|scale| left.torque(&certificates, &bounds, scale));
        drop(stage);
        warnings.extend(torque.as_ref().and_then(|torque| left.beyond_tolerance(torque)));
        if !uncertainty.viscous.is_empty() {
            bounds.b.clone_from(&uncertainty.viscous);
        }
        let bounds = bounds.rounded_up();
        let mut regressor =
            regression.as_ref().map(|regression| body::regressor(&arm, &lagrangian, regression, form));
        if let Some(regressor) = &mut regressor {
            regressor.code.sines = sines.clone();
        }
        code.sines = sines.clone();
        if !(reduced.is_finite() && bounds.is_finite()) {
            let mend = "write positions, speeds and the measure in SI units";
            return refused(&|faults| {
                faults.push("measure", "reaches states at which the model overflows", mend)
            });
        }
        let design = control
            .map(|control| {
                design(&Problem {
                    file: &loaded.path,
                    control,
                    arm: &arm,
                    given: (&given, &uncertain),
                    angles: angles.as_ref(),
                    lagrangian: &lagrangian,
                    bounds: &bounds,
                    domain: &domain,
                    motion: motion.as_ref(),
                    uncertainty: &uncertainty,
                    regression: regression.as_ref(),
                    seek_tube: effort.seek_tube,
                    progress,
                })
            })
            .transpose()?;
        if design.as_ref().is_some_and(|design| !design.is_finite()) {
            let problem = "gives gains or bounds on the errors that overflow";
            let mend = "write gains and initial errors in SI units";
            return refused(&|faults| faults.push("control", problem, mend));
        }
        let met = {
            let _stage = Stage::new(progress, "torque error of the law", 1);
            let rates = design.as_ref().and_then(|design| design.rates.as_ref());
            rates.map(|rates| left.met(&certificates, &bounds, rates))
        };
        Ok(Self {
            met,
            arm,
            given,
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
            turned: self.arm != self.given,
            uncertainty: &self.uncertainty,
            lagrangian: &self.lagrangian,
            reduced: &self.reduced,
            bounds: &self.bounds,
            torque: self.torque.as_ref(),
            met: self.met.as_ref(),
            verdict: &self.verdict(),
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

/// What is said of a motion of many pieces: all of them stand in the module.
fn long(loaded: &Loaded, motion: &Motion) -> Option<String> {
    let pieces = match motion {
        Motion::Spline(spline) => spline.pieces.len(),
        Motion::Quintic { .. } | Motion::Sinusoids { .. } => 0,
    };
    (pieces > LONG_MOTION).then(|| {
        let size = pieces * motion.dof() * BYTES_A_PIECE / 1_000_000;
        format!(
            "{}: motion: has {pieces} pieces, which make the module about {size} MB long; fewer rows give a smaller one",
            loaded.path.display()
        )
    })
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

fn is_workspace(spec: &Spec) -> bool {
    matches!((&spec.measure, &spec.motion), (Some(MeasureSpec::Workspace), _) | (None, None))
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
