//! From graph and constants to formatted Rust; the only place that knows `quote`. The C interface is plain text.

mod c_header;
mod constants;
mod controller;
mod docs;
mod facts;
mod fused;
mod guarantee;
mod literal;
mod names;
mod reference;
mod reference_limits;
mod regression;
mod rounding;
mod statements;
mod step;
mod trig;
mod type_name;

pub use c_header::{CFile, c_interface};
pub(crate) use docs::functions;
pub use facts::Facts;
pub use type_name::type_name;

#[cfg(feature = "cli")]
pub(crate) use docs::{
    domain as domain_in_words, met as met_in_words, rates as rates_in_words, torque as torque_in_words,
};
#[cfg(feature = "cli")]
pub(crate) use reference_limits::{ABSOLUTE_VALUES, COMPARISONS};

use std::path::Path;

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, Met, Torque};
use crate::control::{Design, StepGraph, StepRounding};
use crate::domain::Domain;
use crate::error::Error;
use crate::graph::Graph;
use crate::guarantee::Statement;
use crate::lagrangian::Lagrangian;
use crate::model::Model;
use crate::motion::Motion;
use crate::spec::ScalarSpec;
use crate::torque::Regressor;

/// What a module is made from.
#[derive(Clone, Copy, Debug)]
pub struct Module<'a> {
    /// The specification, which errors name.
    pub file: &'a Path,
    /// Name of the specification, `[a-z][a-z0-9_]*`.
    pub name: &'a str,
    /// SHA-256 of the specification and the files it names, hexadecimal.
    pub hash: &'a str,
    /// The arm.
    pub arm: &'a Arm,
    /// Whether its rotations were rounded, which is part of the bounds.
    pub turned: bool,
    /// All arms that the bounds hold for.
    pub uncertainty: &'a Uncertainty,
    /// The exact model.
    pub lagrangian: &'a Lagrangian,
    /// The model that is emitted, with its code.
    pub model: &'a Model,
    /// What it leaves out.
    pub bounds: &'a Bounds,
    /// What that costs in torque, where the rates are known.
    pub torque: Option<&'a Torque>,
    /// The same at the rates that the law meets.
    pub met: Option<&'a Met>,
    /// Whether the reduction pays, in one sentence.
    pub verdict: &'a str,
    /// Where the bounds hold.
    pub domain: &'a Domain,
    /// The torque as a function of what the law learns.
    pub regressor: Option<&'a Regressor>,
    /// The cheapest exact torque, for comparison.
    pub exact_code: &'a Graph,
    /// The desired motion.
    pub motion: Option<&'a Motion>,
    /// The controller.
    pub design: Option<&'a Design>,
    /// What is promised of it; `None` without one.
    pub statement: Option<&'a Statement>,
    /// Its step, where it is written out.
    pub step: Option<&'a StepGraph>,
    /// What the step rounds by.
    pub rounding: Option<&'a StepRounding>,
    /// What it says of itself for programs.
    pub facts: &'a Facts,
    /// Whether the step reports a desired motion beyond its limits.
    pub check_reference: bool,
    /// Number type of the code.
    pub scalar: ScalarSpec,
}

impl Module<'_> {
    fn numbers(&self) -> literal::Numbers<'_> {
        literal::Numbers { scalar: self.scalar, file: self.file }
    }
}

/// The text of the module: a header of comments, constants, one model type, one trait impl.
///
/// It starts with neither `//!` nor `#![…]`, so that `include!` takes it.
///
/// # Errors
/// [`Error::Internal`] where a number that must be written is not finite, or the text does not parse.
pub fn emit(module: &Module) -> Result<String, Error> {
    let n = literal::count(module.arm.dof());
    let (numbers, scalar) = (module.numbers(), module.numbers().name());
    let model = Ident::new(&type_name(module.name), Span::call_site());
    let docs = docs::model(module);
    let constants = constants::constants(module)?;
    let controller = controller::controller(module, &model)?;
    let parameters = statements::parameters(&module.model.code, module.arm.dof(), numbers);
    let regression = regression::regression(module, &model)?;
    let learnt = regression::constants(module)?;
    let body = statements::body(&module.model.code, numbers)?;
    let table = trig::table(&module.model.code.sines, numbers)?;
    let (unused, plain) = (unused(), plain_numbers());
    let needs = fused::needs(module);
    let tokens = quote! {
        #needs

        #(#[doc = #docs])*
        #unused
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct #model;

        #constants
        #learnt

        #table

        #plain
        impl ::gramforge_runtime::Model<#n> for #model {
            type Scalar = #scalar;

            fn passivity_torque(&self, #parameters) -> [#scalar; #n] {
                #body
            }

            fn viscous_friction(&self) -> [#scalar; #n] {
                VISCOUS_FRICTION
            }

            fn bounds(&self) -> &::gramforge_runtime::Bounds<#scalar, #n> {
                &BOUNDS
            }
        }

        #regression

        #controller
    };
    let text = formatted(tokens)?;
    Ok(docs::header(module, text.len())? + &text)
}

/// The text of a module that does not compile and says `problem`, for a specification that gives none.
pub fn spoilt(problem: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let message = format!("gramforge could not generate this module:\n{problem}");
    format!("// Generated by gramforge {version}; do not edit.\n::core::compile_error!({message:?});\n")
}

/// A firmware reads some of the constants, and the rest must not warn: an attribute on the whole module, which its user
/// declares, is not ours to write.
fn unused() -> TokenStream {
    quote!(#[allow(dead_code)])
}

/// A limit of 3.14 is no bad π.
fn plain_numbers() -> TokenStream {
    quote!(#[allow(clippy::approx_constant)])
}

/// Both, of a constant that holds numbers of the specification.
fn constant() -> TokenStream {
    quote!(#[allow(dead_code, clippy::approx_constant)])
}

/// The items as text, a blank line between them.
fn formatted(tokens: TokenStream) -> Result<String, Error> {
    let file: syn::File =
        syn::parse2(tokens).map_err(|error| Error::Internal(format!("generated code: {error}")))?;
    let empty = syn::File { items: Vec::new(), ..file.clone() };
    let item = |item| {
        let text = prettyplease::unparse(&syn::File { items: vec![item], ..empty.clone() });
        text.trim_end().to_string() + "\n"
    };
    Ok(file.items.into_iter().map(item).collect::<Vec<_>>().join("\n"))
}

fn spaced(items: impl IntoIterator<Item = TokenStream>) -> TokenStream {
    let items = items.into_iter();
    quote!([#(#items),*])
}
