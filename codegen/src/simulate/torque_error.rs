//! The largest torque error of a model that a search finds: it stands beside the certified one and can only be smaller.

use crate::bounds::Rates;
use crate::domain::Measure;
use crate::lagrangian::{Combination, Values};
use crate::parallel::Parallelize;
use crate::pipeline::Generation;
use crate::reduction::plus;
use crate::torque::matrices;

/// Positions of the domain at which the search looks.
const POSITIONS: usize = 600;
/// Of an uncertain arm the positions, and the arms at each of them, at most.
const POSITIONS_OF_FAMILY: usize = 150;
const ARMS: usize = 16;

/// The largest |δD a_r + δC v_r + δG| by joint, N·m or N, at some positions of the domain, for the worst rates up to those of the
/// certified error. Of an uncertain arm those at some vertices of its intervals are looked at. Over a workspace where a joint lacks
/// a limit, `None`.
///
/// δG and the two products can be given one sign by turning rates round, so their largest magnitudes add up. What v_r and q̇
/// make of δC is raised by turns, from the signs of its largest entry.
pub fn largest_torque_error(generation: &Generation) -> Option<Vec<f64>> {
    let rates = &generation.torque()?.rates;
    let n = generation.arm().dof();
    let points = Measure::new(generation.domain(), generation.arm()).points;
    let arms = arms(generation);
    let positions = if arms.is_empty() { POSITIONS } else { POSITIONS_OF_FAMILY };
    let seen: Vec<&Vec<f64>> = points.iter().step_by(points.len().div_ceil(positions).max(1)).collect();
    let errors: Vec<Vec<f64>> = seen
        .into_par_iter()
        .flat_map_iter(|q| {
            let lagrangian = generation.lagrangian();
            let of = |[own, exact]: [Values; 2]| (0..n).map(|i| error(&own, &exact, rates, i)).collect();
            if arms.is_empty() {
                return vec![of(
                    [generation.code(), generation.exact_code()].map(|code| matrices(code, n, q))
                )];
            }
            let at =
                |arm: &[Vec<Combination>; 2]| of(arm.each_ref().map(|terms| lagrangian.at_with(terms, q)));
            arms.iter().map(at).collect()
        })
        .collect();
    let most = |i: usize| errors.iter().fold(0.0, |most: f64, error| most.max(error[i]));
    Some((0..n).map(most).collect())
}

/// The coefficients of model and arm at some vertices of the uncertain parameters' box; none where nothing is uncertain.
fn arms(generation: &Generation) -> Vec<[Vec<Combination>; 2]> {
    let (lagrangian, reduced) = (generation.lagrangian(), generation.reduced());
    let vertices: Vec<Vec<f64>> = match generation.uncertainty().parameters.is_empty() {
        true => Vec::new(),
        false => generation.uncertainty().vertices().collect(),
    };
    let every = vertices.len().div_ceil(ARMS).max(1);
    let moved = |terms: &Combination, variations: &[Combination], u: &[f64]| {
        variations.iter().zip(u).fold(terms.clone(), |sum, (variation, &u)| plus(&sum, u, variation))
    };
    let at = |u: &Vec<f64>| {
        let (mut own, mut exact) = (Vec::new(), Vec::new());
        for (m, coefficient) in lagrangian.coefficients.iter().enumerate() {
            exact.push(moved(&coefficient.terms, &coefficient.variations, u));
            let learnt = reduced.variations.get(m).map_or(&[][..], Vec::as_slice);
            own.push(moved(&reduced.combinations[m], learnt, u));
        }
        [own, exact]
    };
    vertices.iter().step_by(every).map(at).collect()
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
            if value.is_nan() || value <= last {
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
