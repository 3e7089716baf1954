//! Rigid-body dynamics by one plain recursion: the oracle for everything that is faster.

mod jet;
mod model;
mod norms;
mod recursion;
mod running;
mod scalar;

pub use jet::{Jet, enclosed_positions};
pub(crate) use model::positions;
pub use model::{coriolis, energy, gravity, inverse_dynamics, mass_matrix};
pub use norms::{Size, Sizes};
pub use recursion::{Position, inertia, passivity_torque};
pub use running::rounding;
pub use scalar::{Angle, Scalar};
