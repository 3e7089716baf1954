//! What the command does with good input: exit codes, files, and numbers that agree with one another.

mod evaluate;
mod generate;
mod progress;
mod report;
mod show;
