//! The C2 cubic spline with given end velocities.

/// A C2 piecewise cubic of n joints that share their knots.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Knot times, s, increasing, the first 0; one more than there are pieces.
    pub times: Vec<f64>,
    /// For each piece and joint the coefficients of (t − start)^k, constant first.
    pub pieces: Vec<Vec<[f64; 4]>>,
}

impl Spline {
    /// The spline through `positions` (one vector a knot) at `times`, s, with the given velocities at both ends.
    ///
    /// Times must increase strictly and number at least two; all vectors have one entry a joint.
    pub fn through(times: &[f64], positions: &[Vec<f64>], first: &[f64], last: &[f64]) -> Self {
        let start = times.first().copied().unwrap_or(0.0);
        let times: Vec<f64> = times.iter().map(|t| t - start).collect();
        let mut pieces = vec![vec![[0.0; 4]; first.len()]; times.len().saturating_sub(1)];
        for (joint, (&first, &last)) in first.iter().zip(last).enumerate() {
            let q: Vec<f64> = positions.iter().map(|p| p[joint]).collect();
            let slopes = slopes(&times, &q, first, last);
            for (k, piece) in pieces.iter_mut().enumerate() {
                let h = times[k + 1] - times[k];
                let chord = (q[k + 1] - q[k]) / h;
                let (left, right) = (slopes[k], slopes[k + 1]);
                piece[joint] = [
                    q[k],
                    left,
                    (3.0 * chord - 2.0 * left - right) / h,
                    (left + right - 2.0 * chord) / (h * h),
                ];
            }
        }
        Self { times, pieces }
    }

    /// Time of the last knot, s.
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Number of joints.
    pub fn dof(&self) -> usize {
        self.pieces.first().map_or(0, Vec::len)
    }

    /// Time since the start of the piece at `t`, and the piece's coefficients.
    pub(super) fn piece(&self, t: f64) -> (f64, &[[f64; 4]]) {
        let later = self.times.partition_point(|&knot| knot <= t);
        let index = later.saturating_sub(1).min(self.pieces.len().saturating_sub(1));
        match (self.times.get(index), self.pieces.get(index)) {
            (Some(start), Some(piece)) => (t - start, piece),
            _ => (0.0, &[]),
        }
    }
}

/// Velocities at the knots that make the second derivative continuous: a tridiagonal system, by elimination.
fn slopes(t: &[f64], q: &[f64], first: f64, last: f64) -> Vec<f64> {
    let n = t.len();
    let mut slope = vec![first; n];
    if let Some(end) = slope.last_mut() {
        *end = last;
    }
    if n < 3 {
        return slope;
    }
    let mut upper = vec![0.0; n];
    for k in 1..n - 1 {
        let (before, after) = (t[k] - t[k - 1], t[k + 1] - t[k]);
        let right = 3.0 * ((q[k] - q[k - 1]) / before * after + (q[k + 1] - q[k]) / after * before);
        let pivot = 2.0 * (before + after) - after * upper[k - 1];
        upper[k] = before / pivot;
        slope[k] = (right - after * slope[k - 1]) / pivot;
    }
    for k in (1..n - 1).rev() {
        slope[k] -= upper[k] * slope[k + 1];
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_the_knots_with_two_continuous_derivatives() {
        let times = [0.0, 0.7, 1.1, 2.0, 3.5];
        let positions: Vec<Vec<f64>> = [0.3, -0.2, 0.9, 1.4, 0.1].iter().map(|&x| vec![x]).collect();
        let spline = Spline::through(&times, &positions, &[0.0], &[0.5]);
        for k in 0..4 {
            let [c0, c1, c2, c3] = spline.pieces[k][0];
            let h = times[k + 1] - times[k];
            let end = [
                c0 + h * (c1 + h * (c2 + h * c3)),
                c1 + h * (2.0 * c2 + 3.0 * h * c3),
                2.0 * c2 + 6.0 * h * c3,
            ];
            assert!((c0 - positions[k][0]).abs() < 1e-15);
            assert!((end[0] - positions[k + 1][0]).abs() < 1e-14);
            if let Some(next) = spline.pieces.get(k + 1) {
                assert!((end[1] - next[0][1]).abs() < 1e-13, "velocity at knot {k}");
                assert!((end[2] - 2.0 * next[0][2]).abs() < 1e-12, "acceleration at knot {k}");
            } else {
                assert!((end[1] - 0.5).abs() < 1e-13);
            }
        }
        assert_eq!(spline.pieces[0][0][1], 0.0);
    }

    #[test]
    fn reproduces_a_cubic() {
        let f = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t + 0.25 * t * t * t;
        let slope = |t: f64| -2.0 + t + 0.75 * t * t;
        let times = [0.0, 0.4, 1.5, 2.0];
        let positions: Vec<Vec<f64>> = times.iter().map(|&t| vec![f(t)]).collect();
        let spline = Spline::through(&times, &positions, &[slope(0.0)], &[slope(2.0)]);
        for step in 0..=40 {
            let t = 0.05 * f64::from(step);
            let (dt, c) = spline.piece(t);
            let value = c[0][0] + dt * (c[0][1] + dt * (c[0][2] + dt * c[0][3]));
            assert!((value - f(t)).abs() < 1e-13);
        }
    }
}
