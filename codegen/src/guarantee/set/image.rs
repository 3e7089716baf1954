//! Images of a set of errors, and their products with uncertain numbers.

use super::{ROUNDING, UP};
use crate::numerics::linalg::weighed;

/// The image of a set under a linear map, for further maps: of centre and shared generators, then of the others.
pub(in crate::guarantee) struct Image {
    /// Number of shared generators.
    pub(super) shared: usize,
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) boxed: Vec<f64>,
}

/// A number as 1, u_m and 2u_m² − 1 make it, and what it differs from that by.
pub(in crate::guarantee) struct Known {
    /// The weights of 1, of all u_m, of all 2u_m² − 1.
    pub(in crate::guarantee) weights: Vec<f64>,
    pub(in crate::guarantee) rest: f64,
}

impl Image {
    /// Adds `parts` to the shared generator `m`, or to the centre where it is `None`.
    pub(in crate::guarantee) fn add(&mut self, m: Option<usize>, parts: &[f64]) {
        let at = m.map_or(0, |m| m + 1);
        for (row, part) in self.rows.iter_mut().zip(parts) {
            if let Some(place) = row.get_mut(at) {
                *place += part;
            }
        }
    }

    /// Bound on each component.
    pub(in crate::guarantee) fn sizes(&self) -> Vec<f64> {
        let size = |(row, boxed): (&Vec<f64>, &f64)| UP * (row.iter().map(|x| x.abs()).sum::<f64>() + boxed);
        self.rows.iter().zip(&self.boxed).map(size).collect()
    }

    /// The product of component `i` and uncertain number `m`, whose value is `middle` + `half` u_m.
    pub(in crate::guarantee) fn times_number(&self, i: usize, m: usize, middle: f64, half: f64) -> Known {
        let (known, own) = self.rows[i].split_at(1 + self.shared);
        let numbers = self.shared / 2;
        let mut weights: Vec<f64> = known.iter().map(|x| middle * x).collect();
        // u_m² = ½ + ½(2u_m² − 1); any other product of two of them is no larger than 1.
        let (first, square) = (known[1 + m], 1 + numbers + m);
        weights[1 + m] += half * known[0];
        weights[0] += 0.5 * half * first;
        weights[square] += 0.5 * half * first;
        let size = |x: &[f64]| x.iter().map(|x| x.abs()).sum::<f64>();
        let others = size(&known[1..]) - first.abs();
        let own = size(own) + self.boxed[i];
        let rounded = ROUNDING * half * (size(known) + first.abs());
        Known { weights, rest: UP * (half * others + (middle.abs() + half) * own + rounded) }
    }

    /// The image of this one under `map`, n×n by rows.
    pub(in crate::guarantee) fn under(&self, map: &[f64]) -> Self {
        let row = |weights: &[f64]| {
            let mut out = vec![0.0; self.rows.first().map_or(0, Vec::len)];
            combine(weights, &self.rows, &mut out);
            (out, weighed(weights, &self.boxed))
        };
        let (rows, boxed) = map.chunks(self.rows.len().max(1)).map(row).unzip();
        Self { shared: self.shared, rows, boxed }
    }

    /// Bound on each component of `map` applied to this one.
    pub(in crate::guarantee) fn sizes_under(&self, map: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.rows.first().map_or(0, Vec::len)];
        let row = |weights: &[f64]| {
            combine(weights, &self.rows, &mut out);
            UP * (out.iter().map(|x| x.abs()).sum::<f64>() + weighed(weights, &self.boxed))
        };
        map.chunks(self.rows.len().max(1)).map(row).collect()
    }
}

/// Columns that are summed together: their sums stay in registers.
const TOGETHER: usize = 8;

/// `out` = Σ_k weights_k rows_k.
pub(super) fn combine(weights: &[f64], rows: &[Vec<f64>], out: &mut [f64]) {
    let whole = out.len() / TOGETHER * TOGETHER;
    let (body, tail) = out.split_at_mut(whole);
    for (c, out) in body.chunks_exact_mut(TOGETHER).enumerate() {
        let mut sums = [0.0; TOGETHER];
        let from = c * TOGETHER;
        for (weight, row) in weights.iter().zip(rows) {
            if let Some(parts) = row.get(from..from + TOGETHER) {
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * part);
            }
        }
        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum);
    }
    for (c, out) in (whole..).zip(tail) {
        *out = weights.iter().zip(rows).map(|(weight, row)| weight * row[c]).sum();
    }
}
