//! Wrong, damaged and hostile input, and robot files as people have them.

mod bad_specs;
#[path = "../common/mod.rs"]
mod common;
mod fuzz;
mod hostile;
mod robots;
