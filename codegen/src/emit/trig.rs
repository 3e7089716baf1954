//! Sines and cosines: the call for one angle, and the table if there is one.

use proc_macro2::TokenStream;
use quote::quote;

use super::literal::{Numbers, count};
use super::{constant, spaced};
use crate::bounds::printed_up;
use crate::error::Error;
use crate::trig::{Kind, Trig};

/// The expression of (sin, cos) of `angle`.
pub(super) fn call(sines: &Trig, angle: TokenStream) -> TokenStream {
    let path = quote!(::gramforge_runtime::trig);
    let by = match sines.kind {
        Kind::Libm => return quote!(::gramforge_runtime::Real::sin_cos(#angle)),
        Kind::Polynomial => quote!(#path::Polynomial),
        Kind::Table(_) => quote!(SINES),
        Kind::Std => quote!(#path::Std),
    };
    quote!(#path::Trig::sin_cos(&#by, #angle))
}

/// The table as a static; nothing where the code has none.
pub(super) fn table(sines: &Trig, numbers: Numbers) -> Result<TokenStream, Error> {
    let Kind::Table(n) = sines.kind else { return Ok(TokenStream::new()) };
    let pair = |&(sin, cos): &(f64, f64)| -> Result<TokenStream, Error> {
        let (sin, cos) = (numbers.float(sin)?, numbers.float(cos)?);
        Ok(quote!((#sin, #cos)))
    };
    let pairs = spaced(sines.pairs.iter().map(pair).collect::<Result<Vec<_>, _>>()?);
    let (n, constant, scalar) = (count(n), constant(), numbers.name());
    let doc = format!(
        " Sines and cosines of one turn; interpolated, none is off by more than {}.",
        printed_up(sines.error)
    );
    Ok(quote! {
        #[doc = #doc]
        #constant
        pub static SINES: ::gramforge_runtime::trig::Table<#scalar, #n> = ::gramforge_runtime::trig::Table::new(#pairs);
    })
}
