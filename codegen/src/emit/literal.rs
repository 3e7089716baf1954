//! Numbers as tokens.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::spaced;
use crate::error::Error;

/// A finite f64, shortest form that reads back to the same bits; the sign is a token of its own.
///
/// # Errors
/// [`Error::Internal`] for infinite and NaN.
pub(super) fn float(x: f64) -> Result<TokenStream, Error> {
    if !x.is_finite() {
        return Err(Error::Internal(format!("a constant of the generated code is {x}")));
    }
    let size = Literal::f64_unsuffixed((x + 0.0).abs());
    Ok(if x < 0.0 { quote!(-#size) } else { quote!(#size) })
}

/// A vector.
pub(super) fn vector(x: &[f64]) -> Result<TokenStream, Error> {
    Ok(spaced(x.iter().map(|&x| float(x)).collect::<Result<Vec<_>, _>>()?))
}

/// A matrix, by rows.
pub(super) fn matrix<R: AsRef<[f64]>>(m: &[R]) -> Result<TokenStream, Error> {
    Ok(spaced(m.iter().map(|row| vector(row.as_ref())).collect::<Result<Vec<_>, _>>()?))
}

/// A number of things.
pub(super) fn count(n: usize) -> Literal {
    Literal::usize_unsuffixed(n)
}
