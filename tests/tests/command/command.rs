//! What the command does with good input: exit codes, files, and numbers that agree with one another.

mod diff;
mod evaluate;
mod generate;
mod guides;
mod init;
mod manners;
mod progress;
mod report;
mod show;
mod sweep;
