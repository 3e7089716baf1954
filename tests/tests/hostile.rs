//! Hostile text: nothing that a file says becomes a line, a colour or a directive of its own, and no output is lost.

#[path = "hostile/injection.rs"]
mod injection;
#[path = "hostile/streams.rs"]
mod streams;
#[path = "hostile/writers.rs"]
mod writers;

mod common;
