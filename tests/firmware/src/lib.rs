//! Generated modules in single precision on a bare core, in a loop as a user writes it.
//!
//! [`control_loop`] is what a firmware copies: it waits for the tick, reads the encoders, takes the control step, drives
//! the motors, reacts to faults and feeds the watchdog. Everything else measures it: [`bench`] stands for the board, with
//! the arm simulated; [`measure`] counts instructions and stack; [`faults`] gives a step every input that it must refuse.
//!
//! The same program runs on the host. What it prints there must be the same, apart from the counts.
#![cfg_attr(target_os = "none", no_std)]

pub mod bench;
pub mod board;
pub mod control_loop;
pub mod faults;
pub mod hash;
pub mod measure;
pub mod modules;
pub mod print;
pub mod states;
