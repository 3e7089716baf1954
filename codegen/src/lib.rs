//! Gramforge: an offline generator of reduced robot dynamics and tracking controllers.
//!
//! A specification names an arm, a motion or a workspace, a form of model and a tracking law. Gramforge writes a flat,
//! allocation-free `no_std` module that implements `gramforge_runtime::Model`.
//!
//! ```no_run
//! // In build.rs, inside main:
//! gramforge::Config::new().spec("specs/arm.json").run_in_build_script();
//! ```
//!
//! - [`Config`] generates modules, from a build script or from a program of your own; an [`Output`] is one module.
//! - [`Generation`] is everything that follows from one specification: the model, its bounds and the controller.
//! - [`load`] reads a specification file into [`spec::Spec`].
//! - [`Effort`] says how much work each bound may take. [`Progress`] reports how far the work is.
//! - [`Error`] lists every fault of the input at once, each as a [`Diagnostic`].
//!
//! The same specification gives the same bytes on every machine: sums have a fixed order, sines come from `libm`, and no
//! hash map is ever iterated.
//!
//! Equation numbers are those of A. P. Bartoszewicz, "Robust Robot Control Based on Simplified Dynamic Model",
//! TR-EE 92-21, Purdue University, 1992.

mod arm;
mod bounds;
mod cache;
#[cfg(feature = "cli")]
mod changes;
mod check;
mod choose;
#[cfg(feature = "cli")]
mod cli;
mod config;
mod control;
mod domain;
mod dynamics;
mod emit;
mod error;
mod graph;
mod guarantee;
#[cfg(feature = "cli")]
mod init;
mod lagrangian;
pub mod load;
mod model;
mod motion;
mod number;
mod numerics;
mod output;
mod parallel;
mod pipeline;
mod progress;
mod reduction;
#[cfg(feature = "cli")]
mod report;
#[cfg(feature = "cli")]
mod reproduce;
#[cfg(any(feature = "simulate", test))]
mod simulate;
#[cfg(feature = "cli")]
mod sizes;
pub mod spec;
mod text;
mod torque;
mod trig;

pub use bounds::Effort;
pub use config::{Config, Output, OutputFile};
pub use error::{Diagnostic, Error, Stale};
pub use pipeline::Generation;
pub use progress::Progress;

/// The stages, for the command and the tests of this workspace only. They may change in any release.
#[doc(hidden)]
pub mod internals {
    macro_rules! open {
        ($($module:ident)*) => {
            $(pub mod $module {
                pub use crate::$module::*;
            })*
        };
    }

    open! {
        arm bounds check choose control domain dynamics emit error graph guarantee lagrangian model motion number numerics
        output pipeline progress reduction text torque trig
    }
    #[cfg(feature = "cli")]
    open! { changes cli report reproduce sizes }
    #[cfg(any(feature = "simulate", test))]
    open! { simulate }
}
