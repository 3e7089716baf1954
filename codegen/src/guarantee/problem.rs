//! The sampled loop whose errors are followed.

use super::repetition::Repetition;
use crate::arm::{Arm, Uncertainty};
use crate::bounds::Bounds;
use crate::control::{Design, Gains, RobustGain};
use crate::motion::Motion;
use crate::numerics::linalg::weighed;
use crate::spec::{CoriolisTermSpec, LawSpec};

/// One uncertain number of inertia: u = middle ± half.
#[derive(Clone, Debug)]
pub(super) struct Number {
    /// The arm whose model is what u = 1 adds.
    pub(super) arm: Arm,
    pub(super) middle: f64,
    pub(super) half: f64,
}

/// A loop along a motion.
#[derive(Clone, Debug)]
pub(super) struct Problem<'a> {
    /// The arm as specified.
    pub(super) arm: &'a Arm,
    pub(super) numbers: Vec<Number>,
    /// Bound on what viscous friction differs from the arm's by, by joint, N·m·s/rad.
    pub(super) viscous: Vec<f64>,
    pub(super) motion: &'a Motion,
    pub(super) gains: &'a Gains,
    /// K, with ΔC1 where the law has it.
    pub(super) damping: Vec<Vec<f64>>,
    pub(super) switching: Switching<'a>,
    /// Coulomb friction that the command compensates, forwards and backwards.
    pub(super) compensated: &'a [[f64; 2]],
    pub(super) period: f64,
    /// Whether and how the motion repeats itself.
    pub(super) repetition: Option<Repetition>,
    /// Half the sides of the box of the initial errors of position and of speed.
    pub(super) initial: [&'a [f64]; 2],
    /// Half the width of the domain around the motion.
    pub(super) tube: Vec<f64>,
}

/// What an emitted step is wrong by, by joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrong {
    /// Its torque, rounding included, N·m or N, against the arm as specified, u = 0.
    pub torque: Vec<f64>,
    /// s where it takes the side of it, rad/s or m/s.
    pub s: Vec<f64>,
}

/// What a robust law subtracts: ρ times the side of s.
#[derive(Clone, Copy, Debug)]
pub(super) enum Switching<'a> {
    None,
    /// With this gain, and the boundary layer or the sign function.
    Robust(Gain<'a>, Option<&'a [f64]>),
}

/// A switching gain.
#[derive(Clone, Copy, Debug)]
pub(super) enum Gain<'a> {
    /// One number by joint.
    Constant(&'a [f64]),
    /// The law's own bracket.
    State { design: &'a Design, bounds: &'a Bounds },
}

/// Magnitudes that a switching gain is computed from, by joint.
pub(super) struct Magnitudes {
    pub(super) speed: Vec<f64>,
    pub(super) reference_speed: Vec<f64>,
    pub(super) desired_acceleration: Vec<f64>,
    pub(super) reference_acceleration: Vec<f64>,
    pub(super) velocity_error: Vec<f64>,
    pub(super) s: Vec<f64>,
}

impl Problem<'_> {
    /// By how much a sinusoid of a repetition may be early or late, s.
    pub(super) fn slack(&self) -> f64 {
        self.repetition.as_ref().map_or(0.0, |repetition| repetition.slack)
    }
}

impl Number {
    /// max |u|.
    pub(super) fn most(&self) -> f64 {
        self.middle.abs() + self.half
    }
}

impl<'a> Switching<'a> {
    pub(super) fn of(design: &'a Design, bounds: &'a Bounds) -> Self {
        if !design.law.is_robust() {
            return Self::None;
        }
        let gain = match &design.robust_gain {
            RobustGain::Constant(gain) => Gain::Constant(gain),
            RobustGain::State => Gain::State { design, bounds },
        };
        Self::Robust(gain, design.boundary_layer.as_deref())
    }
}

impl Gain<'_> {
    /// ρ by joint, N·m or N: it grows with each magnitude.
    pub(super) fn at(&self, x: &Magnitudes) -> Vec<f64> {
        let (design, bounds) = match self {
            Self::Constant(gain) => return gain.to_vec(),
            Self::State { design, bounds } => (design, bounds),
        };
        let n = x.s.len();
        let friction = |i: usize| bounds.b[i] * x.speed[i] + bounds.g[i] + design.disturbance[i];
        let tight = |i: usize| {
            let coriolis: f64 =
                (0..n).map(|j| weighed(&bounds.h[i][j], &x.speed) * x.reference_speed[j]).sum();
            weighed(&bounds.d[i], &x.reference_acceleration) + coriolis + friction(i)
        };
        let bracket = |i: usize| {
            let acceleration: Vec<f64> = (0..n)
                .map(|j| x.desired_acceleration[j] + weighed(&design.gains.p12[j], &x.velocity_error))
                .collect();
            let switching = design.coriolis_term == CoriolisTermSpec::Switching;
            let more = if switching { weighed(&design.delta_c[i], &x.s) } else { 0.0 };
            weighed(&bounds.d[i], &acceleration) + weighed(&design.delta_c[i], &x.speed) + more + friction(i)
        };
        (0..n).map(|i| if design.law == LawSpec::Tight { tight(i) } else { bracket(i) }).collect()
    }
}

/// The uncertain numbers of a family around `arm`.
pub(super) fn numbers(arm: &Arm, uncertainty: &Uncertainty) -> Vec<Number> {
    let number = |(k, parameter): (usize, &crate::arm::Parameter)| Number {
        arm: uncertainty.alone(arm, k),
        middle: 0.5 * (parameter.low + parameter.high),
        half: 0.5 * (parameter.high - parameter.low) * (1.0 + 1e-12),
    };
    uncertainty.parameters.iter().enumerate().map(number).collect()
}
