//! Vectors and matrices as fixed-size arrays; every sum runs in index order, so that results agree between machines.

use core::array::from_fn;

use crate::Real;

/// Does `body` for each joint `i` below `N`, written out for up to eight joints: a compiler that is asked for small code keeps
/// every loop, and with a loop the vectors in memory that it goes over, and their copies.
macro_rules! for_each_joint {
    ($n:ident, $i:ident => $body:block) => {
        for_each_joint!(@written $n, $i, $body, 0 1 2 3 4 5 6 7);
        for $i in 8..$n $body
    };
    (@written $n:ident, $i:ident, $body:block, $($k:literal)*) => {
        $(if $k < $n {
            let $i: usize = $k;
            $body
        })*
    };
}
pub(crate) use for_each_joint;

/// a + b.
pub(crate) fn add<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    from_fn(|i| a[i] + b[i])
}

/// a − b.
pub(crate) fn sub<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    from_fn(|i| a[i] - b[i])
}

/// diag(d) x.
pub(crate) fn scale<T: Real, const N: usize>(d: &[T; N], x: &[T; N]) -> [T; N] {
    from_fn(|i| d[i] * x[i])
}

/// x + h y.
pub(crate) fn along<T: Real, const N: usize>(x: &[T; N], h: T, y: &[T; N]) -> [T; N] {
    from_fn(|i| x[i] + h * y[i])
}

/// |x|, element by element.
pub(crate) fn abs<T: Real, const N: usize>(x: &[T; N]) -> [T; N] {
    x.map(Real::abs)
}

/// xᵀ y.
pub(crate) fn dot<T: Real, const N: usize>(x: &[T; N], y: &[T; N]) -> T {
    x.iter().zip(y).fold(T::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// A x, A by rows.
pub(crate) fn mat_vec<T: Real, const N: usize>(a: &[[T; N]; N], x: &[T; N]) -> [T; N] {
    from_fn(|i| dot(&a[i], x))
}

/// The `j`-th unit vector.
pub(crate) fn unit<T: Real, const N: usize>(j: usize) -> [T; N] {
    from_fn(|i| if i == j { T::ONE } else { T::ZERO })
}

/// The first joint whose number is infinite or NaN.
pub(crate) fn first_not_finite<T: Real, const N: usize>(x: &[T; N]) -> Option<usize> {
    x.iter().position(|v| !v.is_finite())
}
