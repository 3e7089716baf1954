//! The guarantee of the sampled loop, attacked: simulations of the emitted step on an arm that shares nothing with the generator.

#[path = "../common/mod.rs"]
mod common;

mod arms;
mod attack;
mod attacked;
mod cases;
mod daily;
mod found;
mod frozen;
mod looped;
mod promises;
mod survey;
