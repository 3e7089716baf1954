//! The command, build scripts and the shape of the source.

mod architecture;
mod build_script;
mod command;
#[path = "../common/mod.rs"]
mod common;
