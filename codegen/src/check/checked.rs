//! What a specification comes to once every value is checked.

use std::sync::Arc;

use super::Tuning;
use crate::arm::{Arm, Built};
use crate::domain::{DEFAULT_TUBE, Domain};
use crate::load::Loaded;
use crate::motion::Motion;
use crate::spec::{
    AdaptationSpec, ControlSpec, CoriolisTermSpec, DesignSpec, GuaranteeSpec, LawSpec, MeasureSpec,
    OnFaultSpec, RobustGainSpec, Spec,
};

/// A specification that passed every check that needs no dynamics.
///
/// Holds: every vector and matrix has the arm's size, every named file has been read, and the motion keeps to the joints'
/// limits. Later stages read no number of [`Spec`] again.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The specification and its files.
    pub loaded: Loaded,
    /// Its arm and the warnings about it.
    pub built: Built,
    /// The desired motion.
    pub motion: Option<Arc<Motion>>,
    /// Where the model must be good.
    pub domain: Domain,
    /// The controller; `None` where there is none, or where only the model was asked for.
    pub control: Option<Control>,
}

/// The controller that a specification describes, in vectors and matrices of the arm's size.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Which law.
    pub law: LawSpec,
    /// Period, gains and boundary layer.
    pub gains: GainSource,
    /// The variant of (34).
    pub coriolis_term: CoriolisTermSpec,
    /// What a robust law switches with; `Auto` only where there is a choice.
    pub robust_gain: RobustGainSpec,
    /// ΔC1 of equation (34), n×n, N·m·s/rad; `None` for k*·I.
    pub delta_c1: Option<Vec<Vec<f64>>>,
    /// Largest initial errors.
    pub initial_error: InitialError,
    /// How law `adaptive` learns.
    pub adaptation: AdaptationSpec,
    /// Take a period longer than the sampled loop admits.
    pub allow_long_period: bool,
    /// The guarantee that must hold; `None` where none must.
    pub require_guarantee: Option<GuaranteeSpec>,
    /// Time from which errors count as settled, s; `None` for a multiple of the slowest error's time constant.
    pub settle: Option<f64>,
    /// Add the Coulomb friction of the desired direction to the command.
    pub compensate_coulomb: bool,
    /// What the controller commands when a measurement is not finite.
    pub on_fault: OnFaultSpec,
}

/// Where the gains come from.
#[derive(Clone, Debug, PartialEq)]
pub enum GainSource {
    /// The specification gives them.
    Given(Tuning),
    /// The specification says what they must achieve.
    Requested(GainRequest),
}

/// What the gains must achieve.
#[derive(Clone, Debug, PartialEq)]
pub struct GainRequest {
    /// Time in which position errors fall to 1/20 of the largest initial one, s.
    pub convergence_time: f64,
    /// What |q_e| must never leave by joint, rad or m; `None` for the tube of the measure.
    pub tube: Option<Vec<f64>>,
    /// Control period, s; `None` for the longest that is enough.
    pub period: Option<f64>,
}

/// Largest initial errors by joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialError {
    /// Of position, rad or m.
    pub position: Vec<f64>,
    /// Of velocity, rad/s or m/s.
    pub velocity: Vec<f64>,
}

impl Control {
    /// The controller for `n` joints, along a motion or without one; `None` where a number is missing or a list has the wrong length.
    pub(super) fn new(spec: &ControlSpec, n: usize, motion: bool) -> Option<Self> {
        Some(Self {
            law: spec.law,
            gains: match &spec.design {
                Some(request) => GainSource::Requested(GainRequest::new(request, n)?),
                None => GainSource::Given(Tuning::given(spec, n)?),
            },
            coriolis_term: spec.coriolis_term,
            robust_gain: robust_gain(spec),
            delta_c1: spec.delta_c1.as_ref().map_or(Some(None), |m| m.by_rows(n).map(Some))?,
            initial_error: InitialError {
                position: spec.initial_error.position.by_joint(n)?,
                velocity: spec.initial_error.velocity.by_joint(n)?,
            },
            adaptation: spec.adaptation.clone().unwrap_or_default(),
            allow_long_period: spec.allow_long_period,
            require_guarantee: spec.require_guarantee.wanted(motion),
            settle: spec.settle,
            compensate_coulomb: spec.compensate_coulomb,
            on_fault: spec.on_fault,
        })
    }
}

/// Without a choice it is the law's own: no bracket to replace, or one that the specification gives numbers for.
fn robust_gain(spec: &ControlSpec) -> RobustGainSpec {
    let own = spec.delta_c1.is_some() || spec.coriolis_term != CoriolisTermSpec::Matrix;
    match spec.robust_gain {
        RobustGainSpec::Auto if own || !spec.law.has_choice() => RobustGainSpec::State,
        asked => asked,
    }
}

impl GainRequest {
    fn new(spec: &DesignSpec, n: usize) -> Option<Self> {
        let tube = spec.tube.as_ref().map_or(Some(None), |tube| tube.by_joint(n).map(Some))?;
        Some(Self { convergence_time: spec.convergence_time, tube, period: spec.period })
    }
}

/// The domain that `spec` names; `None` where it needs a motion and there is none, or a list has the wrong length.
pub(super) fn domain(spec: &Spec, arm: &Arm, motion: Option<&Arc<Motion>>) -> Option<Domain> {
    let motion = motion.cloned();
    match &spec.measure {
        Some(MeasureSpec::Workspace) => Some(Domain::Workspace(arm.joint_box())),
        Some(MeasureSpec::Trajectory) => motion.map(Domain::Path),
        Some(MeasureSpec::Tube { position_error }) => {
            Some(Domain::Tube(motion?, position_error.by_joint(arm.dof())?))
        }
        None => motion.map(|motion| Domain::Tube(motion, vec![DEFAULT_TUBE; arm.dof()])),
    }
}
