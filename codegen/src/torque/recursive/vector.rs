//! Vectors and matrices of graph nodes.

use crate::graph::Expr;

pub(super) type Vector<'g> = [Expr<'g>; 3];
pub(super) type Matrix<'g> = [[Expr<'g>; 3]; 3];

pub(super) fn add<'g>(a: Vector<'g>, b: Vector<'g>) -> Vector<'g> {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(super) fn cross<'g>(a: Vector<'g>, b: Vector<'g>) -> Vector<'g> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn dot<'g>(a: Vector<'g>, b: Vector<'g>) -> Expr<'g> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// M x.
pub(super) fn apply<'g>(m: &Matrix<'g>, x: Vector<'g>) -> Vector<'g> {
    std::array::from_fn(|i| dot(m[i], x))
}

/// R x.
pub(super) fn outward<'g>(r: &[[f64; 3]; 3], x: Vector<'g>) -> Vector<'g> {
    let constants = r.map(|row| row.map(|entry| x[0].constant_like(entry)));
    apply(&constants, x)
}

/// Rᵀ x.
pub(super) fn inward<'g>(r: &[[f64; 3]; 3], x: Vector<'g>) -> Vector<'g> {
    outward(&transposed(r), x)
}

/// Rᵀ M R.
pub(super) fn seen_from<'g>(r: &[[f64; 3]; 3], m: &Matrix<'g>) -> Matrix<'g> {
    let rows = m.map(|row| inward(r, row));
    let columns: Matrix = std::array::from_fn(|j| inward(r, [rows[0][j], rows[1][j], rows[2][j]]));
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

pub(super) fn transposed(r: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]))
}

/// A turn about z by the angle of this sine and cosine.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Turn<'g> {
    pub sin: Expr<'g>,
    pub cos: Expr<'g>,
}

impl<'g> Turn<'g> {
    /// Components of `x` in the turned frame.
    pub(super) fn inward(&self, x: Vector<'g>) -> Vector<'g> {
        let (s, c) = (self.sin, self.cos);
        [c * x[0] + s * x[1], c * x[1] - s * x[0], x[2]]
    }

    /// Components in the still frame of `x`, which stands in the turned one.
    pub(super) fn outward(&self, x: Vector<'g>) -> Vector<'g> {
        let (s, c) = (self.sin, self.cos);
        [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]]
    }

    /// One turn and then another.
    pub(super) fn then(&self, next: &Self) -> Self {
        Self {
            sin: self.sin * next.cos + self.cos * next.sin,
            cos: self.cos * next.cos - self.sin * next.sin,
        }
    }

    /// The turn backwards.
    pub(super) fn back(&self) -> Self {
        Self { sin: -self.sin, cos: self.cos }
    }
}
