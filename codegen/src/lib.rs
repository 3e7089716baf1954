//! Gramforge: an offline generator of certified reduced robot dynamics.
pub mod arm;
pub mod body;
pub mod bounds;
pub mod check;
pub mod cli;
pub mod config;
pub mod design;
pub mod dynamics;
pub mod emit;
pub mod error;
pub mod graph;
pub mod lagrangian;
pub mod load;
pub mod measure;
pub mod motion;
pub mod output;
pub mod pipeline;
pub mod reduction;
pub mod report;
pub mod simulate;
pub mod spec;

pub use config::{Config, Output};
pub use error::Error;
pub use pipeline::Generation;
