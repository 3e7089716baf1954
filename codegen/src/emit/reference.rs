//! The desired motion: by time, or by the number of the period.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::literal::{Numbers, count};
use super::{Module, constant, rounding, spaced};
use crate::error::Error;
use crate::motion::{Motion, Ticks};

/// The constant, with its documentation; nothing without a motion.
pub(super) fn reference(module: &Module) -> Result<Option<TokenStream>, Error> {
    let Some(motion) = module.motion else { return Ok(None) };
    let numbers = module.numbers();
    let (docs, (kind, value)) = match module.rounding.and_then(|step| step.reference.as_ref()) {
        Some((ticks, error)) => (rounding::by_period(error), by_period(ticks, numbers)?),
        None => (vec![" The desired motion.".to_string()], by_time(motion, numbers)?),
    };
    let constant = constant();
    Ok(Some(quote! {
        #(#[doc = #docs])*
        #constant
        pub const REFERENCE: #kind = #value;
    }))
}

/// Type and value of the motion by the number of the period.
fn by_period(ticks: &Ticks, numbers: Numbers) -> Result<(TokenStream, TokenStream), Error> {
    let (scalar, path) = (numbers.name(), quote!(::gramforge_runtime::reference));
    let whole = |x: u32| Literal::u32_unsuffixed(x);
    Ok(match ticks {
        Ticks::Quintic { from, to, end, step, rate } => {
            let (n, end) = (count(from.len()), whole(*end));
            let (from, to) = (numbers.vector(from)?, numbers.vector(to)?);
            let (step, rate) = (numbers.float(*step)?, numbers.float(*rate)?);
            (
                quote!(#path::QuinticTicks<#scalar, #n>),
                quote!(#path::QuinticTicks { from: #from, to: #to, end: #end, step: #step, rate: #rate }),
            )
        }
        Ticks::Spline { pieces, end, to, period } => {
            let (n, end) = (count(to.len()), whole(*end));
            let piece = |piece: &crate::motion::Piece| -> Result<TokenStream, Error> {
                let (tick, late) = (whole(piece.tick), numbers.float(piece.late)?);
                let coefficients = numbers.matrix(&piece.coefficients)?;
                Ok(quote!(#path::SplineTick { tick: #tick, late: #late, coefficients: #coefficients }))
            };
            let pieces = spaced(pieces.iter().map(piece).collect::<Result<Vec<_>, _>>()?);
            let (to, period) = (numbers.vector(to)?, numbers.float(*period)?);
            (
                quote!(#path::SplineTicks<'static, #scalar, #n>),
                quote!(#path::SplineTicks { pieces: &#pieces, end: #end, to: #to, period: #period }),
            )
        }
        Ticks::Sinusoids { offset, terms } => {
            let n = count(offset.len());
            let term = |term: &crate::motion::Term| -> Result<TokenStream, Error> {
                let [amplitude, speed, acceleration] =
                    [term.amplitude, term.speed, term.acceleration].map(|x| numbers.float(x));
                let (amplitude, speed, acceleration) = (amplitude?, speed?, acceleration?);
                let [phase, turn] = [term.phase, term.turn].map(Literal::u64_unsuffixed);
                Ok(quote!(#path::SinusoidTick {
                    amplitude: #amplitude,
                    speed: #speed,
                    acceleration: #acceleration,
                    phase: #phase,
                    turn: #turn,
                }))
            };
            let joint = |terms: &Vec<_>| -> Result<TokenStream, Error> {
                let terms = spaced(terms.iter().map(term).collect::<Result<Vec<_>, _>>()?);
                Ok(quote!(&#terms))
            };
            let offset = numbers.vector(offset)?;
            let terms = spaced(terms.iter().map(joint).collect::<Result<Vec<_>, _>>()?);
            (
                quote!(#path::SinusoidTicks<'static, #scalar, #n>),
                quote!(#path::SinusoidTicks { offset: #offset, terms: #terms }),
            )
        }
    })
}

/// Type and value of the motion by time.
fn by_time(motion: &Motion, numbers: Numbers) -> Result<(TokenStream, TokenStream), Error> {
    let n = count(motion.dof());
    let (scalar, duration) = (numbers.name(), numbers.float(motion.duration())?);
    let path = quote!(::gramforge_runtime::reference);
    Ok(match motion {
        Motion::Quintic { from, to, .. } => {
            let (from, to) = (numbers.vector(from)?, numbers.vector(to)?);
            (
                quote!(#path::QuinticReference<#scalar, #n>),
                quote!(#path::QuinticReference { from: #from, to: #to, duration: #duration }),
            )
        }
        Motion::Spline(spline) => {
            let segment = |(start, piece): (&f64, &Vec<[f64; 4]>)| -> Result<TokenStream, Error> {
                let (start, coefficients) = (numbers.float(*start)?, numbers.matrix(piece)?);
                Ok(quote!(#path::SplineSegment { start: #start, coefficients: #coefficients }))
            };
            let segments =
                spaced(spline.times.iter().zip(&spline.pieces).map(segment).collect::<Result<Vec<_>, _>>()?);
            (
                quote!(#path::SplineReference<'static, #scalar, #n>),
                quote!(#path::SplineReference { segments: &#segments, duration: #duration }),
            )
        }
        Motion::Sinusoids { offset, terms, .. } => {
            let offset = numbers.vector(offset)?;
            let term = |s: &gramforge_runtime::reference::Sinusoid<f64>| -> Result<TokenStream, Error> {
                let (amplitude, frequency, phase) =
                    (numbers.float(s.amplitude)?, numbers.float(s.frequency)?, numbers.float(s.phase)?);
                Ok(quote!(#path::Sinusoid { amplitude: #amplitude, frequency: #frequency, phase: #phase }))
            };
            let joint = |terms: &Vec<_>| -> Result<TokenStream, Error> {
                let terms = spaced(terms.iter().map(term).collect::<Result<Vec<_>, _>>()?);
                Ok(quote!(&#terms))
            };
            let terms = spaced(terms.iter().map(joint).collect::<Result<Vec<_>, _>>()?);
            (
                quote!(#path::SinusoidReference<'static, #scalar, #n>),
                quote!(#path::SinusoidReference { offset: #offset, terms: #terms, duration: #duration }),
            )
        }
    })
}
