//! The constants of a module.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use super::docs::functions;
use super::literal::{Numbers, Rounding, count};
use super::{Module, constant, spaced, unused};
use crate::bounds::Bounds;
use crate::error::Error;

pub(super) fn constants(module: &Module) -> Result<TokenStream, Error> {
    let n = count(module.arm.dof());
    let psi = functions(module.lagrangian, &module.model.reduced);
    let xi = count(psi.len());
    let operations = module.model.code.operations();
    let (unused, constant) = (unused(), constant());
    let counts = [
        ("MULTIPLICATIONS", operations.mul, " Multiplications in one passivity torque."),
        ("ADDITIONS", operations.add, " Additions, subtractions and negations in one passivity torque."),
        ("TRIG_PAIRS", operations.trig_pairs, " Joints whose sine and cosine one passivity torque takes."),
    ];
    let fused = (
        "FUSED_MULTIPLY_ADDS",
        operations.fused,
        " Multiplications together with an addition in one passivity torque.",
    );
    let counts = counted(counts.into_iter().chain(module.model.code.fma.then_some(fused)));
    let viscous: Vec<f64> = module.arm.joints.iter().map(|joint| joint.viscous_friction).collect();
    let numbers = module.numbers();
    let (scalar, viscous) = (numbers.name(), numbers.vector(&viscous)?);
    let bounds = bounds(module.bounds, numbers)?;
    Ok(quote! {
        /// Number of joints n.
        #unused
        pub const JOINTS: usize = #n;
        /// Number of kept functions; 0 for the exact model, also of an arm with other base parameters.
        #unused
        pub const FUNCTIONS: usize = #xi;
        /// The kept functions, in the order of the model's documentation.
        #unused
        pub const PSI: [&str; #xi] = [#(#psi),*];
        #counts
        /// Diagonal of B, N·m·s/rad or N·s/m.
        #constant
        pub const VISCOUS_FRICTION: [#scalar; #n] = #viscous;
        /// ΔD, Δh, ΔB and ΔG, certified over the domain, and for all arms, that the model's documentation names.
        #constant
        pub const BOUNDS: ::gramforge_runtime::Bounds<#scalar, #n> = #bounds;
    })
}

/// Constants for numbers of operations.
pub(super) fn counted(counts: impl IntoIterator<Item = (&'static str, usize, &'static str)>) -> TokenStream {
    let unused = unused();
    let counts = counts.into_iter().map(|(name, number, doc)| {
        let (name, number) = (Ident::new(name, Span::call_site()), count(number));
        quote! {
            #[doc = #doc]
            #unused
            pub const #name: usize = #number;
        }
    });
    quote!(#(#counts)*)
}

fn bounds(bounds: &Bounds, numbers: Numbers) -> Result<TokenStream, Error> {
    let zero = bounds
        .d
        .iter()
        .flatten()
        .chain(bounds.h.iter().flatten().flatten())
        .chain(&bounds.b)
        .chain(&bounds.g);
    if zero.into_iter().all(|&x| x == 0.0) {
        return Ok(quote!(::gramforge_runtime::Bounds::ZERO));
    }
    let up = |m: &[Vec<f64>]| numbers.matrix_to(m, Rounding::Up);
    let d = up(&bounds.d)?;
    let h = spaced(bounds.h.iter().map(|plane| up(plane)).collect::<Result<Vec<_>, _>>()?);
    let (b, g) = (numbers.vector_to(&bounds.b, Rounding::Up)?, numbers.vector_to(&bounds.g, Rounding::Up)?);
    Ok(quote!(::gramforge_runtime::Bounds { d: #d, h: #h, b: #b, g: #g }))
}
