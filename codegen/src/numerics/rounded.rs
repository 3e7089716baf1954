//! Numbers with all values that they can have, and what computing them may be off by.

use std::ops::{Add, Mul, Neg, Sub};

use super::interval::Interval;

/// A floating-point type, as far as rounding goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Format {
    /// Largest relative error of one rounding, u.
    pub unit: f64,
    /// Largest error of one rounding below the normal numbers.
    pub underflow: f64,
    /// Largest number.
    pub most: f64,
}

impl Format {
    /// IEEE double.
    pub const DOUBLE: Self = Self { unit: 0.5 * f64::EPSILON, underflow: 5e-324, most: f64::MAX };
    /// IEEE single.
    pub const SINGLE: Self =
        Self { unit: 0.5 * f32::EPSILON as f64, underflow: 7.1e-46, most: f32::MAX as f64 };
}

/// The sums and products below are rounded themselves, in f64: each error is made that much larger.
const SPARE: f64 = 1.0 + 1e-14;

/// A number that code computes in some format.
///
/// Holds: in exact arithmetic the number lies in `value`, and what is computed differs from it by at most `error`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// Where the exact number lies.
    pub value: Interval,
    /// Bound on |computed − exact|; infinite or NaN where there is none.
    pub error: f64,
    /// Bound on the part of the error that the number's own operation makes, its operands taken as they are computed.
    pub own: f64,
    format: Format,
}

impl Rounded {
    /// 0 and 1 in IEEE single.
    pub const ZERO_SINGLE: Self =
        Self { value: Interval::ZERO, error: 0.0, own: 0.0, format: Format::SINGLE };
    /// 1 in IEEE single.
    pub const ONE_SINGLE: Self = Self { value: Interval { low: 1.0, high: 1.0 }, ..Self::ZERO_SINGLE };

    /// An input that lies in `value` and is a number of the format.
    pub fn input(value: Interval, format: Format) -> Self {
        Self::within(value, 0.0, format)
    }

    /// A number within `error` of one in `value`.
    pub fn within(value: Interval, error: f64, format: Format) -> Self {
        Self { value, error, own: error, format }
    }

    /// A literal, rounded once.
    pub fn constant(x: f64, format: Format) -> Self {
        let error = match format == Format::SINGLE {
            true => (f64::from(x as f32) - x).abs(),
            false => 0.0,
        };
        Self::within(Interval::point(x), error, format)
    }

    /// Where the computed number lies.
    pub fn widened(self) -> Interval {
        self.value + Interval::about(0.0, self.error)
    }

    /// max |exact|.
    pub fn magnitude(self) -> f64 {
        self.value.magnitude()
    }

    /// What is computed of `value` from operands whose errors lead to `carried`.
    fn once(value: Interval, carried: f64, format: Format) -> Self {
        let size = value.magnitude() + carried;
        // What may be too large for the format has no bound.
        let fits = |error: f64| if size < format.most { error * SPARE } else { f64::INFINITY };
        let error = fits(carried + format.unit * size + format.underflow);
        Self { value, error, own: fits(format.unit * power_below(size * SPARE) + format.underflow), format }
    }

    /// The literal 2^k or −2^k, by which a product is exact but for underflow.
    fn is_power_of_two(self) -> bool {
        let x = self.value.low;
        let single = self.value.high == x && self.error == 0.0 && x.is_normal();
        single && x.to_bits() & ((1 << 52) - 1) == 0
    }

    /// x + y or x − y, which is known to lie in `value`.
    pub fn sum(self, y: Self, value: Interval) -> Self {
        Self::once(value, self.error + y.error, self.format)
    }

    /// x y, which is known to lie in `value`.
    pub fn product(self, b: Self, value: Interval) -> Self {
        let carried = self.carried(b);
        if self.is_power_of_two() || b.is_power_of_two() {
            let fits = value.magnitude() + carried < self.format.most;
            let [error, own] = [carried + self.format.underflow, self.format.underflow]
                .map(|error| if fits { error } else { f64::INFINITY });
            return Self { value, error, own, ..self };
        }
        Self::once(value, carried, self.format)
    }

    /// x y + c or the like with other signs, which is known to lie in `value`: rounded once.
    pub fn mul_add(self, y: Self, c: Self, value: Interval) -> Self {
        Self::once(value, self.carried(y) + c.error, self.format)
    }

    /// What the errors of x and y do to x y.
    fn carried(self, y: Self) -> f64 {
        (self.magnitude() * y.error + y.magnitude() * self.error + self.error * y.error) * SPARE
    }

    /// |x|.
    pub fn abs(self) -> Self {
        let Interval { low, high } = self.value;
        let least = if low > 0.0 { low } else { (-high).max(0.0) };
        Self { value: Interval { low: least, high: self.magnitude() }, own: 0.0, ..self }
    }

    /// The number, no less than `low` and no more than `high`.
    pub fn clamp(self, low: Self, high: Self) -> Self {
        // min and max of two numbers are off by no more than the worse of the two.
        let held = |x: f64| x.max(low.value.low).min(high.value.high);
        let value = Interval { low: held(self.value.low), high: held(self.value.high) };
        Self { value, error: self.error.max(low.error).max(high.error), own: 0.0, ..self }
    }

    /// `above`, `below` or `otherwise` by the sign of the number, where rounding does not change it: see
    /// [`Rounded::sign_may_change`].
    pub fn select(self, above: Self, below: Self, otherwise: Self) -> Self {
        let Interval { low, high } = self.value;
        let may = [high > 0.0, low < 0.0, low <= 0.0 && high >= 0.0];
        let choices = [above, below, otherwise];
        let mut possible = choices.iter().zip(may).filter(|(_, may)| *may).map(|(choice, _)| *choice);
        let Some(first) = possible.next() else { return otherwise };
        possible.fold(Self { own: 0.0, ..first }, |all, choice| Self {
            value: all.value.hull(choice.value),
            error: all.error.max(choice.error),
            own: 0.0,
            ..self
        })
    }

    /// Whether rounding can change the sign.
    pub fn sign_may_change(self) -> bool {
        self.error > 0.0 && self.value.low <= self.error && self.value.high >= -self.error
    }
}

/// The largest power of 2 that is not above `x` ≥ 0; 0 for numbers that are not normal. Numbers up to `x` have neighbours no further
/// apart than 2u times it, so rounding to the nearest is off by no more than u times it.
fn power_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & f64::INFINITY.to_bits())
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.sum(b, self.value + b.value)
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.sum(b, self.value - b.value)
    }
}

impl Mul for Rounded {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        self.product(b, self.value * b.value)
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, own: 0.0, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::{Format, Rounded};
    use crate::numerics::interval::Interval;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    /// Pairs of f32, the same in f64, and the enclosure: sums and products of f32 are exact in f64 to 1e-15 of them.
    #[test]
    fn no_single_is_further_off_than_said() {
        let points = LowDiscrepancy::new(4);
        let mut most = 0.0_f64;
        for index in 0..20_000 {
            let u = points.point(index);
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| (8.0 * u[k] - 4.0) as f32);
            let exact = |x: f32| Rounded::input(Interval::point(f64::from(x)), Format::SINGLE);
            let literal = 0.1_f64;
            let computed = [(a * b - c * d) * (literal as f32) + a, (a - b).abs() * c, -(a * a) * 0.25 + d];
            let [x, y, z, w] = [a, b, c, d].map(f64::from);
            let real = [(x * y - z * w) * literal + x, (x - y).abs() * z, -(x * x) * 0.25 + w];
            let [x, y, z, w] = [a, b, c, d].map(exact);
            let constant = |c: f64| Rounded::constant(c, Format::SINGLE);
            let bound =
                [(x * y - z * w) * constant(literal) + x, (x - y).abs() * z, -(x * x) * constant(0.25) + w];
            for ((computed, real), bound) in computed.iter().zip(real).zip(bound) {
                let off = (f64::from(*computed) - real).abs();
                assert!(off <= bound.error + 1e-13, "{a} {b} {c} {d}: {off:e} > {:e}", bound.error);
                assert!(bound.value.low <= real && real <= bound.value.high);
                most = most.max(off / bound.error);
            }
        }
        assert!(most > 0.3, "the bound is above what is seen by {most}");
    }

    #[test]
    fn a_choice_is_as_good_as_its_worst_case() {
        let number = |low, high, error| Rounded::within(Interval { low, high }, error, Format::SINGLE);
        let [up, down, none] = [1.0, -1.0, 0.1].map(|x| Rounded::constant(x, Format::SINGLE));
        assert!(!number(0.1, 1.0, 1e-6).sign_may_change() && number(-1.0, 1.0, 1e-6).sign_may_change());
        assert!(!number(-1.0, 1.0, 0.0).sign_may_change(), "an input is what it is");
        assert_eq!(number(0.1, 1.0, 1e-6).select(up, down, none), up);
        let chosen = number(-1.0, 1.0, 1e-6).select(up, down, none);
        assert_eq!((chosen.value.low, chosen.value.high, chosen.error), (-1.0, 1.0, none.error));
        let held = number(-3.0, 3.0, 1e-6).clamp(down, up);
        assert_eq!((held.value.low, held.value.high, held.error), (-1.0, 1.0, 1e-6));
    }
}
