//! The main use, build.rs, with the real cargo: what is built, what is refused, and what stays behind.

mod life;
#[allow(clippy::approx_constant, reason = "numbers that clippy takes for a bad π are what is tested")]
mod names;
mod package;
