//! The `gramforge` command.
fn main() {}
