//! Everything that follows from one specification.

use std::path::Path;

use super::Means;
use super::certified::Proved;
use super::designed::Designed;
use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, Certificate, Effort, Met, Torque};
use crate::cache::Cache;
use crate::check::{Checked, Control, Extent, read};
use crate::control::{Design, StepGraph, StepRounding};
use crate::domain::Domain;
use crate::error::Error;
use crate::graph::Graph;
use crate::guarantee::Statement;
use crate::lagrangian::Lagrangian;
use crate::load::Loaded;
use crate::model::Model;
use crate::motion::Motion;
use crate::progress::{Progress, Silent, Stage};
use crate::reduction::{Reduced, Regression};
use crate::spec::Spec;
use crate::torque::{Form, Regressor};

/// Everything that follows from one specification; read-only.
///
/// Holds: D(q) of a controlled arm was positive definite at every state that was checked; the motion keeps the joints'
/// limits; no state of the domain exceeds a bound.
#[derive(Clone, Debug)]
pub struct Generation {
    pub(super) designed: Designed,
    met: Option<Met>,
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

    /// The same, with reports to `progress`.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn with_progress(loaded: Loaded, effort: &Effort, progress: &dyn Progress) -> Result<Self, Error> {
        super::run(loaded, Extent::Whole, Means { effort, progress, cache: None, judges: true })
    }

    /// The same with stages that an earlier run of the same program has kept in `cache`.
    pub(crate) fn cached(
        loaded: Loaded,
        effort: &Effort,
        progress: &dyn Progress,
        cache: Option<&Cache>,
    ) -> Result<Self, Error> {
        super::run(loaded, Extent::Whole, Means { effort, progress, cache, judges: true })
    }

    /// The model alone: as [`Generation::with_progress`], but without gains, guarantee and the check
    /// that D can be inverted; [`Generation::design`] is `None`.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn model_only(loaded: Loaded, effort: &Effort, progress: &dyn Progress) -> Result<Self, Error> {
        super::run(loaded, Extent::Model, Means { effort, progress, cache: None, judges: true })
    }

    /// All but what is promised of the sampled loop along a motion, which takes seconds: as [`Generation::with_progress`], but
    /// [`Generation::statement`] is `None` there, and the module lacks `GUARANTEE` and `PERIOD_MAX`. Where the switching gain is
    /// `auto`, the cheaper step is taken; a request for gains is answered by a level of V alone, and a guarantee that is
    /// required is not looked at.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn unjudged(loaded: Loaded, effort: &Effort, progress: &dyn Progress) -> Result<Self, Error> {
        super::run(loaded, Extent::Unjudged, Means { effort, progress, cache: None, judges: false })
    }

    /// The last stage: what the model's error costs in torque at the rates that the law meets.
    pub(super) fn concluded(mut designed: Designed, means: Means) -> Self {
        designed.state(means);
        let _stage = Stage::new(means.progress, "torque error of the law", 1);
        let certified = &designed.certified;
        let rates = designed.design.as_ref().and_then(|design| design.rates.as_ref());
        let met = rates.map(|rates| certified.error().met(certified.torque_error(rates, None), rates));
        Self { designed, met }
    }

    /// The controller with these gains and a constant robust gain, or the law's own bracket.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no controller, or where it is refused with that robust gain.
    #[cfg(any(feature = "simulate", test))]
    pub(crate) fn design_with(&self, constant: bool) -> Result<Design, Error> {
        self.designed.with_other_gain(constant)
    }

    pub(super) fn checked(&self) -> &Checked {
        &self.designed.certified.checked
    }

    pub(super) fn proved(&self) -> &Proved {
        &self.designed.certified.proved
    }
}

/// The results of the stages.
impl Generation {
    /// The specification.
    pub fn spec(&self) -> &Spec {
        &self.checked().loaded.spec
    }

    /// The specification as it was read, with the files that it names.
    #[cfg(feature = "cli")]
    pub(crate) fn loaded(&self) -> &Loaded {
        &self.checked().loaded
    }

    /// The file that the specification was read from.
    pub fn path(&self) -> &Path {
        &self.checked().loaded.path
    }

    /// The arm that every model here is made for: its rotations are rounded as `arm.round_angles` says.
    pub fn arm(&self) -> &Arm {
        &self.checked().built.arm
    }

    /// The arm as the specification gives it.
    pub fn given(&self) -> &Arm {
        &self.checked().built.given
    }

    /// All arms for which the controller must work.
    pub fn uncertainty(&self) -> &Uncertainty {
        &self.checked().built.uncertainty
    }

    /// The same about the arm as the specification gives it.
    pub fn given_uncertainty(&self) -> &Uncertainty {
        &self.checked().built.uncertain
    }

    /// Where the model must be accurate.
    pub fn domain(&self) -> &Domain {
        &self.checked().domain
    }

    /// The exact model.
    pub fn lagrangian(&self) -> &Lagrangian {
        &self.proved().lagrangian
    }

    /// The emitted model with its code.
    pub fn model(&self) -> &Model {
        &self.proved().model
    }

    /// The coefficients of the emitted model.
    pub fn reduced(&self) -> &Reduced {
        &self.model().reduced
    }

    /// The emitted passivity torque.
    pub fn code(&self) -> &Graph {
        &self.model().code
    }

    /// The cheapest exact passivity torque.
    pub fn exact_code(&self) -> &Graph {
        &self.proved().exact
    }

    /// Bounds on what the model leaves out over the domain, rounded up to the printed digits.
    pub fn bounds(&self) -> &Bounds {
        &self.proved().bounds
    }

    /// How the emitted code computes the torque.
    pub fn form(&self) -> Form {
        self.model().form
    }

    /// Warnings: what is unusual about the specification, but not wrong.
    pub fn warnings(&self) -> &[String] {
        &self.proved().warnings
    }

    /// A certificate for each coefficient of [`Generation::lagrangian`].
    pub fn certificates(&self) -> &[Certificate] {
        &self.proved().certificates
    }

    /// The desired motion; `None` where there is none.
    pub fn motion(&self) -> Option<&Motion> {
        self.checked().motion.as_deref()
    }

    /// The controller that the specification asks for; `None` where there is none, or where only the model was asked for.
    pub fn control(&self) -> Option<&Control> {
        self.checked().control.as_ref()
    }

    /// What the model's error costs in torque; `None` over a workspace where a joint lacks a limit.
    pub fn torque(&self) -> Option<&Torque> {
        self.proved().torque.as_ref()
    }

    /// The same at the rates that the law meets; `None` without a controller, or where no level of V holds the errors.
    pub fn met(&self) -> Option<&Met> {
        self.met.as_ref()
    }

    /// The controller; `None` where there is none, or where only the model was asked for.
    pub fn design(&self) -> Option<&Design> {
        self.designed.design.as_ref()
    }

    /// What is promised of the controller; `None` without one.
    pub fn statement(&self) -> Option<&Statement> {
        self.designed.statement.as_ref()
    }

    /// The controller's step, law and model as one graph; `None` without a controller.
    pub fn step(&self) -> Option<&StepGraph> {
        self.designed.step.as_ref()
    }

    /// What the step rounds by in its number type; `None` without a controller.
    pub fn rounding(&self) -> Option<&StepRounding> {
        self.designed.rounding.as_ref()
    }

    /// The step of the same law about the exact model; `None` without a controller, or for a law that learns.
    pub fn exact_step(&self) -> Option<&StepGraph> {
        self.designed.exact_step.as_ref()
    }

    /// The parameters of a law that learns; `None` for the other laws.
    pub fn regression(&self) -> Option<&Regression> {
        self.proved().regression.as_ref()
    }

    /// The torque as a function of them; `None` for the other laws.
    pub fn regressor(&self) -> Option<&Regressor> {
        self.proved().regressor.as_ref()
    }
}
