//! The set of errors at a sample: a zonotope in x = (q_e, q̇_e).

mod image;

pub(super) use image::{Image, Known};

use crate::control::Gains;
use crate::numerics::linalg::weighed;
use image::combine;

/// Generators for each component of x that are kept when others are boxed.
const KEPT: usize = 60;
/// More than what the roundings of a sum of a few thousand numbers take off it.
const UP: f64 = 1.0 + 1e-12;
/// A bound on what a product of 2n numbers rounds by, relative to what is summed.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// {centre + Σ_m (u_m g_m + (2u_m² − 1) h_m) + Σ_g ε_g generator_g + b}, |u_m| ≤ 1, |ε_g| ≤ 1, |b| ≤ `boxed`.
///
/// The u_m are the uncertain numbers: they are the same at every sample.
#[derive(Clone, Debug)]
pub(super) struct ErrorSet {
    n: usize,
    pub(super) centre: Vec<f64>,
    /// All g_m, then all h_m.
    pub(super) shared: Vec<Vec<f64>>,
    /// Component by component.
    rows: Vec<Vec<f64>>,
    pub(super) boxed: Vec<f64>,
}

impl ErrorSet {
    /// |q_e| ≤ `position`, |q̇_e| ≤ `velocity`, with that many uncertain numbers.
    pub(super) fn new(position: &[f64], velocity: &[f64], numbers: usize) -> Self {
        let n = position.len();
        let mut set = Self {
            n,
            centre: vec![0.0; 2 * n],
            shared: vec![vec![0.0; 2 * n]; 2 * numbers],
            rows: vec![Vec::new(); 2 * n],
            boxed: vec![0.0; 2 * n],
        };
        for (k, &half) in position.iter().chain(velocity).enumerate() {
            if half > 0.0 {
                set.add_axis(k, half);
            }
        }
        set
    }

    /// The same centre and shared generators alone.
    pub(super) fn middle(&self) -> Self {
        let mut out = self.clone();
        out.rows.iter_mut().for_each(Vec::clear);
        out.boxed.fill(0.0);
        out
    }

    /// What is left of it where `middle` is subtracted, each uncertain number by itself.
    pub(super) fn less(&self, middle: &Self) -> Self {
        let mut out = self.clone();
        for k in 0..2 * self.n {
            let mut size = self.centre[k].abs() + middle.centre[k].abs();
            out.centre[k] -= middle.centre[k];
            for (shared, other) in out.shared.iter_mut().zip(&middle.shared) {
                size += shared[k].abs() + other[k].abs();
                shared[k] -= other[k];
            }
            out.boxed[k] += ROUNDING * size;
        }
        out
    }

    /// Number of generators that are not shared.
    pub(super) fn generators(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// Adds a generator along component `k`.
    pub(super) fn add_axis(&mut self, k: usize, half: f64) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            row.push(if i == k { half } else { 0.0 });
        }
    }

    /// Adds a generator.
    pub(super) fn add(&mut self, generator: impl Iterator<Item = f64>) {
        self.rows.iter_mut().zip(generator).for_each(|(row, part)| row.push(part));
    }

    /// The image under the rows of `map`, each of 2n numbers.
    pub(super) fn image(&self, map: &[Vec<f64>]) -> Image {
        let count = self.generators();
        let columns = 1 + self.shared.len() + count;
        let mut rows = Vec::with_capacity(map.len());
        let mut boxed = Vec::with_capacity(map.len());
        for weights in map {
            let mut row = vec![0.0; columns];
            let (apart, own) = row.split_at_mut(1 + self.shared.len());
            for (out, known) in apart.iter_mut().zip([&self.centre].into_iter().chain(&self.shared)) {
                *out = weights.iter().zip(known).map(|(weight, x)| weight * x).sum();
            }
            combine(weights, &self.rows, own);
            rows.push(row);
            boxed.push(weighed(weights, &self.boxed));
        }
        Image { shared: self.shared.len(), rows, boxed }
    }

    /// Bound by component on |x|.
    pub(super) fn hull(&self) -> Vec<f64> {
        (0..2 * self.n)
            .map(|k| {
                let shared: f64 = self.shared.iter().map(|shared| shared[k].abs()).sum();
                let own: f64 = self.rows[k].iter().map(|part| part.abs()).sum();
                UP * (self.centre[k].abs() + shared + own + self.boxed[k])
            })
            .collect()
    }

    /// x becomes `map` x; what that rounds goes to the boxed part.
    pub(super) fn mapped(&mut self, map: &[Vec<f64>]) {
        let sizes = self.hull();
        let image = self.image(map);
        let apart = 1 + self.shared.len();
        for (k, mut row) in image.rows.into_iter().enumerate() {
            let own = row.split_off(apart);
            self.centre[k] = row[0];
            for (shared, part) in self.shared.iter_mut().zip(&row[1..]) {
                shared[k] = *part;
            }
            self.rows[k] = own;
            let size: f64 = map[k].iter().zip(&sizes).map(|(weight, size)| weight.abs() * size).sum();
            self.boxed[k] = UP * (image.boxed[k] + ROUNDING * size);
        }
    }

    /// Keeps the longest generators and boxes the others in the coordinates (q_e, s), Girard (2005).
    pub(super) fn reduce(&mut self, gains: &Gains) {
        let (n, kept) = (self.n, 2 * KEPT * self.n);
        let limit = kept + kept / 2;
        let count = self.generators();
        if count <= limit {
            return;
        }
        let turned = self.turned(gains);
        let weight = |g: usize| {
            let parts = turned.iter().map(|row| row[g].abs());
            let (sum, most) = parts.fold((0.0, 0.0_f64), |(sum, most), x| (sum + x, most.max(x)));
            sum - most
        };
        let mut order: Vec<(f64, usize)> = (0..count).map(|g| (weight(g), g)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let (long, short) = order.split_at(kept - 2 * n);
        let mut stay: Vec<usize> = long.iter().map(|(_, g)| *g).collect();
        stay.sort_unstable();
        let mut half: Vec<f64> =
            turned.iter().map(|row| UP * short.iter().map(|(_, g)| row[*g].abs()).sum::<f64>()).collect();
        // The boxed part joins them, with what the turn to (q_e, s) has rounded.
        let size = |k: usize| short.iter().map(|(_, g)| self.rows[k][*g].abs()).sum::<f64>();
        let sizes: Vec<f64> = (0..2 * n).map(size).collect();
        for i in 0..n {
            half[i] += self.boxed[i];
            let pulled = |x: &[f64]| -> f64 { (0..n).map(|j| gains.p12[i][j].abs() * x[j]).sum() };
            half[n + i] += self.boxed[n + i] + pulled(&self.boxed);
            half[n + i] += ROUNDING * (sizes[n + i] + pulled(&sizes));
        }
        self.boxed.fill(0.0);
        for row in &mut self.rows {
            *row = stay.iter().map(|&g| row[g]).collect();
        }
        self.add_box(gains, &half);
    }

    /// Adds all (q_e, s) with |q_e,i| ≤ half_i and |s_i| ≤ half_(n+i).
    pub(super) fn add_box(&mut self, gains: &Gains, half: &[f64]) {
        let n = self.n;
        for (k, &half) in half.iter().enumerate().filter(|(_, half)| **half > 0.0) {
            // s = q̇_e + P12 q_e: with s = 0 the speed is −P12 q_e.
            let part = |i: usize| match (k < n, i < n) {
                (true, true) | (false, false) => {
                    if i == k {
                        half
                    } else {
                        0.0
                    }
                }
                (true, false) => -gains.p12[i - n][k] * half,
                (false, true) => 0.0,
            };
            let generator: Vec<f64> = (0..2 * n).map(part).collect();
            self.add(generator.into_iter());
            if k < n {
                for i in 0..n {
                    self.boxed[n + i] += ROUNDING * gains.p12[i][k].abs() * half;
                }
            }
        }
    }

    /// Bounds on |q_e|, then on |s|, by joint: the box of the set in these coordinates.
    pub(super) fn turned_hull(&self, gains: &Gains) -> Vec<f64> {
        let n = self.n;
        let mut map = vec![vec![0.0; 2 * n]; 2 * n];
        for i in 0..n {
            map[i][i] = 1.0;
            map[n + i][n + i] = 1.0;
            map[n + i][..n].copy_from_slice(&gains.p12[i]);
        }
        let sizes = self.hull();
        let image = self.image(&map);
        let rounded = |k: usize| -> f64 { map[k].iter().zip(&sizes).map(|(w, x)| w.abs() * x).sum() };
        image.sizes().into_iter().enumerate().map(|(k, size)| size + ROUNDING * rounded(k)).collect()
    }

    /// The generators in the coordinates (q_e, s).
    fn turned(&self, gains: &Gains) -> Vec<Vec<f64>> {
        let n = self.n;
        let mut out = self.rows.clone();
        for i in 0..n {
            for j in 0..n {
                let weight = gains.p12[i][j];
                if weight != 0.0 {
                    let (q, s) = (&self.rows[j], &mut out[n + i]);
                    s.iter_mut().zip(q).for_each(|(s, q)| *s += weight * q);
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests;
