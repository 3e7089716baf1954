//! Gramforge: an offline generator of certified reduced robot dynamics.
pub mod arm;
pub mod bounds;
pub mod design;
pub mod dynamics;
pub mod error;
pub mod graph;
pub mod lagrangian;
pub mod measure;
pub mod motion;
pub mod reduction;
pub mod report;
pub mod simulate;
pub mod spec;
