//! Motions that repeat themselves.

use crate::motion::Motion;

/// Longest repetition, in periods.
const MOST: usize = 100_000;
/// How far from a whole number of turns an angle may be after one repetition, rad.
const TURN: f64 = 1e-9;
/// What an angle and its distance from whole turns round by, relative to the angle, with room to spare.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// A motion whose sinusoids all come back after a whole number of periods.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Repetition {
    pub(super) periods: usize,
    /// Bound on the time by which a sinusoid comes early or late within the duration of the motion, s.
    pub(super) slack: f64,
}

impl Repetition {
    /// The shortest repetition of `motion`, of which at least two fit into its duration; `None` where there is none.
    pub(super) fn of(motion: &Motion, period: f64) -> Option<Self> {
        let Motion::Sinusoids { terms, duration, .. } = motion else { return None };
        let most = (0.5 * duration / period).min(MOST as f64) as usize;
        let frequencies: Vec<f64> =
            terms.iter().flatten().map(|term| term.frequency.abs()).filter(|w| *w > 0.0).collect();
        // The angle that a sinusoid is off by after k periods, rad, with what computing it rounds by.
        let off = |frequency: f64, k: usize| {
            let angle = frequency * period * k as f64;
            let whole = angle / std::f64::consts::TAU;
            (whole - libm::round(whole)).abs() * std::f64::consts::TAU + ROUNDED * angle
        };
        let periods = (1..=most).find(|&k| frequencies.iter().all(|&w| off(w, k) <= TURN))?;
        let count = libm::ceil(duration / (periods as f64 * period));
        let late = frequencies.iter().map(|&w| count * off(w, periods) / w).fold(0.0, f64::max);
        Some(Self { periods, slack: late })
    }
}

#[cfg(test)]
mod tests {
    use gramforge_runtime::reference::Sinusoid;

    use super::*;

    #[test]
    fn a_motion_of_whole_periods_comes_back_within_its_slack() {
        let term = |frequency| Sinusoid { amplitude: 0.1, frequency, phase: 0.3 };
        let two_hertz = 4.0 * std::f64::consts::PI;
        let motion = |terms| Motion::Sinusoids { offset: vec![0.0], terms: vec![terms], duration: 200.0 };
        let (both, period) = (motion(vec![term(two_hertz), term(1.5 * two_hertz)]), 1e-3);
        let found = Repetition::of(&both, period).expect("one second holds whole turns of both");
        assert_eq!(found.periods, 1000);
        assert!(found.slack > 0.0 && found.slack < 1e-11, "{}", found.slack);
        let again = found.periods as f64 * period;
        for k in 0..100 {
            let t = 0.0123 * f64::from(k);
            let last = libm::floor((200.0 - t) / again);
            let off = (both.at(t).q[0] - both.at(t + last * again).q[0]).abs();
            // 0.1 (ω₁ + ω₂) times the slack, and what the sines of 2500 rad round by.
            assert!(off <= 0.1 * 2.5 * two_hertz * found.slack + 1e-13, "{off}");
        }
        assert_eq!(Repetition::of(&motion(vec![term(two_hertz), term(1.0)]), period), None);
    }
}
