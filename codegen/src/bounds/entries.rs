//! Bounds by entry of D, h and G.

use serde::{Deserialize, Serialize};

use super::{Certificate, Rates, rounding};
use crate::dynamics::{Size, Sizes};
use crate::lagrangian::{Coefficient, Entry, Lagrangian};

/// Decimal digits of published bounds.
pub(super) const DIGITS: usize = 6;

/// `x` with six digits, rounded up.
pub fn six_digits_up(x: f64) -> f64 {
    rounding::up(x, DIGITS)
}

/// Element-by-element bounds (26)–(28) over a domain, zero where the model is exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// ΔD, n×n.
    pub d: Vec<Vec<f64>>,
    /// Δh_ijk, n×n×n.
    pub h: Vec<Vec<Vec<f64>>>,
    /// ΔB of the diagonal viscous friction, n.
    pub b: Vec<f64>,
    /// ΔG, n.
    pub g: Vec<f64>,
}

impl Bounds {
    /// True where every bound is a finite number.
    pub fn is_finite(&self) -> bool {
        let h = self.h.iter().flatten();
        self.d.iter().chain(h).chain([&self.b, &self.g]).flatten().all(|v| v.is_finite())
    }

    /// True where nothing is left out.
    pub fn is_zero(&self) -> bool {
        let h = self.h.iter().flatten();
        self.d.iter().chain(h).chain([&self.b, &self.g]).flatten().all(|&v| v == 0.0)
    }

    /// Spreads one bound for each coefficient over the places where it stands; ΔB = 0.
    pub fn new(lagrangian: &Lagrangian, deltas: &[f64]) -> Self {
        let n = lagrangian.dof;
        let zero = vec![0.0; n];
        let mut out =
            Self { d: vec![zero.clone(); n], h: vec![vec![zero.clone(); n]; n], b: zero.clone(), g: zero };
        for (coefficient, &delta) in lagrangian.coefficients.iter().zip(deltas) {
            for place in &coefficient.places {
                out.set(place.entry, delta);
            }
        }
        out
    }

    /// Sets the bound of one entry, and of that which is equal to it by symmetry.
    pub(super) fn set(&mut self, entry: Entry, delta: f64) {
        match entry {
            Entry::D(i, j) => {
                self.d[i][j] = delta;
                self.d[j][i] = delta;
            }
            Entry::H(i, j, k) => {
                self.h[i][j][k] = delta;
                self.h[i][k][j] = delta;
            }
            Entry::G(i) => self.g[i] = delta,
        }
    }

    /// Those of the certificates; ΔB = 0.
    pub fn of(lagrangian: &Lagrangian, certificates: &[Certificate]) -> Self {
        let deltas: Vec<f64> = certificates.iter().map(|certificate| certificate.bound).collect();
        Self::new(lagrangian, &deltas)
    }

    /// What `bound` makes of the size of every entry; ΔB = 0.
    pub(super) fn from_sizes(sizes: &Sizes, bound: impl Fn(Size) -> f64) -> Self {
        let row = |sizes: &Vec<Size>| -> Vec<f64> { sizes.iter().map(|&size| bound(size)).collect() };
        Self {
            d: sizes.mass_matrix.iter().map(row).collect(),
            h: sizes.christoffel.iter().map(|plane| plane.iter().map(row).collect()).collect(),
            b: vec![0.0; sizes.gravity.len()],
            g: row(&sizes.gravity),
        }
    }

    /// The sizes themselves, as bounds on what stands there; ΔB = 0.
    pub(crate) fn of_sizes(sizes: &Sizes) -> Self {
        Self::from_sizes(sizes, |size| size.exact)
    }

    /// With six digits, rounded up: what has to be read by people and stored in firmware needs no more.
    #[must_use]
    pub fn rounded_up(mut self) -> Self {
        let all = self.d.iter_mut().chain(self.h.iter_mut().flatten()).chain([&mut self.b, &mut self.g]);
        all.flatten().for_each(|bound| *bound = six_digits_up(*bound));
        self
    }

    /// Entry by entry the sum, rounded up.
    #[must_use]
    pub fn plus(self, other: &Self) -> Self {
        self.with(other, |own, more| if more == 0.0 { own } else { (own + more).next_up() })
    }

    /// Entry by entry the larger one.
    #[must_use]
    pub(super) fn largest(self, other: &Self) -> Self {
        self.with(other, f64::max)
    }

    fn with(mut self, other: &Self, join: impl Fn(f64, f64) -> f64) -> Self {
        let own = self.d.iter_mut().chain(self.h.iter_mut().flatten()).chain([&mut self.b, &mut self.g]);
        let more = other.d.iter().chain(other.h.iter().flatten()).chain([&other.b, &other.g]);
        for (own, more) in own.zip(more) {
            own.iter_mut().zip(more).for_each(|(own, &more)| *own = join(*own, more));
        }
        self
    }

    /// For each coefficient the largest bound of its places, nothing searched.
    pub fn certificates(&self, lagrangian: &Lagrangian) -> Vec<Certificate> {
        let at = |entry: Entry| match entry {
            Entry::D(i, j) => self.d[i][j].max(self.d[j][i]),
            Entry::H(i, j, k) => self.h[i][j][k],
            Entry::G(i) => self.g[i],
        };
        let largest =
            |c: &Coefficient| c.places.iter().fold(0.0, |most: f64, place| most.max(at(place.entry)));
        let certificate = |bound: f64| Certificate { bound, sines: bound, ..Certificate::default() };
        lagrangian.coefficients.iter().map(|c| certificate(largest(c))).collect()
    }

    /// Bound on |δD a_r + δC v_r + δG| by joint, N·m or N, for rates up to `rates`: every entry at its largest.
    pub fn torque(&self, rates: &Rates) -> Vec<f64> {
        let (a, v, w) = (&rates.reference_acceleration, &rates.speed, &rates.reference_speed);
        let sum = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(e, x)| e * x).sum::<f64>();
        let coriolis = |plane: &[Vec<f64>]| plane.iter().zip(w).map(|(row, w)| sum(row, v) * w).sum::<f64>();
        let torque = |i: usize| sum(&self.d[i], a) + coriolis(&self.h[i]) + self.g[i];
        (0..self.g.len()).map(|i| torque(i) * (1.0 + rounding::gamma(1024.0))).collect()
    }

    /// Equation (30): ΔC_ij = Σ_k Δh_ijk max|q̇_k|, with the largest speeds given.
    pub fn coriolis(&self, speed: &[f64]) -> Vec<Vec<f64>> {
        let row =
            |row: &Vec<Vec<f64>>| row.iter().map(|h| h.iter().zip(speed).map(|(h, v)| h * v).sum()).collect();
        self.h.iter().map(row).collect()
    }
}
