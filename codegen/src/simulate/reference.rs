//! The desired motion as the device follows it.

use gramforge_runtime::reference::{Reference, sinusoids};
use gramforge_runtime::{ConfigError, Desired};

use super::array::vector;
use crate::error::Error;
use crate::motion::Motion;

/// A motion of `N` joints as a runtime reference, before 0 and after the end too: sinusoids go on, all others rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionReference<'a, const N: usize> {
    motion: &'a Motion,
}

impl<'a, const N: usize> MotionReference<'a, N> {
    /// # Errors
    /// [`Error::Internal`] where the motion is not one of `N` joints.
    pub(super) fn new(motion: &'a Motion) -> Result<Self, Error> {
        vector::<_, N>("the motion", &motion.at(0.0).q)?;
        Ok(Self { motion })
    }
}

impl<const N: usize> Reference<f64, N> for MotionReference<'_, N> {
    fn duration(&self) -> f64 {
        self.motion.duration()
    }

    fn at(&self, t: f64) -> Desired<f64, N> {
        if let Motion::Sinusoids { offset, terms, .. } = self.motion {
            // `Motion::at` stops at the end; the device does not.
            let joint = |i: usize| match (offset.get(i), terms.get(i)) {
                (Some(&offset), Some(terms)) => sinusoids(offset, terms, t),
                _ => (f64::NAN, f64::NAN, f64::NAN),
            };
            let joints: [_; N] = std::array::from_fn(joint);
            return Desired { q: joints.map(|j| j.0), qd: joints.map(|j| j.1), qdd: joints.map(|j| j.2) };
        }
        let target = self.motion.at(t);
        let array = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(f64::NAN));
        if t < 0.0 || t >= self.motion.duration() {
            return Desired::at_rest(array(&target.q));
        }
        Desired { q: array(&target.q), qd: array(&target.qd), qdd: array(&target.qdd) }
    }

    fn check(&self) -> Result<(), ConfigError> {
        Ok(())
    }
}
