//! When errors count as settled, where the specification does not say.

use nalgebra::{DMatrix, Schur};

use super::funnel::Funnel;
use super::problem::Problem;

/// Time constants of the slowest error after which it counts as settled.
const SETTLED: f64 = 8.0;
/// Iterations that each eigenvalue may take; a few are enough where they are found at all.
const MOST_ITERATIONS: usize = 100;

/// The time in which the slowest error of the loop that is frozen at the start falls to e⁻⁸ of itself, s; the duration of the motion
/// where none falls. An estimate: it says from when on errors are counted, and the count itself is a bound.
pub(super) fn settling(problem: &Problem, funnel: &Funnel) -> f64 {
    let slowest = funnel.frozen().and_then(|map| largest_eigenvalue(&map));
    slowest.and_then(|slowest| falls(slowest, problem.period)).unwrap_or(problem.motion.duration())
}

/// The largest |λ| of a square matrix; `None` where the iteration does not find the eigenvalues, as of numbers of very different sizes.
fn largest_eigenvalue(rows: &[Vec<f64>]) -> Option<f64> {
    let n = rows.len();
    let matrix = DMatrix::from_fn(n, n, |i, j| rows[i][j]);
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let schur = Schur::try_new(matrix, f64::EPSILON, MOST_ITERATIONS * n)?;
    Some(schur.complex_eigenvalues().iter().map(|x| libm::hypot(x.re, x.im)).fold(0.0, f64::max))
}

/// The time in which an error that is `factor` times as large after each period falls to e⁻⁸ of itself, s; `None` where it does not.
fn falls(factor: f64, period: f64) -> Option<f64> {
    let time = -SETTLED * period / libm::log(factor);
    (time > 0.0 && time.is_finite()).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::{falls, largest_eigenvalue};

    #[test]
    fn only_errors_that_fall_have_a_time_to_settle() {
        let time = falls(libm::exp(-0.004), 0.001).expect("they fall");
        assert!((time - 2.0).abs() < 1e-9, "{time}");
        for factor in [1.0, 1.5, f64::INFINITY, f64::NAN] {
            assert_eq!(falls(factor, 0.001), None, "{factor}");
        }
    }

    #[test]
    fn the_slowest_error_is_the_largest_eigenvalue() {
        let turned = vec![vec![0.3, -0.4, 0.0], vec![0.4, 0.3, 7.0], vec![0.0, 0.0, -0.2]];
        let slowest = largest_eigenvalue(&turned).expect("found");
        assert!((slowest - 0.5).abs() < 1e-12, "{slowest}");
        assert_eq!(largest_eigenvalue(&[vec![1.0, f64::NAN], vec![0.0, 1.0]]), None);
    }
}
