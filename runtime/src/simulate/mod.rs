//! Simulation: a plant in fine Runge–Kutta steps under a torque that is held for a control period.

mod closed_loop;
mod plant;
mod runge_kutta;

pub use closed_loop::{Record, Simulation};
pub use plant::{Plant, RigidPlant};
pub use runge_kutta::{JointState, rk4_step};
