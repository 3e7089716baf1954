//! Arms that are known to intervals only: their expansion is the oracle's, no member of the family exceeds a bound, and a
//! model that follows them finds each.
//!
//! The report's factor on a PUMA 560 with a payload takes a minute:
//! `cargo test --release -p gramforge-tests --test physics -- uncertainty:: --include-ignored --nocapture`

mod bounds;
mod expansion;
mod reestimation;
