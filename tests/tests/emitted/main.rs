//! The generated modules, compiled: bits, signs, counts.

mod adaptive;
mod counts;
mod generated_code;
mod trig;
