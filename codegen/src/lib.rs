//! Gramforge: an offline generator of reduced robot dynamics and tracking controllers.
//!
//! A specification names an arm, a motion or a workspace, a form of model and a tracking law; out comes a flat,
//! allocation-free `no_std` module that implements `gramforge_runtime::Model`. [`Config`] does it from a build
//! script, [`Generation`] stage by stage:
//!
//! 1. [`load`] reads the JSON file against its schema: [`spec::Spec`].
//! 2. [`mod@arm`] turns its DH table or URDF into joints in one normal form: [`arm::Arm`].
//! 3. [`mod@check`] judges every other value of the specification.
//! 4. [`lagrangian`] expands D, h and G of equation (1) over cos(κ·q) and sin(κ·q), sampled by [`dynamics`]:
//!    [`lagrangian::Lagrangian`].
//! 5. [`motion`] and [`measure`] say where the model must be good, as weighted points: [`measure::Measure`].
//! 6. [`reduction`] keeps ξ functions by weighted Gram–Schmidt (2)–(8), or [`mod@tolerance`] as few as a certified
//!    torque error allows: [`reduction::Reduced`].
//! 7. [`bounds`] says how much was left out: [`bounds::Bounds`].
//! 8. [`mod@design`] makes the numbers of the tracking law (16) or (34) from gains and bounds: [`design::Design`].
//! 9. [`body`] writes the passivity torque D̂ a_r + Ĉ v_r + Ĝ as an expression [`graph`]: [`graph::Graph`].
//! 10. [`mod@emit`] prints graph and constants as Rust.
//!
//! Beside the line stand [`mod@simulate`], which closes the loop with the very laws of the runtime, [`report`], which
//! shows what came out, [`progress`], which tells how far the work is, [`output`], the only place that writes files, [`text`], which
//! escapes what is printed, and [`cli`].
//!
//! Every stage is a function from values to a value and knows none after it. The same specification gives the same
//! bytes on every machine: sums have a fixed order, sines come from `libm`, and no hash map is ever iterated.
//!
//! Equation numbers are those of A. P. Bartoszewicz, "Robust Robot Control Based on Simplified Dynamic Model",
//! TR-EE 92-21, Purdue University, 1992.

pub mod arm;
pub mod body;
pub mod bounds;
pub mod check;
#[cfg(feature = "cli")]
pub mod cli;
pub mod config;
pub mod design;
pub mod dynamics;
pub mod emit;
pub mod error;
pub mod graph;
pub mod interval;
pub mod lagrangian;
pub mod load;
pub mod measure;
pub mod motion;
pub mod number;
pub mod output;
pub(crate) mod parallel;
pub mod pipeline;
pub mod progress;
pub mod reduction;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "cli")]
pub mod reproduce;
#[cfg(any(feature = "simulate", test))]
pub mod simulate;
pub mod sines;
pub mod spec;
pub mod spread;
pub mod text;
pub mod tolerance;

pub use config::{Config, Output};
pub use error::Error;
pub use pipeline::Generation;
