//! Small dense linear systems by fixed-order elimination, so that the same numbers give the same bits everywhere.

/// P M = L U of a square matrix, by rows, with partial pivoting.
pub(crate) struct Lu {
    factors: Vec<Vec<f64>>,
    /// Row i of P M is row `order[i]` of M.
    order: Vec<usize>,
}

impl Lu {
    /// Factors `matrix`; `None` where a pivot is below `1e-13` of the largest entry.
    pub fn new(mut matrix: Vec<Vec<f64>>) -> Option<Self> {
        let n = matrix.len();
        let largest = matrix.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if matrix[i][k].abs() > matrix[pivot][k].abs() {
                    pivot = i;
                }
            }
            matrix.swap(k, pivot);
            order.swap(k, pivot);
            let (top, below) = matrix.split_at_mut(k + 1);
            let row = &top[k];
            if row[k].is_nan() || row[k].abs() <= 1e-13 * largest {
                return None;
            }
            for other in below {
                let factor = other[k] / row[k];
                other[k] = factor;
                for (x, y) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                    *x -= factor * y;
                }
            }
        }
        Some(Self { factors: matrix, order })
    }

    /// x with M x = b.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = b.len();
        let mut x: Vec<f64> = self.order.iter().map(|&i| b[i]).collect();
        for i in 0..n {
            for j in 0..i {
                x[i] -= self.factors[i][j] * x[j];
            }
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] -= self.factors[i][j] * x[j];
            }
            x[i] /= self.factors[i][i];
        }
        x
    }

    /// x with Mᵀ x = b.
    pub fn solve_transposed(&self, b: &[f64]) -> Vec<f64> {
        let n = b.len();
        let mut y = b.to_vec();
        for i in 0..n {
            y[i] /= self.factors[i][i];
            let (done, rest) = y.split_at_mut(i + 1);
            for (y, factor) in rest.iter_mut().zip(&self.factors[i][i + 1..]) {
                *y -= factor * done[i];
            }
        }
        for i in (0..n).rev() {
            let (rest, done) = y.split_at_mut(i);
            for (y, factor) in rest.iter_mut().zip(&self.factors[i]) {
                *y -= factor * done[0];
            }
        }
        let mut x = vec![0.0; n];
        for (y, &i) in y.into_iter().zip(&self.order) {
            x[i] = y;
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Lu;

    #[test]
    fn both_systems_are_solved() {
        let matrix = vec![vec![0.0, 2.0, 1.0], vec![1.0, -1.0, 4.0], vec![3.0, 0.5, -2.0]];
        let (x, b) = ([1.0, -2.0, 0.25], [-3.75, 4.0, 1.5]);
        let lu = Lu::new(matrix.clone()).expect("a regular matrix");
        for (solved, x) in lu.solve(&b).iter().zip(x) {
            assert!((solved - x).abs() < 1e-14);
        }
        let right: Vec<f64> = (0..3).map(|j| (0..3).map(|i| matrix[i][j] * x[i]).sum()).collect();
        for (solved, x) in lu.solve_transposed(&right).iter().zip(x) {
            assert!((solved - x).abs() < 1e-14);
        }
    }

    #[test]
    fn a_singular_matrix_has_no_factors() {
        assert!(Lu::new(vec![vec![1.0, 2.0], vec![2.0, 4.0]]).is_none());
    }
}
