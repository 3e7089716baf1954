//! Hostile text: nothing that a file says becomes a line, a colour or a directive of its own, and no output is lost.

mod injection;
mod streams;
mod writers;
