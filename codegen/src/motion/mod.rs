//! Desired motions: q_d(t), q̇_d(t), q̈_d(t).

mod csv;
mod enclosure;
mod limits;
mod span;
mod spline;
mod ticks;

use gramforge_runtime::reference::{Sinusoid, cubic, quintic, sinusoids};

use crate::error::Diagnostics;
use crate::load::Loaded;
use crate::spec::MotionSpec;

pub use enclosure::PositionRange;
pub use limits::check_limits;
pub use span::Span;
pub use spline::Spline;
pub(crate) use ticks::{Piece, ReferenceError, Term, Ticks};

/// Longest motion, s: four months.
pub(crate) const LONGEST: f64 = 1e7;

/// A desired motion of n joints, evaluated by the very functions that run on the device.
///
/// Holds: the duration is positive; every number is finite; all joints are there.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Quintic polynomial, at rest at both ends.
    Quintic {
        /// Start, rad or m.
        from: Vec<f64>,
        /// End, rad or m.
        to: Vec<f64>,
        /// Duration, s.
        duration: f64,
    },
    /// C2 cubic spline.
    Spline(Spline),
    /// Sums of sinusoids.
    Sinusoids {
        /// Offset of each joint, rad or m.
        offset: Vec<f64>,
        /// The sinusoids of each joint.
        terms: Vec<Vec<Sinusoid<f64>>>,
        /// Duration, s.
        duration: f64,
    },
}

/// Where the arm should be at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// q_d, rad or m.
    pub q: Vec<f64>,
    /// q̇_d, rad/s or m/s.
    pub qd: Vec<f64>,
    /// q̈_d, rad/s² or m/s².
    pub qdd: Vec<f64>,
}

impl Motion {
    /// The motion that `spec` describes; `loaded` holds the CSV file that it may name.
    /// `None` after at least one fault was added.
    pub fn from_spec(
        spec: &MotionSpec,
        dof: usize,
        loaded: &Loaded,
        faults: &mut Diagnostics,
    ) -> Option<Self> {
        match spec {
            MotionSpec::Quintic { from, to, duration } => {
                Some(Self::Quintic { from: from.clone(), to: to.clone(), duration: *duration })
            }
            MotionSpec::Waypoints { times, positions } => {
                let at_rest = vec![0.0; dof];
                Some(Self::Spline(Spline::through(times, positions, &at_rest, &at_rest)))
            }
            MotionSpec::Sinusoids { offset, terms, duration } => {
                let convert = |s: &crate::spec::SinusoidSpec| Sinusoid {
                    amplitude: s.amplitude,
                    frequency: s.frequency,
                    phase: s.phase,
                };
                let terms = terms.iter().map(|joint| joint.iter().map(convert).collect()).collect();
                Some(Self::Sinusoids { offset: offset.clone(), terms, duration: *duration })
            }
            MotionSpec::Csv { file } => {
                csv::read(&loaded.named("motion.csv.file", file), dof, faults).map(Self::Spline)
            }
        }
    }

    /// Duration t_f, s.
    pub fn duration(&self) -> f64 {
        match self {
            Self::Quintic { duration, .. } | Self::Sinusoids { duration, .. } => *duration,
            Self::Spline(spline) => spline.duration(),
        }
    }

    /// A bound on |q̇_d| by joint that no instant exceeds, rad/s or m/s.
    pub fn largest_speed(&self) -> Vec<f64> {
        self.position_bound().speed
    }

    /// A bound on |q̈_d| by joint that no instant exceeds, rad/s² or m/s².
    pub fn largest_acceleration(&self) -> Vec<f64> {
        self.acceleration_within(0.0, self.duration())
    }

    /// Whether the motion is at rest at its end, and stays so: what its speed rounds by counts for nothing.
    pub fn rests(&self) -> bool {
        let end = self.at(self.duration());
        let slow = |qd: &f64| qd.abs() * self.duration() <= 1e-9;
        !matches!(self, Self::Sinusoids { .. }) && end.qd.iter().all(slow)
    }

    /// Number of joints.
    pub fn dof(&self) -> usize {
        match self {
            Self::Quintic { from, .. } => from.len(),
            Self::Sinusoids { offset, .. } => offset.len(),
            Self::Spline(spline) => spline.dof(),
        }
    }

    /// The target at time `t`, s, held to [0, t_f].
    pub fn at(&self, t: f64) -> Target {
        let t = t.clamp(0.0, self.duration());
        let joints: Vec<(f64, f64, f64)> = match self {
            Self::Quintic { from, to, duration } => {
                from.iter().zip(to).map(|(&from, &to)| quintic(from, to, *duration, t)).collect()
            }
            Self::Sinusoids { offset, terms, .. } => {
                offset.iter().zip(terms).map(|(&offset, terms)| sinusoids(offset, terms, t)).collect()
            }
            Self::Spline(spline) => {
                let (dt, coefficients) = spline.piece(t);
                coefficients.iter().map(|c| cubic(c, dt)).collect()
            }
        };
        Target {
            q: joints.iter().map(|j| j.0).collect(),
            qd: joints.iter().map(|j| j.1).collect(),
            qdd: joints.iter().map(|j| j.2).collect(),
        }
    }
}
