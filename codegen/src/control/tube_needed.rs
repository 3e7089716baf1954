//! The smallest tube that holds the errors, and the largest initial error for which the domain is enough.

use super::DesignProblem;
use super::error_envelope::{ClosedLoop, Envelope};
use super::form::inertia_bounds;
use super::guarantee::Parts;
use super::inertia::Inertia;
use super::region::{cells, outside};
use crate::error::Error;

/// Halvings of the interval in which the largest initial error lies.
const HALVINGS: u32 = 30;
/// Rounds in which the smallest sufficient tube must close.
const ROUNDS: usize = 6;

impl Parts<'_> {
    /// Widens the tube to the errors of the one before until it holds them.
    pub(super) fn smallest_tube(
        &self,
        inertia: &Inertia,
        envelope: &Envelope,
        start: &[f64],
        position_bound: &[f64],
    ) -> Result<Option<Vec<f64>>, Error> {
        let DesignProblem { domain, .. } = *self.problem;
        let mut tube = envelope.position_error.clone();
        for _ in 0..ROUNDS {
            let facts = inertia_bounds(inertia, cells(domain, &tube), self.gains, &self.form);
            let Some(next) =
                self.closed_loop(&facts, position_bound)?.invariant_level(envelope.v_max, start)?
            else {
                return Ok(None);
            };
            let next = next.position_error;
            if facts.certified && next.iter().zip(&tube).all(|(a, b)| *a <= b * (1.0 + 1e-9)) {
                return Ok(Some(next));
            }
            tube = next.iter().zip(&tube).map(|(a, b)| 1.02 * a.max(*b)).collect();
        }
        Ok(None)
    }

    /// The largest multiple of `shape` as initial position error from which no error leaves the domain; `level` gives V of
    /// an initial position error.
    pub(super) fn largest_initial_error(
        &self,
        closed_loop: &ClosedLoop,
        shape: &[f64],
        level: impl Fn(&[f64]) -> f64,
    ) -> Result<Vec<f64>, Error> {
        let DesignProblem { arm, domain, motion, .. } = *self.problem;
        let inside = |share: f64, shape: &[f64]| -> Result<bool, Error> {
            let scaled: Vec<f64> = shape.iter().map(|e| e * share).collect();
            let settled = closed_loop.invariant_level(level(&scaled), &scaled)?;
            Ok(settled.is_some_and(|e| outside(domain, motion, arm, &e.position_error).is_empty()))
        };
        largest_share(shape, inside)
    }
}

/// The direction in which the initial error is scaled.
pub(super) fn shape(position: &[f64], width: &[f64]) -> Vec<f64> {
    [position, width]
        .into_iter()
        .find(|s| s.iter().any(|e| *e > 0.0))
        .map_or(vec![1.0; width.len()], <[f64]>::to_vec)
}

/// The largest multiple of `shape`, up to half a turn (3.14 m), for which `inside` holds.
fn largest_share(
    shape: &[f64],
    inside: impl Fn(f64, &[f64]) -> Result<bool, Error>,
) -> Result<Vec<f64>, Error> {
    let most = std::f64::consts::PI / shape.iter().fold(0.0_f64, |m, e| m.max(*e));
    let (mut good, mut bad) = (0.0, most);
    if inside(most, shape)? {
        good = most;
    } else {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            if inside(middle, shape)? { good = middle } else { bad = middle }
        }
    }
    Ok(shape.iter().map(|e| e * good).collect())
}
