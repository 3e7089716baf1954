//! Tracking laws: from measured and desired motion to torque.
//!
//! A law's numbers are a plain struct of public fields that a `const` can hold; whatever it learns lies apart in its
//! [`Law::State`].

mod adaptive;
mod constant;
mod coriolis_term;
mod exact;
mod gains;
mod lyapunov;
mod report;
mod switching;
#[cfg(test)]
mod test_states;
mod tight;
mod tracking;

pub use adaptive::AdaptiveLaw;
pub use constant::ConstantGainLaw;
pub use coriolis_term::CoriolisTerm;
pub use exact::ExactLaw;
pub use gains::Gains;
pub use lyapunov::lyapunov;
pub use report::ReportLaw;
pub use switching::Switching;
pub use tight::TightLaw;
pub use tracking::Tracking;

use crate::reference::Desired;
use crate::vector::first_not_finite;
use crate::{ConfigError, Model, Real, Requirement};

/// What a law sees at one control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T, const N: usize> {
    /// Measured position q, rad or m.
    pub q: [T; N],
    /// Measured velocity q̇, rad/s or m/s.
    pub qd: [T; N],
    /// Desired motion.
    pub desired: Desired<T, N>,
    /// Time for which the torque will be held, s.
    pub period: T,
}

/// A tracking law for the model `M`.
///
/// The model stands among the trait's parameters so that a law may ask more of it than [`Model`] does.
pub trait Law<M: Model<N>, const N: usize> {
    /// What the law remembers from one instant to the next; `()` for a static law.
    type State: Copy;

    /// The state before the first instant.
    fn initial_state(&self) -> Self::State;

    /// The torque to hold for the coming period, N·m, not limited. The state is advanced in place; the controller
    /// throws the new one away when the torque is not finite.
    fn torque(&self, model: &M, state: &mut Self::State, sample: &Sample<M::Scalar, N>) -> [M::Scalar; N];

    /// Checks the law's numbers once, before the loop starts.
    ///
    /// # Errors
    /// Names the first parameter with which the law's convergence proof fails.
    fn check(&self) -> Result<(), ConfigError>;
}

/// A Coulomb friction torque for each direction, forwards (≥ 0) and backwards (≤ 0), N·m: the one of the direction
/// `velocity`, zero at rest.
pub(crate) fn coulomb_torque<T: Real>(levels: &[T; 2], velocity: T) -> T {
    let [forward, backward] = *levels;
    if velocity > T::ZERO {
        forward
    } else if velocity < T::ZERO {
        backward
    } else {
        T::ZERO
    }
}

pub(crate) fn check_coulomb<T: Real, const N: usize>(coulomb: &[[T; 2]; N]) -> Result<(), ConfigError> {
    let error =
        |joint, requirement| Err(ConfigError { parameter: "coulomb", joint: Some(joint), requirement });
    for (joint, [forward, backward]) in coulomb.iter().enumerate() {
        if !(*forward >= T::ZERO && forward.is_finite()) {
            return error(joint, Requirement::NonNegative);
        }
        if !(*backward <= T::ZERO && backward.is_finite()) {
            return error(joint, Requirement::NonPositive);
        }
    }
    Ok(())
}

fn check_finite<T: Real, const N: usize>(
    parameter: &'static str,
    matrix: &[[T; N]; N],
) -> Result<(), ConfigError> {
    match matrix.iter().position(|row| first_not_finite(row).is_some()) {
        None => Ok(()),
        joint => Err(ConfigError { parameter, joint, requirement: Requirement::Finite }),
    }
}

fn check_nonnegative<T: Real, const N: usize>(
    parameter: &'static str,
    matrix: &[[T; N]; N],
) -> Result<(), ConfigError> {
    match matrix.iter().position(|row| row.iter().any(|&x| !(x >= T::ZERO && x.is_finite()))) {
        None => Ok(()),
        joint => Err(ConfigError { parameter, joint, requirement: Requirement::NonNegative }),
    }
}

fn check_symmetric<T: Real, const N: usize>(
    parameter: &'static str,
    matrix: &[[T; N]; N],
) -> Result<(), ConfigError> {
    check_finite(parameter, matrix)?;
    let largest = matrix.iter().flatten().fold(T::ZERO, |max, x| if x.abs() > max { x.abs() } else { max });
    // Matrices made in f64 and rounded to f32 differ from their transposes in the last places.
    let tolerance = largest * T::from_f64(1e-5);
    for (i, row) in matrix.iter().enumerate() {
        for (x, transposed) in row.iter().zip(matrix.iter().map(|r| r[i])) {
            if (*x - transposed).abs() > tolerance {
                return Err(ConfigError { parameter, joint: Some(i), requirement: Requirement::Symmetric });
            }
        }
    }
    Ok(())
}
