//! What the command does with good input: exit codes, files, and numbers that agree with one another.

#[path = "command/evaluate.rs"]
mod evaluate;
#[path = "command/generate.rs"]
mod generate;
#[path = "command/progress.rs"]
mod progress;
#[path = "command/show.rs"]
mod show;

mod common;
