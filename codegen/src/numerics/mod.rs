//! Numerical methods with a fixed order of operations: the same numbers give the same bits on every machine.

pub(crate) mod affine;
pub(crate) mod basis;
pub(crate) mod chebyshev;
pub(crate) mod interval;
pub(crate) mod linalg;
pub(crate) mod linear;
pub mod low_discrepancy;
pub(crate) mod lu;
pub(crate) mod quadratic;
pub(crate) mod rounded;
pub(crate) mod vector;

pub use interval::Interval;
