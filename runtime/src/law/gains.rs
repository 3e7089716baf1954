//! The gains that all laws share.

use core::array::from_fn;

use super::{check_nonnegative, check_symmetric};
use crate::cholesky::Cholesky;
use crate::vector::mat_vec;
use crate::{ConfigError, Real, Requirement};

/// Gains of equations (12)–(18), by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains<T, const N: usize> {
    /// P12 = Pqq⁻¹ Ω, 1/s: symmetric, positive definite, no entry negative.
    pub p12: [[T; N]; N],
    /// K = W + Pqq Ω⁻¹ Pqq, the gain on s, N·m·s/rad.
    pub damping: [[T; N]; N],
    /// Pqq, N·m/rad: symmetric, positive definite.
    pub pqq: [[T; N]; N],
}

impl<T: Real, const N: usize> Gains<T, N> {
    /// Checks what the proof of (17) needs: Pqq, P12, Ω = Pqq P12 and W = K − Pqq Ω⁻¹ Pqq symmetric and positive
    /// definite, and P12 without a negative entry.
    ///
    /// # Errors
    /// Names the first matrix that fails.
    pub fn check(&self) -> Result<(), ConfigError> {
        check_nonnegative("p12", &self.p12)?;
        let p12 = factor("p12", &self.p12)?;
        factor("pqq", &self.pqq)?;
        check_symmetric("damping", &self.damping)?;
        let columns: [_; N] = from_fn(|j| mat_vec(&self.pqq, &self.p12.map(|row| row[j])));
        factor::<T, N>("omega", &from_fn(|i| from_fn(|j| columns[j][i])))?;
        // Pqq Ω⁻¹ Pqq = Pqq P12⁻¹; both factors are symmetric, so its rows are P12⁻¹ times the rows of Pqq.
        let needed = self.pqq.map(|row| p12.solve(&row));
        factor::<T, N>("damping", &from_fn(|i| from_fn(|j| self.damping[i][j] - needed[i][j])))?;
        Ok(())
    }
}

fn factor<T: Real, const N: usize>(
    parameter: &'static str,
    matrix: &[[T; N]; N],
) -> Result<Cholesky<T, N>, ConfigError> {
    check_symmetric(parameter, matrix)?;
    let error = ConfigError { parameter, joint: None, requirement: Requirement::PositiveDefinite };
    Cholesky::new(matrix).ok_or(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    // W = diag(1, 2), Pqq = diag(4, 1), Ω = diag(2, 3).
    const GOOD: Gains<f64, 2> = Gains {
        p12: [[0.5, 0.0], [0.0, 3.0]],
        damping: [[9.0, 0.0], [0.0, 7.0 / 3.0]],
        pqq: [[4.0, 0.0], [0.0, 1.0]],
    };

    fn failure(gains: Gains<f64, 2>) -> (&'static str, Requirement) {
        gains.check().map_or_else(|e| (e.parameter, e.requirement), |()| ("none", Requirement::Finite))
    }

    #[test]
    fn accepts_what_the_proof_needs_and_no_less() {
        assert_eq!(GOOD.check(), Ok(()));
        // Just under Pqq Ω⁻¹ Pqq = 8: W is no longer positive definite.
        assert_eq!(
            failure(Gains { damping: [[7.99, 0.0], [0.0, 3.0]], ..GOOD }),
            ("damping", Requirement::PositiveDefinite)
        );
        assert_eq!(
            failure(Gains { damping: [[9.0, 1.0], [0.0, 3.0]], ..GOOD }),
            ("damping", Requirement::Symmetric)
        );
        assert_eq!(
            failure(Gains { p12: [[1.0, -0.1], [-0.1, 1.0]], ..GOOD }),
            ("p12", Requirement::NonNegative)
        );
        assert_eq!(
            failure(Gains { p12: [[1.0, 2.0], [2.0, 1.0]], ..GOOD }),
            ("p12", Requirement::PositiveDefinite)
        );
        assert_eq!(failure(Gains { pqq: [[f64::NAN; 2]; 2], ..GOOD }), ("pqq", Requirement::Finite));
        assert_eq!(
            failure(Gains { p12: [[0.5, 0.1], [0.1, 3.0]], ..GOOD }),
            ("omega", Requirement::Symmetric)
        );
    }
}
