//! The errors that the step's own error is bounded for: they grow with those that are followed.

use super::funnel::Funnel;
use super::problem::Wrong;

/// How much larger than the errors seen the next ones are declared.
const WIDER: f64 = 1.3;
/// Most declarations after the first.
const MOST: usize = 24;

/// Bounds on |q_e|, then |q̇_e|, at a sample, and what the step is wrong by while they hold.
#[derive(Clone)]
pub(super) struct Declared<'a> {
    bounds: Vec<f64>,
    /// What the step is wrong by for other bounds.
    wrong: &'a dyn Fn(&[f64]) -> Wrong,
    widened: usize,
}

impl<'a> Declared<'a> {
    pub(super) fn new(bounds: Vec<f64>, wrong: &'a dyn Fn(&[f64]) -> Wrong) -> Self {
        Self { bounds, wrong, widened: 0 }
    }

    /// What the step is wrong by within the bounds.
    pub(super) fn wrong(&self) -> Wrong {
        (self.wrong)(&self.bounds)
    }

    fn hold(&self, hull: &[f64]) -> bool {
        hull.iter().zip(&self.bounds).all(|(x, bound)| x <= bound)
    }

    /// Makes the bounds hold for the set of `funnel`, before its next torque is computed. The periods before keep theirs: their torque
    /// was computed within them.
    ///
    /// # Errors
    /// The bounds, where that has happened too often or the errors are not numbers.
    pub(super) fn widen(&mut self, funnel: &mut Funnel) -> Result<(), Vec<f64>> {
        if self.hold(&funnel.set.hull()) {
            return Ok(());
        }
        for (bound, x) in self.bounds.iter_mut().zip(funnel.ahead()) {
            if x > *bound {
                *bound = WIDER * x;
            }
        }
        self.widened += 1;
        if self.widened > MOST || !self.hold(&funnel.set.hull()) {
            return Err(self.bounds.clone());
        }
        funnel.wrong = self.wrong();
        Ok(())
    }
}
