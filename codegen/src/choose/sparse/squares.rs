//! Least squares over functions of which one after the other goes, by rank-one updates.

use crate::numerics::basis::Basis;
use crate::numerics::lu::Lu;
use crate::numerics::vector::dot;

/// A fit over the functions that are left, with the inverse of their Gram matrix.
pub(super) struct Squares {
    inverse: Vec<Vec<f64>>,
    /// By function; 0 for those that are gone.
    pub parameters: Vec<f64>,
    alive: Vec<bool>,
}

/// A column of which less than this fraction is new depends on those before it: the inverse of a Gram matrix loses twice these digits.
const DEPENDENT: f64 = 1e-6;

/// The columns that do not depend on those before them.
pub(super) fn independent(columns: &[&Vec<f64>]) -> Vec<usize> {
    Basis::apart(columns.iter().map(|column| (*column).clone()).collect(), DEPENDENT).independent()
}

impl Squares {
    /// Of `values` over all `columns`; `None` where these are dependent to rounding.
    pub fn new(columns: &[&Vec<f64>], values: &[f64]) -> Option<Self> {
        let gram = columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
        let lu = Lu::new(gram)?;
        let count = columns.len();
        let unit = |i: usize| (0..count).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let inverse = (0..count).map(|i| lu.solve(&unit(i))).collect();
        let parameters = lu.solve(&columns.iter().map(|a| dot(a, values)).collect::<Vec<f64>>());
        Some(Self { inverse, parameters, alive: vec![true; count] })
    }

    /// Functions that are left.
    pub fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.alive.len()).filter(|&i| self.alive[i])
    }

    /// What the squares grow by without function `i`.
    pub fn loss(&self, i: usize) -> f64 {
        self.parameters[i] * self.parameters[i] / self.inverse[i][i]
    }

    /// The parameters without function `i`, where that is 0.
    pub fn without(&self, i: usize) -> Vec<f64> {
        let factor = self.parameters[i] / self.inverse[i][i];
        let mut out: Vec<f64> =
            self.parameters.iter().zip(&self.inverse[i]).map(|(k, x)| k - factor * x).collect();
        out[i] = 0.0;
        out
    }

    /// Takes function `out` away, which leaves `parameters`.
    pub fn remove(&mut self, out: usize, parameters: Vec<f64>) {
        self.parameters = parameters;
        self.alive[out] = false;
        let row = self.inverse[out].clone();
        let left: Vec<usize> = self.left().collect();
        for i in left {
            let factor = self.inverse[i][out] / row[out];
            for (x, y) in self.inverse[i].iter_mut().zip(&row) {
                *x -= factor * y;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Squares, independent};

    #[test]
    fn a_column_that_others_make_up_is_left_out() {
        let (a, b) = (vec![1.0, 2.0, 3.0, 5.0], vec![1.0, -1.0, 0.0, 1e3]);
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a - b + 1e-9 * a * b).collect();
        let c = vec![0.0, 1.0, 0.0, 0.0];
        let columns = [&a, &b, &sum, &c];
        assert!(Squares::new(&[&a, &b, &a.iter().map(|x| 2.0 * x).collect()], &c).is_none());
        assert_eq!(independent(&columns), [0, 1, 3]);
    }

    /// One function after the other is taken away; each time the fit is that made anew without it.
    #[test]
    fn updates_agree_with_fits_made_anew() {
        let at = |f: usize, x: f64| libm::cos(f as f64 * x + 0.3 * (f * f) as f64);
        let column = |f: usize| (0..60).map(|i| at(f, 0.1 * f64::from(i))).collect::<Vec<f64>>();
        let columns: Vec<Vec<f64>> = (0..7).map(column).collect();
        let values: Vec<f64> = (0..60).map(|i| libm::exp(-0.05 * f64::from(i))).collect();
        let of = |kept: &[usize]| {
            let some: Vec<&Vec<f64>> = kept.iter().map(|&f| &columns[f]).collect();
            Squares::new(&some, &values).expect("independent columns")
        };
        let mut squares = of(&[0, 1, 2, 3, 4, 5, 6]);
        for gone in [3, 0, 6, 2] {
            let parameters = squares.without(gone);
            squares.remove(gone, parameters);
            let kept: Vec<usize> = squares.left().collect();
            for (&f, anew) in kept.iter().zip(&of(&kept).parameters) {
                assert!((squares.parameters[f] - anew).abs() < 1e-9, "without {gone}: function {f}");
            }
            assert_eq!(squares.parameters[gone], 0.0);
        }
    }
}
