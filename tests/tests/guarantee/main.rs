//! The guarantee of the sampled loop, attacked: simulations of the emitted step on an arm that shares nothing with the generator.

mod arms;
mod attack;
mod attacked;
mod frozen;
mod looped;
