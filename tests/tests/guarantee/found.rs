//! What runs find.

use gramforge_tests::plant::{MOST, Row, row};

/// The largest of some runs, by joint.
#[derive(Clone, Debug)]
pub struct Found {
    pub runs: usize,
    pub reach: Row,
    pub settled: Row,
    pub end: Row,
    pub torque: [Row; 2],
    /// Largest error of the model as a part of its bound.
    pub model_error: f64,
    /// The first broken promise.
    pub broken: Option<String>,
}

impl Default for Found {
    fn default() -> Self {
        let zero = row(&[]);
        Self {
            runs: 0,
            reach: zero,
            settled: zero,
            end: zero,
            torque: [[f64::INFINITY; MOST], [f64::NEG_INFINITY; MOST]],
            model_error: 0.0,
            broken: None,
        }
    }
}

impl Found {
    pub fn with(mut self, other: &Self) -> Self {
        for i in 0..self.reach.len() {
            self.reach[i] = self.reach[i].max(other.reach[i]);
            self.settled[i] = self.settled[i].max(other.settled[i]);
            self.end[i] = self.end[i].max(other.end[i]);
            self.torque[0][i] = self.torque[0][i].min(other.torque[0][i]);
            self.torque[1][i] = self.torque[1][i].max(other.torque[1][i]);
        }
        self.runs += other.runs;
        self.model_error = self.model_error.max(other.model_error);
        self.broken = self.broken.or_else(|| other.broken.clone());
        self
    }
}
