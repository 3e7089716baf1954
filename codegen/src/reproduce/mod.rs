//! Section 4 of the report once more: its three-link arm under every law, its figures, its claims.
//!
//! The report's gains are printed as W = 40I, Pqq = 4I, Ω = I, P12 = 0.25I. With these the position error decays with
//! P12 at best, in seconds, against the 1.5 s of the report's own figures; with Pqq and P12 swapped, still
//! P12 = Pqq⁻¹Ω, it converges in time. The cases use the swapped pair; one shows the printed one. The desired motion of
//! the report is lost, and a quintic stands in for it.

mod cases;
mod claims;

pub use cases::{Cases, LoadedCases, run};
pub use claims::claims;
