//! From graph and constants to formatted Rust; the only place that knows `quote`.

mod constants;
mod controller;
mod docs;
mod literal;
mod regression;
mod sines;
mod statements;

pub(crate) use docs::{
    domain as domain_in_words, functions, met as met_in_words, rates as rates_in_words,
    torque as torque_in_words,
};

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use crate::arm::{Arm, Uncertainty};
use crate::body::{Form, Regressor};
use crate::bounds::{Bounds, Met, Torque};
use crate::design::Design;
use crate::error::Error;
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::measure::Domain;
use crate::motion::Motion;
use crate::reduction::Reduced;

/// What a module is made from.
#[derive(Clone, Copy, Debug)]
pub struct Module<'a> {
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
    /// The model that is emitted.
    pub reduced: &'a Reduced,
    /// What it leaves out.
    pub bounds: &'a Bounds,
    /// What that costs in torque, where the rates are known.
    pub torque: Option<&'a Torque>,
    /// The same at the rates that the law meets.
    pub met: Option<&'a Met>,
    /// Whether reducing pays, in one sentence.
    pub verdict: &'a str,
    /// Where the bounds hold.
    pub domain: &'a Domain,
    /// How the torque is computed.
    pub form: Form,
    /// The torque.
    pub code: &'a Graph,
    /// The torque as a function of what the law learns.
    pub regressor: Option<&'a Regressor>,
    /// The cheapest exact torque, for comparison.
    pub exact_code: &'a Graph,
    /// The desired motion.
    pub motion: Option<&'a Motion>,
    /// The controller.
    pub design: Option<&'a Design>,
}

/// The text of the module: a header of comments, constants, one model type, one trait impl.
///
/// It starts with neither `//!` nor `#![…]`, so that `include!` takes it.
///
/// # Errors
/// [`Error::Internal`] where a number that must be written is not finite, or the text does not parse.
pub fn emit(module: &Module) -> Result<String, Error> {
    let n = literal::count(module.arm.dof());
    let model = Ident::new(&type_name(module.name), Span::call_site());
    let docs = docs::model(module);
    let constants = constants::constants(module)?;
    let controller = controller::controller(module, &model)?;
    let parameters = statements::parameters(module.code, module.arm.dof());
    let regression = regression::regression(module, &model)?;
    let learnt = regression::constants(module)?;
    let body = statements::body(module.code)?;
    let table = sines::table(&module.code.sines)?;
    let tokens = quote! {
        #(#[doc = #docs])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct #model;

        #constants
        #learnt

        #table

        impl ::gramforge_runtime::Model<#n> for #model {
            type Scalar = f64;

            fn passivity_torque(&self, #parameters) -> [f64; #n] {
                #body
            }

            fn viscous_friction(&self) -> [f64; #n] {
                VISCOUS_FRICTION
            }

            fn bounds(&self) -> &::gramforge_runtime::Bounds<f64, #n> {
                &BOUNDS
            }
        }

        #regression

        #controller
    };
    let text = formatted(tokens)?;
    Ok(docs::header(module, text.len()) + &text)
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

/// The model's type name: `arm3_xi2` becomes `Arm3Xi2`.
pub fn type_name(name: &str) -> String {
    name.split('_')
        .map(|part| {
            let mut letters = part.chars();
            letters
                .next()
                .map(|first| first.to_ascii_uppercase())
                .into_iter()
                .chain(letters)
                .collect::<String>()
        })
        .collect()
}

fn spaced(items: impl IntoIterator<Item = TokenStream>) -> TokenStream {
    let items = items.into_iter();
    quote!([#(#items),*])
}
