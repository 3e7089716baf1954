//! The main use, build.rs, with the real cargo: what is built, what is refused, and what stays behind.

#[path = "build_script/life.rs"]
mod life;
#[allow(clippy::approx_constant, reason = "numbers that clippy takes for a bad π are what is tested")]
#[path = "build_script/names.rs"]
mod names;
#[path = "build_script/package.rs"]
mod package;
