//! The constants of a module.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use super::docs::functions;
use super::literal::{count, matrix, vector};
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
    ]
    .map(|(name, number, doc)| {
        let (name, number) = (Ident::new(name, Span::call_site()), count(number));
        quote! {
            #[doc = #doc]
            #unused
            pub const #name: usize = #number;
        }
    });
    let viscous: Vec<f64> = module.arm.joints.iter().map(|joint| joint.viscous_friction).collect();
    let viscous = vector(&viscous)?;
    let bounds = bounds(module.bounds)?;
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
        #(#counts)*
        /// Diagonal of B, N·m·s/rad or N·s/m.
        #constant
        pub const VISCOUS_FRICTION: [f64; #n] = #viscous;
        /// ΔD, Δh, ΔB and ΔG, certified over the domain, and for all arms, that the model's documentation names.
        #constant
        pub const BOUNDS: ::gramforge_runtime::Bounds<f64, #n> = #bounds;
    })
}

fn bounds(bounds: &Bounds) -> Result<TokenStream, Error> {
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
    let d = matrix(&bounds.d)?;
    let h = spaced(bounds.h.iter().map(|plane| matrix(plane)).collect::<Result<Vec<_>, _>>()?);
    let (b, g) = (vector(&bounds.b)?, vector(&bounds.g)?);
    Ok(quote!(::gramforge_runtime::Bounds { d: #d, h: #h, b: #b, g: #g }))
}
