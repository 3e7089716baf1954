//! What is promised of the loop that runs: sampled, joint by joint, over time.

mod course;
mod declared;
mod enclosure;
mod follow;
mod funnel;
mod local;
mod numbers;
mod period;
mod problem;
mod repetition;
mod sampled;
mod set;
mod settling;
mod statement;
#[cfg(test)]
mod tests;

pub use follow::Sampled;
pub use problem::Wrong;
pub use sampled::SampledLoop;
pub use statement::{Kind, Statement};
