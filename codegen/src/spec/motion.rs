//! The desired motion.

use serde::{Deserialize, Serialize};

/// The desired motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum MotionSpec {
    /// Quintic polynomial, at rest at both ends.
    Quintic {
        /// Start, rad or m for each joint.
        from: Vec<f64>,
        /// End, rad or m for each joint.
        to: Vec<f64>,
        /// Duration, s.
        duration: f64,
    },
    /// C2 cubic spline through waypoints, at rest at both ends.
    Waypoints {
        /// Times of the waypoints, s, increasing, the first 0.
        times: Vec<f64>,
        /// One position vector a waypoint.
        positions: Vec<Vec<f64>>,
    },
    /// A sum of sinusoids for each joint: q_i = offset_i + Σ_k amplitude_ik sin(ω_ik t + phase_ik).
    Sinusoids {
        /// Offset of each joint, rad or m.
        offset: Vec<f64>,
        /// The sinusoids of each joint.
        terms: Vec<Vec<SinusoidSpec>>,
        /// Duration, s.
        duration: f64,
    },
    /// A table of times and positions, `t,q1,…,qn`, joined by a C2 spline.
    Csv {
        /// Path relative to the specification.
        file: String,
    },
}

/// One sinusoid of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SinusoidSpec {
    /// Amplitude, rad or m.
    pub amplitude: f64,
    /// Angular frequency ω, rad/s.
    pub frequency: f64,
    /// Phase at t = 0, rad.
    #[serde(default)]
    pub phase: f64,
}
