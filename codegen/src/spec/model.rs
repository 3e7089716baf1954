//! Where the reduction is judged, what it keeps, and how that is fitted.

use serde::{Deserialize, Serialize};

use super::VectorSpec;

/// Where the reduction is judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum MeasureSpec {
    /// Along the desired trajectory.
    Trajectory,
    /// Along the desired trajectory and over a box of position errors around it.
    Tube {
        /// Half-width ε of the box, rad or m.
        position_error: VectorSpec,
    },
    /// Over the joint limits; needs position, velocity and acceleration limits of every joint.
    Workspace,
}

/// Form of the generated model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ModelSpec {
    /// The cheapest model whose certified torque error stays below 1 % of each joint's peak torque.
    #[default]
    Auto,
    /// No reduction: zero bounds.
    Exact,
    /// The same ψ functions for all simplified coefficients.
    Shared {
        /// Number ξ of kept functions, 1 to p.
        functions: usize,
    },
    /// Every simplified coefficient has ψ functions of its own.
    Separate {
        /// Number ξ of functions that a coefficient keeps, 1 to p.
        functions: usize,
    },
    /// The model with the fewest operations that is found whose certified torque error is small enough, of the arm as
    /// specified; the exact one if none is cheaper. Nothing is sought below 0.31 %, nor where the exact model has more than
    /// 4000 terms.
    Tolerance {
        /// Most torque error as a fraction of each joint's peak torque, above 0 and below 1: over a workspace of the
        /// largest torque within the joints' limits, around a motion of the largest along it.
        torque: f64,
    },
}

impl ModelSpec {
    /// The torque error that is allowed, as a fraction of each joint's peak torque.
    pub fn tolerance(&self) -> Option<f64> {
        match *self {
            ModelSpec::Auto => Some(0.01),
            ModelSpec::Tolerance { torque } => Some(torque),
            ModelSpec::Exact | ModelSpec::Shared { .. } | ModelSpec::Separate { .. } => None,
        }
    }
}

/// How the parameters of the kept functions are fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RefitSpec {
    /// Least largest residual, because the bounds (9) and (10) are maxima: the optimum of a linear programme over points of
    /// the domain and of its boundary, and never worse there than `least_squares`.
    #[default]
    Minimax,
    /// Least squares over the measure, equation (4).
    LeastSquares,
}

/// The candidate functions of the reduction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum DictionarySpec {
    /// cos(κ·q) and sin(κ·q), times powers of prismatic coordinates.
    #[default]
    Harmonic,
    /// The report's: 1, the functions in which every joint occurs once at most, and products of two of these.
    Product,
    /// Both.
    Union,
}
