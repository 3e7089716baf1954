//! What a motion is within an interval of time: ranges of position, speed, acceleration and jerk.

use super::Motion;
use crate::numerics::Interval;

/// Derivatives in the Taylor polynomial of a sinusoid; those of polynomials end by themselves.
const ORDER: usize = 8;
/// Rounding of a reference and its derivatives, relative to the terms that it is made of.
const ROUNDING: f64 = 1e-13;
/// Largest s^(k) of the quintic s(x) = 10x³ − 15x⁴ + 6x⁵ written out term by term, k from 0.
const QUINTIC: [f64; 6] = [31.0, 120.0, 360.0, 780.0, 1080.0, 720.0];

/// Ranges over an interval of time, by joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// q_d, rad or m.
    pub q: Vec<Interval>,
    /// q̇_d, rad/s or m/s.
    pub qd: Vec<Interval>,
    /// q̈_d, rad/s² or m/s².
    pub qdd: Vec<Interval>,
    /// The third derivative of q_d, rad/s³ or m/s³; at the knots of a spline both of its values.
    pub jerk: Vec<Interval>,
}

/// One joint near one instant: derivatives from the zeroth on, what each is off by at most, and a bound on |the
/// `ORDER`-th derivative| anywhere.
struct Local {
    derivatives: [f64; ORDER],
    error: [f64; ORDER],
    last: f64,
}

impl Local {
    /// Ranges of q_d, q̇_d, q̈_d and the jerk within `half` s.
    fn ranges(&self, half: f64) -> [Interval; 4] {
        std::array::from_fn(|k| {
            let (mut off, mut step) = (self.error[k], 1.0);
            for i in 1..=ORDER - k {
                step *= half / i as f64;
                off += step * self.derivatives.get(k + i).map_or(self.last, |d| d.abs() + self.error[k + i]);
            }
            Interval::about(self.derivatives[k], off * (1.0 + ROUNDING))
        })
    }
}

impl Motion {
    /// Ranges over [t0, t1] ⊂ [0, t_f]: no instant leaves them, by Taylor's theorem about the middle of each smooth piece.
    pub fn span(&self, t0: f64, t1: f64) -> Span {
        let joints: Vec<[Interval; 4]> =
            (0..self.dof()).map(|joint| self.joint_span(joint, t0, t1)).collect();
        let of = |k: usize| joints.iter().map(|ranges| ranges[k]).collect();
        Span { q: of(0), qd: of(1), qdd: of(2), jerk: of(3) }
    }

    /// The same where each sinusoid may be early or late by up to `slack`, s.
    pub fn span_late(&self, t0: f64, t1: f64, slack: f64) -> Span {
        let mut span = self.span(t0, t1);
        if let Self::Sinusoids { terms, .. } = self {
            let lists = [&mut span.q, &mut span.qd, &mut span.qdd, &mut span.jerk];
            for (k, list) in (1..).zip(lists) {
                for (range, terms) in list.iter_mut().zip(terms) {
                    let each = terms.iter().map(|s| s.amplitude.abs() * power(s.frequency.abs(), k));
                    let off = slack * each.sum::<f64>() * (1.0 + ROUNDING);
                    *range = *range + Interval { low: -off, high: off };
                }
            }
        }
        span
    }

    /// A time between `t0` and `t1` at which to cut: the middle, or the knot of a spline that is nearest to it.
    pub fn cut(&self, t0: f64, t1: f64) -> f64 {
        let middle = 0.5 * (t0 + t1);
        let Self::Spline(spline) = self else { return middle };
        let after = spline.times.partition_point(|&knot| knot <= middle);
        let near = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let inner = near.filter_map(|k| spline.times.get(k).copied()).filter(|knot| t0 < *knot && *knot < t1);
        inner.min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs())).unwrap_or(middle)
    }

    /// Pieces of the whole motion to begin with: `count` equal ones, or those of a spline.
    pub(super) fn pieces(&self, count: u32) -> Vec<[f64; 2]> {
        match self {
            Self::Spline(spline) => spline.times.windows(2).map(|ends| [ends[0], ends[1]]).collect(),
            _ => {
                let at = |k: u32| self.duration() * f64::from(k) / f64::from(count);
                (0..count).map(|k| [at(k), at(k + 1)]).collect()
            }
        }
    }

    /// Ranges of q_d, q̇_d, q̈_d and the jerk of one joint.
    pub(super) fn joint_span(&self, joint: usize, t0: f64, t1: f64) -> [Interval; 4] {
        // A hair more than half, so that rounded ends still meet.
        let half = |t0: f64, t1: f64| {
            if t1 > t0 { 0.5 * (t1 - t0) * (1.0 + ROUNDING) + 4.0 * f64::EPSILON * t1.abs() } else { 0.0 }
        };
        match self {
            Self::Quintic { from, to, duration } => {
                let local = quintic(from[joint], to[joint], *duration, 0.5 * (t0 + t1));
                local.ranges(half(t0, t1))
            }
            Self::Sinusoids { offset, terms, .. } => {
                let (middle, half) = (0.5 * (t0 + t1), half(t0, t1));
                let ranges = sinusoids(offset[joint], &terms[joint], middle).ranges(half);
                let size = |k: i32| -> f64 {
                    let size = terms[joint].iter().map(|s| s.amplitude.abs() * power(s.frequency.abs(), k));
                    size.sum::<f64>() * (1.0 + ROUNDING)
                };
                let about = |k: i32| if k == 0 { offset[joint] } else { 0.0 };
                std::array::from_fn(|k| {
                    let k32 = k as i32;
                    let whole = Interval::about(about(k32), size(k32) + ROUNDING * about(k32).abs());
                    ranges[k].meet(whole)
                })
            }
            Self::Spline(spline) => {
                let later = spline.times.partition_point(|&knot| knot <= t0);
                // At its end the motion is still on the last piece.
                let first = later.saturating_sub(1).min(spline.pieces.len().saturating_sub(1));
                let pieces = spline.pieces.iter().zip(spline.times.windows(2)).skip(first);
                let inside = pieces.take_while(|(_, ends)| ends[0] <= t1);
                let ranges = inside.map(|(piece, ends)| {
                    let (from, to) = (t0.max(ends[0]) - ends[0], t1.min(ends[1]) - ends[0]);
                    cubic(&piece[joint], 0.5 * (from + to)).ranges(half(from, to))
                });
                let hull = |a: [Interval; 4], b: [Interval; 4]| std::array::from_fn(|k| a[k].hull(b[k]));
                ranges.reduce(hull).unwrap_or([Interval::ZERO; 4])
            }
        }
    }
}

fn power(base: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

fn quintic(from: f64, to: f64, duration: f64, t: f64) -> Local {
    let (x, way) = (t / duration, to - from);
    let s = [
        x * x * x * (10.0 + x * (6.0 * x - 15.0)),
        x * x * (30.0 + x * (30.0 * x - 60.0)),
        x * (60.0 + x * (120.0 * x - 180.0)),
        60.0 + x * (360.0 * x - 360.0),
        720.0 * x - 360.0,
        720.0,
    ];
    let mut local = Local { derivatives: [0.0; ORDER], error: [0.0; ORDER], last: 0.0 };
    let mut scale = way;
    for (k, (s, most)) in s.into_iter().zip(QUINTIC).enumerate() {
        local.derivatives[k] = scale * s;
        local.error[k] = ROUNDING * (scale.abs() * most + if k == 0 { from.abs() } else { 0.0 });
        scale /= duration;
    }
    local.derivatives[0] += from;
    local
}

fn cubic([c0, c1, c2, c3]: &[f64; 4], t: f64) -> Local {
    let mut local = Local { derivatives: [0.0; ORDER], error: [0.0; ORDER], last: 0.0 };
    let terms = [
        [*c0, c1 * t, c2 * t * t, c3 * t * t * t],
        [*c1, 2.0 * c2 * t, 3.0 * c3 * t * t, 0.0],
        [2.0 * c2, 6.0 * c3 * t, 0.0, 0.0],
        [6.0 * c3, 0.0, 0.0, 0.0],
    ];
    for (k, terms) in terms.iter().enumerate() {
        local.derivatives[k] = terms.iter().sum();
        local.error[k] = ROUNDING * terms.iter().map(|term| term.abs()).sum::<f64>();
    }
    local
}

fn sinusoids(offset: f64, terms: &[gramforge_runtime::reference::Sinusoid<f64>], t: f64) -> Local {
    let mut local = Local { derivatives: [0.0; ORDER], error: [0.0; ORDER], last: 0.0 };
    local.derivatives[0] = offset;
    local.error[0] = ROUNDING * offset.abs();
    for term in terms {
        let angle = term.frequency * t + term.phase;
        let (sin, cos) = libm::sincos(angle);
        // The angle is rounded before its sine is taken.
        let error = ROUNDING + 4.0 * f64::EPSILON * ((term.frequency * t).abs() + term.phase.abs());
        let mut size = term.amplitude;
        for k in 0..ORDER {
            local.derivatives[k] += size * [sin, cos, -sin, -cos][k % 4];
            local.error[k] += size.abs() * error;
            size *= term.frequency;
        }
        local.last += size.abs() * (1.0 + ROUNDING);
    }
    local
}

#[cfg(test)]
mod tests {
    use gramforge_runtime::reference::Sinusoid;

    use super::*;
    use crate::motion::Spline;

    fn motions() -> [Motion; 3] {
        let s = |amplitude, frequency, phase| Sinusoid { amplitude, frequency, phase };
        let knots: Vec<Vec<f64>> = [0.3, -0.2, 0.9, 1.4].iter().map(|&x| vec![x]).collect();
        [
            Motion::Quintic { from: vec![0.3], to: vec![-1.2], duration: 2.0 },
            Motion::Spline(Spline::through(&[0.0, 0.7, 1.1, 2.0], &knots, &[0.0], &[0.5])),
            Motion::Sinusoids {
                offset: vec![0.1],
                terms: vec![vec![s(0.4, 3.0, 0.2), s(-0.2, 15.0, 1.0)]],
                duration: 2.0,
            },
        ]
    }

    #[test]
    fn no_instant_leaves_the_span_and_a_short_one_is_narrow() {
        for motion in motions() {
            for k in 0..=40 {
                for length in [0.0, 1e-4, 0.01, 0.1, 0.7] {
                    let t0 = 2.0 * f64::from(k) / 40.0;
                    let t1 = (t0 + length).min(2.0);
                    let span = motion.span(t0, t1);
                    let holds = |range: Interval, x: f64| assert!(range.low <= x && x <= range.high);
                    let steps = 50;
                    let mut before: Option<(f64, f64)> = None;
                    for i in 0..=steps {
                        let t = (t0 + (t1 - t0) * f64::from(i) / f64::from(steps)).min(t1);
                        let target = motion.at(t);
                        holds(span.q[0], target.q[0]);
                        holds(span.qd[0], target.qd[0]);
                        holds(span.qdd[0], target.qdd[0]);
                        // The mean of the jerk between two instants lies in its range.
                        if let Some((time, qdd)) = before.filter(|(time, _)| t - time > 1e-4) {
                            let mean = (target.qdd[0] - qdd) / (t - time);
                            let spare = 1e-9 * span.jerk[0].magnitude();
                            assert!(span.jerk[0].low - spare <= mean && mean <= span.jerk[0].high + spare);
                        }
                        before = Some((t, target.qdd[0]));
                    }
                    let wide = span.qdd[0].high - span.qdd[0].low;
                    assert!(wide <= 2.0 * span.jerk[0].magnitude() * (t1 - t0) + 1e-9, "{wide}");
                }
            }
        }
    }

    #[test]
    fn a_cut_falls_on_a_knot_where_there_is_one() {
        let [quintic, spline, _] = motions();
        assert_eq!((quintic.cut(0.0, 2.0), spline.cut(0.0, 2.0)), (1.0, 1.1));
        assert_eq!((spline.cut(0.0, 0.9), spline.cut(0.7, 1.1)), (0.7, 0.9));
    }
}
