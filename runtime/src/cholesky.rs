//! Solving with a symmetric positive definite matrix.

use crate::Real;

/// The factor L of A = L Lᵀ, lower triangle, by rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cholesky<T, const N: usize> {
    lower: [[T; N]; N],
}

impl<T: Real, const N: usize> Cholesky<T, N> {
    /// Factors A from its lower triangle; `None` when A is not positive definite or not finite.
    pub(crate) fn new(matrix: &[[T; N]; N]) -> Option<Self> {
        let mut lower = [[T::ZERO; N]; N];
        for i in 0..N {
            for j in 0..=i {
                let before = lower[i].iter().zip(&lower[j]).take(j);
                let sum = before.fold(matrix[i][j], |sum, (&a, &b)| sum - a * b);
                lower[i][j] = if i == j {
                    // NaN compares false, so it is refused here too.
                    if !(sum > T::ZERO && sum.is_finite()) {
                        return None;
                    }
                    sum.sqrt()
                } else {
                    sum / lower[j][j]
                };
            }
        }
        Some(Self { lower })
    }

    /// x with A x = b.
    pub(crate) fn solve(&self, b: &[T; N]) -> [T; N] {
        let mut x = *b;
        for i in 0..N {
            for k in 0..i {
                x[i] -= self.lower[i][k] * x[k];
            }
            x[i] = x[i] / self.lower[i][i];
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                x[i] -= self.lower[k][i] * x[k];
            }
            x[i] = x[i] / self.lower[i][i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::mat_vec;

    #[test]
    fn solves_a_hilbert_like_system() {
        let a: [[f64; 5]; 5] = core::array::from_fn(|i| {
            core::array::from_fn(|j| 1.0 / ((i + j + 1) as f64) + f64::from(i == j))
        });
        let x = [1.0, -2.0, 3.0, 0.5, 7.0];
        let solved = Cholesky::new(&a).map(|factor| factor.solve(&mat_vec(&a, &x)));
        let solved = solved.unwrap_or([f64::NAN; 5]);
        for (found, expected) in solved.iter().zip(&x) {
            assert!((found - expected).abs() < 1e-13, "{solved:?}");
        }
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]]).is_none());
        assert!(Cholesky::new(&[[0.0]]).is_none());
        assert!(Cholesky::new(&[[f64::NAN]]).is_none());
        assert!(Cholesky::new(&[[f64::INFINITY]]).is_none());
        assert!(Cholesky::new(&[[1.0, f64::NAN], [f64::NAN, 1.0]]).is_none());
    }
}
