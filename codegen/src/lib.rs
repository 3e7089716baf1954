//! Gramforge: an offline generator of certified reduced robot dynamics.
pub mod arm;
pub mod check;
pub mod error;
pub mod load;
pub mod spec;
