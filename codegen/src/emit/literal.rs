//! Numbers as tokens.

use std::path::Path;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use super::spaced;
use crate::error::Error;
use crate::number::{scientific, single_down, single_up};
use crate::spec::ScalarSpec;

/// How numbers of one type are written.
#[derive(Clone, Copy)]
pub(super) struct Numbers<'a> {
    pub scalar: ScalarSpec,
    /// The specification, which an error names.
    pub file: &'a Path,
}

/// To which side a number is rounded that the type does not have.
#[derive(Clone, Copy)]
pub(super) enum Rounding {
    Nearest,
    Up,
    Down,
}

impl Numbers<'_> {
    /// The name of the type.
    pub(super) fn name(self) -> Ident {
        Ident::new(self.scalar.name(), Span::call_site())
    }

    /// A finite number, rounded once, in the shortest form that reads back to the same bits; the sign is a token of its own.
    ///
    /// # Errors
    /// [`Error::Input`] for a finite number that f32 has no finite one for, [`Error::Internal`] for infinite and NaN.
    pub(super) fn float(self, x: f64) -> Result<TokenStream, Error> {
        self.rounded(x, Rounding::Nearest)
    }

    /// The same, rounded to a side: an upper bound must not become smaller.
    ///
    /// # Errors
    /// As [`Numbers::float`].
    pub(super) fn rounded(self, x: f64, rounding: Rounding) -> Result<TokenStream, Error> {
        let (size, negative, finite) = match self.scalar {
            ScalarSpec::F64 => (Literal::f64_unsuffixed(finite((x + 0.0).abs())), x < 0.0, x.is_finite()),
            ScalarSpec::F32 => {
                let single = match rounding {
                    Rounding::Nearest => x as f32,
                    Rounding::Up => single_up(x),
                    Rounding::Down => single_down(x),
                };
                let size = Literal::f32_unsuffixed(if single.is_finite() { single.abs() } else { 0.0 });
                (size, single < 0.0, single.is_finite())
            }
        };
        match finite {
            true => Ok(if negative { quote!(-#size) } else { quote!(#size) }),
            false if x.is_finite() => {
                let problem =
                    format!("is `f32`, and the module holds {}, which f32 cannot hold", scientific(x));
                Err(Error::input(
                    self.file,
                    "emit.scalar",
                    problem,
                    "write \"f64\", or every number in SI units",
                ))
            }
            false => Err(Error::Internal(format!("a constant of the generated code is {x}"))),
        }
    }

    /// A vector.
    pub(super) fn vector(self, x: &[f64]) -> Result<TokenStream, Error> {
        self.vector_to(x, Rounding::Nearest)
    }

    /// A vector, rounded to a side.
    pub(super) fn vector_to(self, x: &[f64], rounding: Rounding) -> Result<TokenStream, Error> {
        Ok(spaced(x.iter().map(|&x| self.rounded(x, rounding)).collect::<Result<Vec<_>, _>>()?))
    }

    /// A matrix, by rows.
    pub(super) fn matrix<R: AsRef<[f64]>>(self, m: &[R]) -> Result<TokenStream, Error> {
        self.matrix_to(m, Rounding::Nearest)
    }

    /// A matrix by rows, rounded to a side.
    pub(super) fn matrix_to<R: AsRef<[f64]>>(self, m: &[R], to: Rounding) -> Result<TokenStream, Error> {
        Ok(spaced(m.iter().map(|row| self.vector_to(row.as_ref(), to)).collect::<Result<Vec<_>, _>>()?))
    }
}

/// `Literal` takes finite numbers alone; the others are reported.
fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}

/// A number of things.
pub(super) fn count(n: usize) -> Literal {
    Literal::usize_unsuffixed(n)
}
