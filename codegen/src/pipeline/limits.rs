//! How far period and initial error may go before the guarantee of the sampled loop is lost.

use super::generation::Generation;
use super::judged::Judge;
use crate::check::InitialError;
use crate::control::Design;

/// Halvings of a search.
const HALVINGS: usize = 6;
/// The longest period that is tried, as a part of that at which the loop with D frozen turns unstable.
const LONGEST: f64 = 1.1;

/// The largest values for which the funnel was found to close. Others between them and those asked for were not tried.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Control period, s.
    pub period: f64,
    /// Position errors by joint, rad or m: those of the specification, or the tube, times a factor.
    pub initial_error: Vec<f64>,
}

impl Generation {
    /// How far period and initial error may go; `None` where the sampled loop is not guaranteed as it is.
    pub(crate) fn limits(&self) -> Option<Limits> {
        let (design, rounding) = (self.design()?, self.rounding()?);
        let judge = Judge::new(&self.designed.certified, design, rounding);
        let initial = &self.control()?.initial_error;
        self.statement()?.promised()?;
        let tube = judge.tube()?;
        let longest = (LONGEST * design.guarantee.period_max).max(design.period);
        let period = largest(design.period, longest, |period| {
            judge.errors_from(&Design { period, ..design.clone() }, initial).is_ok()
        });
        let shape = if initial.position.iter().any(|e| *e > 0.0) { &initial.position } else { &tube };
        let scaled = |factor: f64| -> Vec<f64> { shape.iter().map(|e| factor * e).collect() };
        let most = shape.iter().zip(&tube).filter(|(e, _)| **e > 0.0).map(|(e, tube)| tube / e);
        let most = most.fold(f64::INFINITY, f64::min);
        let least = if shape == &initial.position { 1.0 } else { 0.0 };
        let factor = largest(least, most.max(least), |factor| {
            let initial = InitialError { position: scaled(factor), ..initial.clone() };
            judge.errors_from(design, &initial).is_ok()
        });
        Some(Limits { period, initial_error: scaled(factor) })
    }
}

/// The largest number found for which `holds`, from `low`, for which it does, up to `high`.
fn largest(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    if low >= high || holds(high) {
        return low.max(high);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
