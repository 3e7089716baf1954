//! The `no_std` half of Gramforge: models, tracking laws, the fixed-step controller and a simulator.
#![no_std]

mod model;
mod real;

pub use model::{Bounds, Model};
pub use real::Real;
