//! What a motion cannot exceed within an interval of time, from its closed form.

use gramforge_runtime::reference::Sinusoid;

use super::Motion;

/// Roundings of the few operations below, relative and with room to spare.
const ROUNDING: f64 = 1.0 + 1e-13;

impl Motion {
    /// A bound on |q̈_d| by joint over [t0, t1] ⊂ [0, t_f], rad/s² or m/s², that no instant exceeds.
    ///
    /// The acceleration of the quintic has its inner extremes at x = (3 ± √3)/6, that of a C2 spline is linear
    /// between knots, and that of sinusoids changes by at most Σ|a|ω³ a second.
    pub fn acceleration_within(&self, t0: f64, t1: f64) -> Vec<f64> {
        let (t0, t1) = (t0.max(0.0), t1.min(self.duration()));
        let mut most: Vec<f64> = vec![0.0; self.dof()];
        let visit = |most: &mut [f64], t: f64| {
            for (most, qdd) in most.iter_mut().zip(self.at(t).qdd) {
                *most = most.max(qdd.abs());
            }
        };
        match self {
            Self::Quintic { duration, .. } => {
                visit(&mut most, t0);
                visit(&mut most, t1);
                let root = libm::sqrt(3.0) / 6.0;
                for t in [duration * (0.5 - root), duration * (0.5 + root)] {
                    if t0 - 1e-12 * duration <= t && t <= t1 + 1e-12 * duration {
                        visit(&mut most, t);
                    }
                }
            }
            Self::Spline(spline) => {
                // Each piece by its own coefficients: neighbours agree at their knot only to rounding.
                let first = spline.times.partition_point(|&knot| knot < t0).saturating_sub(1);
                let pieces = spline.pieces.iter().zip(spline.times.windows(2)).skip(first);
                for (piece, ends) in pieces.take_while(|(_, ends)| ends[0] <= t1) {
                    let (from, to) = (t0.max(ends[0]) - ends[0], t1.min(ends[1]) - ends[0]);
                    if from <= to {
                        for (most, [_, _, c2, c3]) in most.iter_mut().zip(piece) {
                            let at = |t: f64| (2.0 * c2 + 6.0 * c3 * t).abs();
                            *most = most.max(at(from)).max(at(to));
                        }
                    }
                }
            }
            Self::Sinusoids { terms, .. } => {
                let half = 0.5 * (t1 - t0);
                visit(&mut most, 0.5 * (t0 + t1));
                for (most, terms) in most.iter_mut().zip(terms) {
                    *most = (*most + half * size(terms, 3)).min(size(terms, 2));
                }
            }
        }
        most.into_iter().map(|a| a * ROUNDING + f64::MIN_POSITIVE).collect()
    }

    /// Bounds on |q_d|, |q̇_d| and |q̈_d| by joint over the whole motion that no instant exceeds.
    pub fn position_bound(&self) -> PositionRange {
        const INTERVALS: u32 = 1024;
        let n = self.dof();
        let mut out =
            PositionRange { position: vec![0.0; n], speed: vec![0.0; n], acceleration: vec![0.0; n] };
        let half = 0.5 * self.duration() / f64::from(INTERVALS);
        for k in 0..INTERVALS {
            let middle = half * f64::from(2 * k + 1);
            let target = self.at(middle);
            // A hair more than half an interval, so that rounded ends still meet.
            let half = half * ROUNDING;
            for (j, most) in self.acceleration_within(middle - half, middle + half).into_iter().enumerate() {
                let position = target.q[j].abs() + half * (target.qd[j].abs() + 0.5 * most * half);
                out.position[j] = out.position[j].max(position * ROUNDING);
                out.speed[j] = out.speed[j].max((target.qd[j].abs() + most * half) * ROUNDING);
                out.acceleration[j] = out.acceleration[j].max(most);
            }
        }
        if let Self::Sinusoids { offset, terms, .. } = self {
            // Where an interval holds much of a period, the amplitudes say more.
            for (j, terms) in terms.iter().enumerate() {
                out.position[j] = out.position[j].min((offset[j].abs() + size(terms, 0)) * ROUNDING);
                out.speed[j] = out.speed[j].min(size(terms, 1) * ROUNDING);
            }
        }
        out
    }
}

/// Σ |a| |ω|^k.
fn size(terms: &[Sinusoid<f64>], k: u32) -> f64 {
    terms.iter().map(|s| (0..k).fold(s.amplitude.abs(), |size, _| size * s.frequency.abs())).sum()
}

/// Bounds over a whole motion, by joint.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionRange {
    /// Largest |q_d|, rad or m.
    pub position: Vec<f64>,
    /// Largest |q̇_d|, rad/s or m/s.
    pub speed: Vec<f64>,
    /// Largest |q̈_d|, rad/s² or m/s².
    pub acceleration: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Spline;

    #[test]
    fn no_instant_leaves_the_enclosure() {
        let s = |amplitude, frequency, phase| Sinusoid { amplitude, frequency, phase };
        let knots: Vec<Vec<f64>> = [0.3, -0.2, 0.9, 1.4].iter().map(|&x| vec![x]).collect();
        let motions = [
            Motion::Quintic { from: vec![0.3], to: vec![-1.2], duration: 2.0 },
            Motion::Spline(Spline::through(&[0.0, 0.7, 1.1, 2.0], &knots, &[0.0], &[0.5])),
            Motion::Sinusoids {
                offset: vec![0.1],
                terms: vec![vec![s(0.4, 3.0, 0.2), s(-0.2, 5.0, 1.0)]],
                duration: 2.0,
            },
        ];
        for motion in motions {
            let position_bound = motion.position_bound();
            for k in 0..40 {
                for length in [0.01, 0.1, 0.7] {
                    let t0 = 2.0 * f64::from(k) / 40.0;
                    let t1 = (t0 + length).min(2.0);
                    let (middle, most) = (0.5 * (t0 + t1), motion.acceleration_within(t0, t1)[0]);
                    let centre = motion.at(middle);
                    for i in 0..=50 {
                        let t = t0 + (t1 - t0) * f64::from(i) / 50.0;
                        let target = motion.at(t);
                        assert!(target.qdd[0].abs() <= most);
                        let line = centre.q[0] + centre.qd[0] * (t - middle);
                        let off = 0.5 * most * (t - middle) * (t - middle);
                        assert!((target.q[0] - line).abs() <= off + 1e-14);
                        assert!(target.q[0].abs() <= position_bound.position[0]);
                        assert!(target.qd[0].abs() <= position_bound.speed[0]);
                        assert!(target.qdd[0].abs() <= position_bound.acceleration[0]);
                    }
                }
            }
        }
    }
}
