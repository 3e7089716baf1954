//! Arms that are known to intervals only: their expansion is the oracle's, no member of the family exceeds a bound, and a
//! model that follows them finds each.
//!
//! The report's factor on a PUMA 560 with a payload takes a minute:
//! `cargo test --release -p gramforge-tests --test uncertainty -- --include-ignored --nocapture`

#[path = "uncertainty/bounds.rs"]
mod bounds;
#[path = "uncertainty/expansion.rs"]
mod expansion;
#[path = "uncertainty/reestimation.rs"]
mod reestimation;
