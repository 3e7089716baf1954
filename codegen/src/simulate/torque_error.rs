//! The largest torque error of a model that a search finds: it stands beside the certified one and can only be smaller.

use crate::bounds::Rates;
use crate::domain::Measure;
use crate::lagrangian::Values;
use crate::parallel::Parallelize;
use crate::pipeline::Generation;
use crate::torque::matrices;

/// Positions of the domain at which the search looks.
const POSITIONS: usize = 600;

/// The largest |δD a_r + δC v_r + δG| by joint, N·m or N, at some positions of the domain, for the worst rates up to those of the
/// certified error: of the arm as specified, in f64. Over a workspace where a joint lacks a limit, `None`.
///
/// δG and the two products can be given one sign by turning rates round, so their largest magnitudes add up. What v_r and q̇
/// make of δC is raised by turns, from the signs of its largest entry.
pub fn largest_torque_error(generation: &Generation) -> Option<Vec<f64>> {
    let rates = &generation.torque()?.rates;
    let n = generation.arm().dof();
    let points = Measure::new(generation.domain(), generation.arm()).points;
    let every = points.len().div_ceil(POSITIONS).max(1);
    let seen: Vec<&Vec<f64>> = points.iter().step_by(every).collect();
    let errors: Vec<Vec<f64>> = seen
        .into_par_iter()
        .map(|q| {
            let [own, exact] = [generation.code(), generation.exact_code()].map(|code| matrices(code, n, q));
            (0..n).map(|i| error(&own, &exact, rates, i)).collect()
        })
        .collect();
    let most = |i: usize| errors.iter().fold(0.0, |most: f64, error| most.max(error[i]));
    Some((0..n).map(most).collect())
}

/// The largest error of joint `i` at one position.
fn error(own: &Values, exact: &Values, rates: &Rates, i: usize) -> f64 {
    let n = own.gravity.len();
    let gravity = (own.gravity[i] - exact.gravity[i]).abs();
    let inertia: f64 = (0..n)
        .map(|j| (own.mass_matrix[i][j] - exact.mass_matrix[i][j]).abs() * rates.reference_acceleration[j])
        .sum();
    let products: Vec<Vec<f64>> = (0..n)
        .map(|j| {
            let entry = |k: usize| {
                let off = own.christoffel[i][j][k] - exact.christoffel[i][j][k];
                off * rates.reference_speed[j] * rates.speed[k]
            };
            (0..n).map(entry).collect()
        })
        .collect();
    gravity + inertia + bilinear(&products)
}

/// A large value of Σ_jk M_jk x_j y_k for |x_j|, |y_k| ≤ 1: attained by signs.
fn bilinear(m: &[Vec<f64>]) -> f64 {
    let n = m.len();
    let mut best = 0.0_f64;
    // Each row's own signs are one start.
    for start in 0..n {
        let mut y: Vec<f64> = m[start].iter().map(|m| if *m < 0.0 { -1.0 } else { 1.0 }).collect();
        let mut last = 0.0;
        loop {
            let rows: Vec<f64> = m.iter().map(|row| row.iter().zip(&y).map(|(m, y)| m * y).sum()).collect();
            let columns: Vec<f64> = (0..n)
                .map(|k| (0..n).map(|j| if rows[j] < 0.0 { -m[j][k] } else { m[j][k] }).sum())
                .collect();
            let value: f64 = columns.iter().map(|c| c.abs()).sum();
            // Not a comparison with ≤: a NaN ends it as well.
            if !(value > last) {
                break;
            }
            last = value;
            y = columns.iter().map(|c| if *c < 0.0 { -1.0 } else { 1.0 }).collect();
        }
        best = best.max(last);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::bilinear;

    #[test]
    fn turns_reach_the_largest_value_of_small_matrices() {
        let cases = [
            vec![vec![1.0, -2.0], vec![3.0, 4.0]],
            vec![vec![0.5, 1.0, -1.0], vec![-2.0, 0.25, 1.0], vec![1.0, 1.0, 3.0]],
        ];
        for m in cases {
            let n = m.len();
            let sign = |bits: usize, i: usize| if bits >> i & 1 == 1 { 1.0 } else { -1.0 };
            let value = |x: usize, y: usize| -> f64 {
                (0..n)
                    .flat_map(|j| (0..n).map(move |k| (j, k)))
                    .map(|(j, k)| m[j][k] * sign(x, j) * sign(y, k))
                    .sum()
            };
            let corners = (0..1 << n).flat_map(|x| (0..1 << n).map(move |y| (x, y)));
            let most = corners.map(|(x, y)| value(x, y)).fold(0.0, f64::max);
            assert!((bilinear(&m) - most).abs() < 1e-12, "{} {most}", bilinear(&m));
        }
    }
}
