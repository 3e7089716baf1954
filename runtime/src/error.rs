//! What can go wrong, as small `Copy` values.

use core::error::Error;
use core::fmt::{self, Debug, Display, Formatter};

/// A number that a controller or a simulation refuses to be built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ConfigError {
    /// Name of the parameter, as it is spelt in its struct.
    pub parameter: &'static str,
    /// The joint (row of a matrix) at fault, from 0; `None` where the parameter has one value, or as a whole is wrong.
    pub joint: Option<usize>,
    /// What the parameter must be.
    pub requirement: Requirement,
}

/// What a parameter must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Requirement {
    /// Neither infinite nor NaN.
    Finite,
    /// Greater than 0, and finite.
    Positive,
    /// Not less than 0, and finite.
    NonNegative,
    /// Not greater than 0, and finite.
    NonPositive,
    /// Equal to its transpose, up to rounding.
    Symmetric,
    /// All eigenvalues greater than 0.
    PositiveDefinite,
    /// At least one entry.
    NotEmpty,
    /// In strictly increasing order of time.
    Increasing,
    /// Between the lowest and the highest value that it may take.
    InsideBox,
}

impl Display for Requirement {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Finite => "finite",
            Self::Positive => "positive and finite",
            Self::NonNegative => "finite and not negative",
            Self::NonPositive => "finite and not positive",
            Self::Symmetric => "symmetric",
            Self::PositiveDefinite => "positive definite",
            Self::NotEmpty => "not empty",
            Self::Increasing => "in increasing order of time",
            Self::InsideBox => "inside its box",
        })
    }
}

impl Display for ConfigError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.parameter)?;
        if let Some(joint) = self.joint {
            write!(f, "[{joint}]")?;
        }
        write!(f, " must be {}", self.requirement)
    }
}

impl Error for ConfigError {}

/// A quantity of the control loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Quantity {
    /// Measured position q.
    Position,
    /// Measured velocity q̇.
    Velocity,
    /// Desired position q_d.
    DesiredPosition,
    /// Desired velocity q̇_d.
    DesiredVelocity,
    /// Desired acceleration q̈_d.
    DesiredAcceleration,
    /// The torque that the law computed.
    Torque,
}

impl Display for Quantity {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::DesiredPosition => "desired position",
            Self::DesiredVelocity => "desired velocity",
            Self::DesiredAcceleration => "desired acceleration",
            Self::Torque => "torque",
        })
    }
}

/// What is wrong with a quantity of the control loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reason {
    /// It is infinite or NaN.
    NotFinite,
    /// It is beyond the limits that the controller was generated for ([`ReferenceLimits`](crate::ReferenceLimits)): what is promised no
    /// longer holds.
    BeyondLimits,
}

impl Display for Reason {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "not finite",
            Self::BeyondLimits => "beyond its limits",
        })
    }
}

/// A control step that met a number which it cannot use, and what to command instead.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fault<T, const N: usize> {
    /// The quantity at fault; of several the first in the order of [`Quantity`].
    pub quantity: Quantity,
    /// What is wrong with it. Numbers that are not finite come first.
    pub reason: Reason,
    /// The first joint whose quantity is at fault, from 0.
    pub joint: usize,
    /// The safe command of the controller's [`OnFault`](crate::OnFault), finite and within the limits, N·m.
    pub command: [T; N],
}

impl<T, const N: usize> Display for Fault<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}] is {}", self.quantity, self.joint, self.reason)
    }
}

impl<T: Debug, const N: usize> Error for Fault<T, N> {}

/// A simulation that cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PlantError {
    /// The mass matrix is not positive definite: the plant's model is not that of an arm.
    MassMatrix,
    /// The state has overflowed: the loop is unstable, or the step too long.
    Diverged,
}

impl Display for PlantError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MassMatrix => "the mass matrix is not positive definite",
            Self::Diverged => "the simulated state is no longer finite",
        })
    }
}

impl Error for PlantError {}
