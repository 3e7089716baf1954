//! Orthogonal columns over a set of points.

use super::vector::{add_scaled, dot};

/// A column whose residual norm is below this fraction of its own depends on those before it.
const DEPENDENT: f64 = 1e-9;

/// Orthogonal directions that span some columns, each of root mean square 1, whatever the columns' scales.
pub(crate) struct Basis {
    /// The directions.
    pub directions: Vec<Vec<f64>>,
    /// For each direction: the column that brought it and that column's components over the directions so far.
    columns: Vec<(usize, Vec<f64>)>,
    /// Number of columns.
    count: usize,
}

impl Basis {
    /// Orthogonalises the columns in order, each twice for full accuracy, and passes over those that depend on
    /// the ones before.
    pub fn new(columns: &[Vec<f64>]) -> Self {
        Self::of(columns.to_vec())
    }

    /// As [`Basis::new`], of columns that nobody else needs.
    pub fn of(columns: Vec<Vec<f64>>) -> Self {
        Self::apart(columns, DEPENDENT)
    }

    /// The same, where a column of which no more than the fraction `dependent` is new depends on those before it.
    pub fn apart(columns: Vec<Vec<f64>>, dependent: f64) -> Self {
        let mut out = Self { directions: Vec::new(), columns: Vec::new(), count: columns.len() };
        for (index, mut vector) in columns.into_iter().enumerate() {
            let points = vector.len() as f64;
            let square = dot(&vector, &vector);
            let mut components = vec![0.0; out.directions.len()];
            for _ in 0..2 {
                for (direction, component) in out.directions.iter().zip(&mut components) {
                    let along = dot(direction, &vector) / points;
                    *component += along;
                    add_scaled(&mut vector, -along, direction);
                }
            }
            let size = libm::sqrt(dot(&vector, &vector) / points);
            if size <= dependent * libm::sqrt(square / points) {
                continue;
            }
            vector.iter_mut().for_each(|x| *x /= size);
            components.push(size);
            out.directions.push(vector);
            out.columns.push((index, components));
        }
        out
    }

    /// The columns that do not depend on those before them, ascending.
    pub fn independent(&self) -> Vec<usize> {
        self.columns.iter().map(|(index, _)| *index).collect()
    }

    /// Turns parameters of the directions into parameters of the columns; dependent columns get 0.
    pub fn over_columns(&self, parameters: &[f64]) -> Vec<f64> {
        let mut rest = parameters.to_vec();
        let mut out = vec![0.0; self.count];
        for (j, (index, components)) in self.columns.iter().enumerate().rev() {
            let k = rest[j] / components[j];
            for i in 0..j {
                rest[i] -= components[i] * k;
            }
            out[*index] = k;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::Basis;

    #[test]
    fn a_dependent_column_gets_no_parameter() {
        let (a, c) = (vec![1.0, 2.0, 3.0, 5.0], vec![1.0, -1.0, 0.0, 1e3]);
        let b = a.iter().map(|x| -4.0 * x).collect();
        let columns = [a, b, c];
        let basis = Basis::new(&columns);
        assert_eq!(basis.directions.len(), 2);
        let parameters = basis.over_columns(&[0.5, -2.0]);
        assert_eq!(parameters[1], 0.0);
        for i in 0..4 {
            let over: f64 = columns.iter().zip(&parameters).map(|(column, k)| k * column[i]).sum();
            let along = 0.5 * basis.directions[0][i] - 2.0 * basis.directions[1][i];
            assert!((over - along).abs() < 1e-12);
        }
    }
}
