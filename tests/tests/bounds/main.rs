//! What is published of a model and of a loop, attacked.

mod bounds;
mod certified;
mod designed;
mod enclosed;
mod minimax;
mod promises;
mod separate;
mod simplified_arm;
mod sines;
mod tolerance;
