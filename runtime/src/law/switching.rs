//! The discontinuity of the robust laws, and its softened form.

use crate::{ConfigError, Real, Requirement};

/// How a robust law goes from one side of s_i = 0 to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Switching<T, const N: usize> {
    /// sgn s_i, zero at zero: no final error in continuous time, chatter in sampled time.
    Sign,
    /// sat(s_i/φ_i) with the layer half-widths φ, rad/s or m/s, positive: no chatter, a small final error.
    BoundaryLayer([T; N]),
}

impl<T: Real, const N: usize> Switching<T, N> {
    /// sgn s or sat(s/φ), element by element, within [−1, 1]; NaN where s is NaN.
    pub fn at(&self, s: &[T; N]) -> [T; N] {
        match self {
            Self::Sign => s.map(|x| {
                if x > T::ZERO {
                    T::ONE
                } else if x < T::ZERO {
                    -T::ONE
                } else {
                    // Keeps a NaN, so that the controller sees it.
                    x
                }
            }),
            Self::BoundaryLayer(phi) => core::array::from_fn(|i| {
                let x = s[i] / phi[i];
                if x > T::ONE {
                    T::ONE
                } else if x < -T::ONE {
                    -T::ONE
                } else {
                    x
                }
            }),
        }
    }

    /// Checks the layer's half-widths.
    ///
    /// # Errors
    /// Names the first joint whose φ is not positive and finite.
    pub fn check(&self) -> Result<(), ConfigError> {
        let Self::BoundaryLayer(phi) = self else { return Ok(()) };
        match phi.iter().position(|&x| !(x > T::ZERO && x.is_finite())) {
            None => Ok(()),
            joint => Err(ConfigError { parameter: "switching", joint, requirement: Requirement::Positive }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_from_one_side_to_the_other() {
        assert_eq!(Switching::<f64, 3>::Sign.at(&[1e-9, 0.0, -5.0]), [1.0, 0.0, -1.0]);
        assert_eq!(
            Switching::BoundaryLayer([0.5; 4]).at(&[0.6, 0.125, -0.25, -7.0]),
            [1.0, 0.25, -0.5, -1.0]
        );
        assert!(Switching::<f64, 1>::Sign.at(&[f64::NAN])[0].is_nan());
    }

    #[test]
    fn refuses_an_empty_layer() {
        let error =
            ConfigError { parameter: "switching", joint: Some(1), requirement: Requirement::Positive };
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Switching::BoundaryLayer([1.0, width]).check(), Err(error));
        }
    }
}
