//! What the generator computes, against oracles of their own: reference values, recursions, energy, Lyapunov functions.

mod closed_loop;
mod gram_schmidt;
mod laws;
mod lyapunov;
mod mimic;
mod motions;
mod reproduce;
mod truth;
mod twists;
mod uncertainty;
