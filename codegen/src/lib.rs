//! Gramforge: an offline generator of certified reduced robot dynamics.
pub mod arm;
pub mod error;
pub mod spec;
