//! Matrix inequalities that are proved, not computed: what an eigenvalue iteration gives is a guess, which a Cholesky
//! factorisation then confirms.
//!
//! Where the factorisation of a symmetric A of order n runs to its end in floating point with unit roundoff u, the factor
//! is that of A + E with |E_ij| ≤ γ_{n+1}/(1 − γ_{n+1}) √(a_ii a_jj) (Higham, Accuracy and Stability of Numerical
//! Algorithms, 2002, theorem 10.3), so A ≽ −2nγ_{n+1} diag(A). Taken off beforehand, with what rounding did to the entries
//! of A, this leaves a proof that A ≽ 0. It is relative to the diagonal, so that light joints are not charged for heavy
//! ones.

use nalgebra::DMatrix;

/// Unit roundoff.
const U: f64 = 0.5 * f64::EPSILON;
/// By how much a guess is raised before its first trial, relative, and by what factor from one trial to the next.
const FIRST: f64 = 1e-13;
const STEP: f64 = 16.0;
const TRIALS: i32 = 11;

/// A bound on λ_max(A⁻¹B) from above for symmetric A and B ≽ 0 near `guess`: the first μ tried for which μA − B ≽ 0 is
/// proved. Infinite where none is.
pub(super) fn largest_ratio(a: &DMatrix<f64>, b: &DMatrix<f64>, guess: f64) -> f64 {
    raised(guess, |mu| dominates(mu, a, b))
}

/// Bounds on (A⁻¹)_ii from above for symmetric A near `guesses`; infinite where nothing is proved.
///
/// (A⁻¹)_ii ≤ m where A − e_i e_iᵀ/m ≽ 0 and A ≻ 0, by the Schur complement.
pub(super) fn inverse_diagonal(a: &DMatrix<f64>, guesses: &[f64]) -> Vec<f64> {
    let n = a.nrows();
    let mut unit = DMatrix::zeros(n, n);
    let mut bound = |(i, guess): (usize, &f64)| {
        unit[(i, i)] = 1.0;
        let bound = raised(*guess, |m| dominates(m, a, &unit));
        unit[(i, i)] = 0.0;
        bound
    };
    guesses.iter().enumerate().map(&mut bound).collect()
}

/// A bound on λ_max(A) of A ≽ 0 from above; infinite where none is proved.
pub(super) fn largest_eigenvalue(a: &DMatrix<f64>) -> f64 {
    // The iteration need not end on NaN.
    if !a.iter().all(|entry| entry.is_finite()) {
        return f64::INFINITY;
    }
    let guess = a.clone().symmetric_eigenvalues().max();
    largest_ratio(&DMatrix::identity(a.nrows(), a.nrows()), a, guess)
}

/// A bound on λ_min(A) from below; 0 where nothing better is proved.
pub(super) fn least_eigenvalue(a: &DMatrix<f64>) -> f64 {
    if !a.iter().all(|entry| entry.is_finite()) {
        return 0.0;
    }
    let guess = a.clone().symmetric_eigenvalues().min();
    let unit = DMatrix::identity(a.nrows(), a.nrows());
    if guess > 0.0 { (1.0 / largest_ratio(a, &unit, 1.0 / guess)).next_down().max(0.0) } else { 0.0 }
}

/// Bounds on |A⁻¹|, entry by entry, from a computed inverse X; `None` where X is too far from it to say.
///
/// With R = A X − 1, |A⁻¹ − X| ≤ |X| (|R| + |R|² + …), and |R|^k is summed column by column from k = 2 on.
pub(super) fn inverse_entries(a: &DMatrix<f64>, x: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let rounding = 2.0 * (n as f64 + 2.0) * U;
    let residual = DMatrix::from_fn(n, n, |i, j| {
        let unit = if i == j { 1.0 } else { 0.0 };
        let (mut sum, mut size) = (-unit, unit);
        for k in 0..n {
            let term = a[(i, k)] * x[(k, j)];
            sum += term;
            size += term.abs();
        }
        sum.abs() + rounding * size
    });
    let row = |i: usize| (0..n).map(|j| residual[(i, j)]).sum::<f64>();
    let norm = (0..n).map(row).fold(0.0, f64::max);
    if norm.is_nan() || norm >= 0.5 {
        return None;
    }
    let tail = |j: usize| (0..n).map(|i| residual[(i, j)]).fold(0.0, f64::max) * norm / (1.0 - norm);
    let off =
        |i: usize, j: usize| (0..n).map(|k| x[(i, k)].abs() * (residual[(k, j)] + tail(j))).sum::<f64>();
    Some(DMatrix::from_fn(n, n, |i, j| (x[(i, j)].abs() + off(i, j)) * (1.0 + rounding)))
}

/// The first of some values slightly above `guess` that is `enough`.
fn raised(guess: f64, mut enough: impl FnMut(f64) -> bool) -> f64 {
    if !(guess.is_finite() && guess > 0.0) {
        return f64::INFINITY;
    }
    let mut excess = FIRST;
    for _ in 0..TRIALS {
        let value = guess * (1.0 + excess);
        if enough(value) {
            return value;
        }
        excess *= STEP;
    }
    f64::INFINITY
}

/// Whether μA − B ≽ 0 and, for B ≽ 0, A ≽ 0 is proved.
fn dominates(mu: f64, a: &DMatrix<f64>, b: &DMatrix<f64>) -> bool {
    let n = a.nrows();
    let size = |i: usize, j: usize| (mu * a[(i, j)]).abs() + b[(i, j)].abs();
    let scale: Vec<f64> = (0..n).map(|i| libm::sqrt(size(i, i))).collect();
    let mut m = DMatrix::from_fn(n, n, |i, j| mu * a[(i, j)] - b[(i, j)]);
    let factor = 4.0 * n as f64 * (n as f64 + 2.0) * U;
    for i in 0..n {
        let entries: f64 = (0..n).map(|j| size(i, j) * scale[i] / scale[j]).sum();
        m[(i, i)] -= 8.0 * U * entries + factor * size(i, i);
    }
    factorises(m)
}

/// Whether the Cholesky factorisation runs to its end.
fn factorises(mut m: DMatrix<f64>) -> bool {
    let n = m.nrows();
    for j in 0..n {
        for i in j..n {
            let mut sum = m[(i, j)];
            for k in 0..j {
                sum -= m[(i, k)] * m[(j, k)];
            }
            if i > j {
                m[(i, j)] = sum / m[(j, j)];
            } else if sum > 0.0 && sum.is_finite() {
                m[(j, j)] = libm::sqrt(sum);
            } else {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Hilbert matrix scaled to integers, as far as f64 holds it exactly: its inverse is known.
    fn hilbert(n: usize) -> (DMatrix<f64>, DMatrix<f64>) {
        // lcm(1, …, 2n − 1) for n = 5.
        let all = 2520.0;
        let choose = |n: usize, k: usize| (0..k).fold(1.0, |p, i| p * (n - i) as f64 / (i + 1) as f64);
        let inverse = |i: usize, j: usize| {
            let sign = if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
            let entries = choose(n + i, n - j - 1) * choose(n + j, n - i - 1);
            sign * (i + j + 1) as f64 * entries * choose(i + j, i) * choose(i + j, i)
        };
        let matrix = DMatrix::from_fn(n, n, |i, j| all / (i + j + 1) as f64);
        (matrix, DMatrix::from_fn(n, n, |i, j| inverse(i, j) / all))
    }

    #[test]
    fn an_ill_conditioned_inverse_is_enclosed() {
        let (a, exact) = hilbert(5);
        let x = a.clone().cholesky().unwrap().inverse();
        let guesses: Vec<f64> = (0..5).map(|i| x[(i, i)]).collect();
        for (i, bound) in inverse_diagonal(&a, &guesses).into_iter().enumerate() {
            println!("{bound:.17e} above {:.17e}", exact[(i, i)]);
            assert!(bound >= exact[(i, i)] && bound < exact[(i, i)] * (1.0 + 1e-7));
        }
        // A guess that is too low is not believed: the answer is above the truth, or nothing.
        for (i, bound) in
            inverse_diagonal(&a, &guesses.iter().map(|g| 0.9 * g).collect::<Vec<_>>()).into_iter().enumerate()
        {
            assert!(bound >= exact[(i, i)]);
        }
        let entries = inverse_entries(&a, &x).unwrap();
        for (bound, exact) in entries.iter().zip(exact.iter()) {
            assert!(*bound >= exact.abs() && *bound < exact.abs() * (1.0 + 1e-6));
        }
        let least = least_eigenvalue(&a);
        assert!(least > 0.0 && least <= 1.0 / exact.symmetric_eigenvalues().max());
    }

    #[test]
    fn a_matrix_that_is_singular_or_worse_has_no_bound() {
        let m = |d: f64| DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, d]);
        for a in [m(1.0), m(1.0 - 1e-12), m(-3.0)] {
            assert_eq!(inverse_diagonal(&a, &[1e9, 1e9]), [f64::INFINITY; 2]);
            assert_eq!(least_eigenvalue(&a), 0.0);
        }
        let (a, _) = hilbert(5);
        assert_eq!(inverse_entries(&a, &DMatrix::zeros(5, 5)), None);
        assert!(inverse_diagonal(&m(f64::NAN), &[1.0, 1.0]).iter().all(|b| b.is_infinite()));
    }
}
