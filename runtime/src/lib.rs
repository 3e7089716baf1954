//! The `no_std` half of Gramforge: models, tracking laws, the fixed-step controller and a simulator.
//!
//! No allocation, no unsafe code, no panic on any number; `libm` for every transcendental, so that all machines agree;
//! generated models may take their sines faster, from [`trig`].
//! Everything is generic over the scalar ([`Real`]: `f64` or `f32`) and over the number of joints.
//!
//! A generated module supplies a [`Model`] and the constants. The rest of a firmware's loop is this:
//!
//! ```
//! use gramforge_runtime::law::{CoriolisTerm, Gains, ReportLaw, Switching};
//! use gramforge_runtime::reference::{QuinticReference, Reference};
//! use gramforge_runtime::{Bounds, Controller, Model, OnFault, Real, Settings};
//!
//! /// A rod on a hinge.
//! struct Pendulum;
//!
//! impl Model<1> for Pendulum {
//!     type Scalar = f64;
//!     fn passivity_torque(&self, q: &[f64; 1], _qd: &[f64; 1], _v_r: &[f64; 1], a_r: &[f64; 1]) -> [f64; 1] {
//!         [0.5 * a_r[0] + 4.0 * q[0].sin_cos().1]
//!     }
//!     fn viscous_friction(&self) -> [f64; 1] {
//!         [0.1]
//!     }
//!     fn bounds(&self) -> &Bounds<f64, 1> {
//!         const BOUNDS: Bounds<f64, 1> = Bounds { d: [[0.02]], h: [[[0.0]]], b: [0.05], g: [0.3] };
//!         &BOUNDS
//!     }
//! }
//!
//! const LAW: ReportLaw<f64, 1> = ReportLaw {
//!     gains: Gains { p12: [[4.0]], damping: [[5.1]], pqq: [[0.25]] },
//!     delta_c: [[0.0]],
//!     coriolis_term: CoriolisTerm::Matrix([[0.0]]),
//!     disturbance: [0.0],
//!     switching: Switching::BoundaryLayer([0.05]),
//!     coulomb: [[0.0, 0.0]],
//! };
//! const SETTINGS: Settings<f64, 1> =
//!     Settings { period: 0.001, torque_limit: [Some(20.0)], on_fault: OnFault::Gravity };
//! const MOTION: QuinticReference<f64, 1> = QuinticReference { from: [0.0], to: [1.2], duration: 2.0 };
//!
//! # fn read_encoders() -> ([f64; 1], [f64; 1]) { ([0.0], [0.0]) }
//! # fn drive(_torque: &[f64; 1]) {}
//! # fn wait_for_tick() {}
//! fn main() -> Result<(), gramforge_runtime::ConfigError> {
//!     let mut controller = Controller::new(Pendulum, LAW, SETTINGS)?;
//!     for tick in 0..2000 {
//!         let (q, qd) = read_encoders();
//!         let desired = MOTION.at(f64::from(tick) * SETTINGS.period);
//!         match controller.step(&q, &qd, &desired) {
//!             Ok(command) => drive(&command.torque),
//!             Err(fault) => drive(&fault.command),
//!         }
//!         wait_for_tick();
//!     }
//!     Ok(())
//! }
//! ```
//!
//! Equation numbers in parentheses are those of A. P. Bartoszewicz, *Robust Robot Control Based on Simplified Dynamic
//! Model*, TR-EE 92-21, Purdue University, 1992.
#![no_std]

#[cfg(test)]
extern crate std;

mod cholesky;
mod controller;
mod error;
mod estimate;
mod guarantee;
pub mod law;
mod model;
mod real;
pub mod reference;
mod regression;
pub mod simulate;
pub mod step;
#[cfg(test)]
mod test_arm;
pub mod trig;
mod vector;

pub use controller::{Command, Controller, OnFault, Settings, TorqueController};
pub use error::{ConfigError, Fault, PlantError, Quantity, Reason, Requirement};
pub use estimate::Estimate;
pub use guarantee::{Guarantee, SampledErrors};
pub use law::{
    AdaptiveLaw, ConstantGainLaw, CoriolisTerm, ExactLaw, Gains, Law, ReportLaw, Switching, TightLaw,
};
pub use model::{Bounds, Model};
pub use real::Real;
pub use reference::{
    Desired, QuinticReference, Reference, ReferenceLimits, SinusoidReference, SplineReference, TickReference,
};
pub use regression::{AdaptiveModel, Regression};
pub use step::{ControlStep, StepController};
