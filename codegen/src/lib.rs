//! Gramforge: an offline generator of certified reduced robot dynamics.
pub mod arm;
pub mod dynamics;
pub mod error;
pub mod lagrangian;
pub mod spec;
