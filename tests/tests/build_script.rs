//! The main use, build.rs, with the real cargo: what is built, what is refused, and what stays behind.

#[path = "build_script/life.rs"]
mod life;
#[path = "build_script/names.rs"]
mod names;
#[path = "build_script/package.rs"]
mod package;
