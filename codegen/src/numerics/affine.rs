//! Affine forms: numbers as sums of common unknowns, so that what two numbers have in common is not counted twice.
//!
//! A rotation mixes two components by a sine and a cosine. As intervals each component grows by up to √2 at every joint; as sums of the
//! same unknowns they turn and do not grow (Stolfi and de Figueiredo, Self-Validated Numerical Methods, 1997).

use std::ops::Neg;

use super::interval::Interval;

/// Number of unknowns.
pub const UNKNOWNS: usize = 48;

/// middle + Σ_k parts_k ε_k ± rest with |ε_k| ≤ 1.
///
/// Holds: every operation gives a form that holds the exact result for the same ε.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    middle: f64,
    parts: [f64; UNKNOWNS],
    rest: f64,
}

/// More than what the few roundings of one operation add, relative to the numbers in it.
const SLACK: f64 = 16.0 * f64::EPSILON;

impl Affine {
    /// All of `range`, which has nothing in common with other numbers.
    pub fn alone(range: Interval) -> Self {
        let middle = 0.5 * (range.low + range.high);
        let radius = (range.high - middle).max(middle - range.low);
        Self { middle, parts: [0.0; UNKNOWNS], rest: radius + SLACK * middle.abs() }
    }

    /// All of `range`, as the unknown `k`.
    pub fn unknown(range: Interval, k: usize) -> Self {
        let mut out = Self::alone(range);
        if let Some(part) = out.parts.get_mut(k) {
            (*part, out.rest) = (out.rest, 0.0);
        }
        out
    }

    /// Where the number lies.
    pub fn range(&self) -> Interval {
        Interval::about(self.middle, self.radius() * (1.0 + SLACK * UNKNOWNS as f64))
    }

    fn radius(&self) -> f64 {
        self.parts.iter().map(|part| part.abs()).sum::<f64>() + self.rest
    }

    fn size(&self) -> f64 {
        self.middle.abs() + self.radius()
    }

    /// −x.
    pub fn minus(&self) -> Self {
        Self { middle: -self.middle, parts: self.parts.map(|part| -part), rest: self.rest }
    }

    /// x + y.
    pub fn plus(&self, y: &Self) -> Self {
        let mut parts = self.parts;
        parts.iter_mut().zip(&y.parts).for_each(|(part, y)| *part += y);
        let slack = SLACK * (self.size() + y.size());
        Self { middle: self.middle + y.middle, parts, rest: self.rest + y.rest + slack }
    }

    /// x y.
    pub fn times(&self, y: &Self) -> Self {
        let (a, b) = (self.middle, y.middle);
        let mut parts = [0.0; UNKNOWNS];
        for (k, part) in parts.iter_mut().enumerate() {
            *part = a * y.parts[k] + b * self.parts[k];
        }
        let products = self.radius() * y.radius();
        let slack = SLACK * UNKNOWNS as f64 * self.size() * y.size();
        Self { middle: a * b, parts, rest: a.abs() * y.rest + b.abs() * self.rest + products + slack }
    }
}

impl Neg for Affine {
    type Output = Self;
    fn neg(self) -> Self {
        self.minus()
    }
}

#[cfg(test)]
mod tests {
    use super::Affine;
    use crate::numerics::interval::Interval;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    fn about(middle: f64, radius: f64) -> Interval {
        Interval { low: middle - radius, high: middle + radius }
    }

    #[test]
    fn members_stay_members() {
        let points = LowDiscrepancy::new(3);
        let forms = [(0.7, 2.0), (-1.5, 0.3), (4.0, 0.01)];
        let [x, y, z] = [0, 1, 2].map(|k| Affine::unknown(about(forms[k].0, forms[k].1), k));
        let made = x.times(&y).plus(&z.times(&x).minus()).plus(&y);
        let range = made.range();
        for index in 0..5000 {
            let u = points.point(index);
            let [a, b, c] = [0, 1, 2].map(|k| forms[k].0 + forms[k].1 * (2.0 * u[k] - 1.0));
            let exact = a * b - c * a + b;
            assert!(range.low <= exact && exact <= range.high, "{exact} {range:?}");
        }
    }

    #[test]
    fn what_is_common_cancels_and_a_turned_vector_does_not_grow() {
        let x = Affine::unknown(about(1.0, 0.5), 3);
        assert!(x.plus(&x.minus()).range().magnitude() < 1e-13);
        let (sin, cos) = 0.785_f64.sin_cos();
        let [s, c] = [sin, cos].map(|x| Affine::alone(Interval::point(x)));
        let mut vector = [Affine::unknown(about(0.0, 1.0), 0), Affine::unknown(about(0.0, 1.0), 1)];
        for _ in 0..20 {
            let [x, y] = vector;
            vector = [c.times(&x).plus(&s.times(&y).minus()), s.times(&x).plus(&c.times(&y))];
        }
        // √2 at most: a corner of the square, turned onto an axis.
        assert!(vector.iter().all(|x| x.range().magnitude() < 1.4143), "{vector:?}");
    }
}
