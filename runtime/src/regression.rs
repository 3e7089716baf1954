//! Models that are affine in parameters which a law may learn.

use core::array::from_fn;

use crate::{Model, Real};

/// D̂ a_r + Ĉ v_r + Ĝ as an affine function of `P` parameters θ, equation (46): base + Y θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regression<T, const N: usize, const P: usize> {
    /// The torque at θ = 0, N·m.
    pub base: [T; N],
    /// Y(q, q̇, v_r, a_r) by columns, one for each parameter, N·m over the parameter's unit.
    pub columns: [[T; N]; P],
}

impl<T: Real, const N: usize, const P: usize> Regression<T, N, P> {
    /// base + Y θ, N·m.
    pub fn torque(&self, theta: &[T; P]) -> [T; N] {
        let mut torque = self.base;
        for (column, &theta) in self.columns.iter().zip(theta) {
            for (torque, &y) in torque.iter_mut().zip(column) {
                *torque += theta * y;
            }
        }
        torque
    }

    /// Yᵀ s, one entry for each parameter.
    pub fn gradient(&self, s: &[T; N]) -> [T; P] {
        from_fn(|k| self.columns[k].iter().zip(s).fold(T::ZERO, |sum, (&y, &s)| sum + y * s))
    }
}

/// A model whose passivity torque is affine in `P` parameters θ.
///
/// Its [`Model`] is the one at the arm's own θ.
pub trait AdaptiveModel<const N: usize, const P: usize>: Model<N> {
    /// The passivity torque as a function of θ, without friction.
    fn regression(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        v_r: &[Self::Scalar; N],
        a_r: &[Self::Scalar; N],
    ) -> Regression<Self::Scalar, N, P>;
}

impl<M: AdaptiveModel<N, P> + ?Sized, const N: usize, const P: usize> AdaptiveModel<N, P> for &M {
    fn regression(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        v_r: &[Self::Scalar; N],
        a_r: &[Self::Scalar; N],
    ) -> Regression<Self::Scalar, N, P> {
        (**self).regression(q, qd, v_r, a_r)
    }
}
