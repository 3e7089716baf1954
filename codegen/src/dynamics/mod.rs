//! Rigid-body dynamics by one recursion: in f64 it is the oracle, over graph nodes it becomes code.

mod model;
mod recursion;
mod scalar;

pub(crate) use model::positions;
pub use model::{coriolis, energy, gravity, inverse_dynamics, mass_matrix};
pub use recursion::{Position, passivity_torque};
pub use scalar::Scalar;
