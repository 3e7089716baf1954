//! θ̂, summed without loss.

use crate::Real;

/// The parameters θ̂ that an adaptive law has learnt, each with what its number type is too coarse to hold of it.
///
/// A correction far below an ulp of θ̂ would change nothing, however many there are; at 1 kHz in f32 they are soon that small. So
/// what one of them loses by rounding is kept for the next (Kahan's compensated sum).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate<T, const P: usize> {
    theta: [T; P],
    /// θ̂ without rounding, less `theta`: about half an ulp of `theta` at most.
    remainder: [T; P],
}

impl<T: Real, const P: usize> Estimate<T, P> {
    /// `theta` and nothing below it.
    pub const fn new(theta: [T; P]) -> Self {
        Self { theta, remainder: [T::ZERO; P] }
    }

    /// θ̂.
    pub const fn theta(&self) -> &[T; P] {
        &self.theta
    }

    /// Takes `correction` off θ̂ and brings the result into the box from `low` to `high`. What is infinite or NaN is not taken.
    // On its own, so that what it computes takes no room on the stack while the law runs.
    #[inline(never)]
    pub fn correct(&mut self, correction: &[T; P], low: &[T; P], high: &[T; P]) {
        for k in 0..P {
            let step = self.remainder[k] - correction[k];
            if !step.is_finite() {
                continue;
            }
            let theta = self.theta[k] + step;
            self.remainder[k] = step - (theta - self.theta[k]);
            self.theta[k] = theta;
            self.bring_inside(k, low[k], high[k]);
        }
    }

    /// Brings what was restored into the box from `low` to `high`; NaN becomes `initial`. What is inside stays as it is.
    pub fn project(&mut self, low: &[T; P], high: &[T; P], initial: &[T; P]) {
        for k in 0..P {
            self.bring_inside(k, low[k], high[k]);
            if !self.theta[k].is_finite() {
                (self.theta[k], self.remainder[k]) = (initial[k], T::ZERO);
            }
        }
    }

    // At the bound itself the remainder stays: without it no correction below half an ulp would ever leave the bound.
    #[inline]
    fn bring_inside(&mut self, k: usize, low: T, high: T) {
        if self.theta[k] > high {
            (self.theta[k], self.remainder[k]) = (high, T::ZERO);
        } else if self.theta[k] < low {
            (self.theta[k], self.remainder[k]) = (low, T::ZERO);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOW: [f32; 1] = [-1.0];
    const HIGH: [f32; 1] = [1.0];

    fn add(estimate: &mut Estimate<f32, 1>, increment: f32, times: usize) -> f32 {
        for _ in 0..times {
            estimate.correct(&[-increment], &LOW, &HIGH);
        }
        estimate.theta()[0]
    }

    #[test]
    fn corrections_below_an_ulp_add_up() {
        // An ulp of 0.5 is 6e-8.
        for (start, increment) in [(0.5, 1.1e-10), (0.5, -7.3e-9), (-0.75, 3.7e-11), (0.0, 1.3e-8)] {
            let mut estimate = Estimate::new([start]);
            let theta = add(&mut estimate, increment, 1_000_000);
            let exact = f64::from(start) + 1e6 * f64::from(increment);
            assert!((f64::from(theta) - exact).abs() <= 3e-8, "{theta} {exact}");
            let back = add(&mut estimate, -increment, 1_000_000);
            assert!((back - start).abs() <= 3e-8, "{back} {start}");
        }
    }

    #[test]
    fn the_box_cuts_and_nothing_winds_up_behind_it() {
        for sign in [1.0, -1.0] {
            let mut estimate = Estimate::new([0.0]);
            assert_eq!(add(&mut estimate, sign * 0.7, 1), sign * 0.7);
            assert_eq!(add(&mut estimate, sign * 0.7, 1000), sign);
            assert_eq!(add(&mut estimate, sign * 1e-9, 1000), sign);
            let theta = add(&mut estimate, sign * -1e-9, 1000);
            assert!(
                (theta - sign * (1.0 - 1e-6)).abs() <= 6e-8,
                "corrections below an ulp leave it: {theta}"
            );
        }
    }

    #[test]
    fn what_is_not_finite_is_not_taken() {
        let mut estimate = Estimate::new([0.5]);
        add(&mut estimate, 1e-8, 1);
        let before = estimate;
        for increment in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            add(&mut estimate, increment, 1);
            assert_eq!(estimate, before);
        }
        assert_eq!((add(&mut estimate, f32::MAX, 1), add(&mut estimate, f32::MIN, 1)), (1.0, -1.0));
        assert!(estimate.remainder[0] == 0.0);
    }

    #[test]
    fn what_is_put_back_comes_into_the_box() {
        let inside = |theta: f32| {
            let mut estimate = Estimate::new([theta]);
            estimate.project(&LOW, &HIGH, &[0.25]);
            estimate.theta()[0]
        };
        let put = [0.5, 7.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        assert_eq!(put.map(inside), [0.5, 1.0, 1.0, -1.0, 0.25]);
        let mut estimate = Estimate::new([0.5]);
        add(&mut estimate, 1e-8, 1);
        let before = estimate;
        estimate.project(&LOW, &HIGH, &[0.25]);
        assert_eq!(estimate, before, "what is inside keeps what is below its last digit");
    }
}
