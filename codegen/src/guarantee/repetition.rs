//! Motions that repeat themselves.

use crate::motion::Motion;

/// Longest repetition, in periods.
const MOST: usize = 100_000;
/// How far from a whole number of turns an angle may be after one repetition, rad.
const TURN: f64 = 1e-9;

/// A motion whose sinusoids all come back after a whole number of periods.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Repetition {
    pub(super) periods: usize,
}

impl Repetition {
    /// The shortest repetition of `motion`, of which at least two fit into its duration; `None` where there is none.
    pub(super) fn of(motion: &Motion, period: f64) -> Option<Self> {
        let Motion::Sinusoids { terms, duration, .. } = motion else { return None };
        let most = (0.5 * duration / period).min(MOST as f64) as usize;
        let angles: Vec<f64> = terms.iter().flatten().map(|term| term.frequency.abs() * period).collect();
        let turn = std::f64::consts::TAU;
        let off = |angle: f64, k: usize| {
            let whole = angle * k as f64 / turn;
            (whole - libm::round(whole)).abs() * turn
        };
        let repeats = |k: &usize| angles.iter().all(|&angle| off(angle, *k) <= TURN);
        (1..=most).find(repeats).map(|periods| Self { periods })
    }

    /// Bound on the time by which a repetition within `duration` comes early or late, s.
    pub(super) fn slack(motion: &Motion, period: f64) -> f64 {
        let (Some(Self { periods }), Motion::Sinusoids { terms, duration, .. }) =
            (Self::of(motion, period), motion)
        else {
            return 0.0;
        };
        let slowest = terms.iter().flatten().map(|term| term.frequency.abs()).filter(|w| *w > 0.0);
        let slowest = slowest.fold(f64::INFINITY, f64::min);
        let count = duration / (periods as f64 * period);
        if slowest.is_finite() { count * (TURN + 1e-12 * slowest * duration) / slowest } else { 0.0 }
    }
}
