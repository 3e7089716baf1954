//! The model as an affine function of the parameters that its law learns.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::docs::cost;
use super::literal::count;
use super::{Module, constant, plain_numbers, spaced, statements, unused};
use crate::error::Error;

/// The impl of the runtime's `AdaptiveModel`; nothing for a law that does not learn.
pub(super) fn regression(module: &Module, model: &Ident) -> Result<TokenStream, Error> {
    let Some(regressor) = module.regressor else { return Ok(quote!()) };
    let n = module.arm.dof();
    let (numbers, scalar) = (module.numbers(), module.numbers().name());
    let (joints, parameters) = (count(n), count(regressor.parameters));
    let operations = regressor.code.operations();
    let doc = format!(
        " base + Yθ in {}{}.",
        cost(&operations),
        if regressor.own_base { ", and those of one passivity torque" } else { "" }
    );
    let inputs = if regressor.own_base {
        quote!(q: &[#scalar; #joints], qd: &[#scalar; #joints], v_r: &[#scalar; #joints], a_r: &[#scalar; #joints])
    } else {
        statements::parameters(&regressor.code, n, numbers)
    };
    let (statements, outputs) = statements::parts(&regressor.code, numbers)?;
    let (base, columns) = if regressor.own_base {
        let own = quote!(::gramforge_runtime::Model::passivity_torque(self, q, qd, v_r, a_r));
        (own, outputs.as_slice())
    } else {
        let (base, columns) = outputs.split_at(n.min(outputs.len()));
        (spaced(base.iter().cloned()), columns)
    };
    let plain = plain_numbers();
    let columns = spaced(columns.chunks(n).map(|column| spaced(column.iter().cloned())));
    Ok(quote! {
        #[doc = #doc]
        #plain
        impl ::gramforge_runtime::AdaptiveModel<#joints, #parameters> for #model {
            fn regression(&self, #inputs) -> ::gramforge_runtime::Regression<#scalar, #joints, #parameters> {
                #(#statements)*
                ::gramforge_runtime::Regression { base: #base, columns: #columns }
            }
        }
    })
}

/// The constants of the law's parameters; nothing for a law that does not learn.
pub(super) fn constants(module: &Module) -> Result<TokenStream, Error> {
    let Some(adaptation) = module.design.and_then(|design| design.adaptation.as_ref()) else {
        return Ok(quote!());
    };
    let number = count(adaptation.names.len());
    let names = &adaptation.names;
    let scalar = module.numbers().name();
    let nominal = module.numbers().vector(&adaptation.initial)?;
    let (unused, constant) = (unused(), constant());
    Ok(quote! {
        /// Number of parameters θ that the law learns.
        #unused
        pub const PARAMETERS: usize = #number;
        /// What they stand for: what an uncertain number differs by from the arm's own, or a parameter of the model.
        #unused
        pub const PARAMETER_NAMES: [&str; #number] = [#(#names),*];
        /// θ of the arm as specified.
        #constant
        pub const NOMINAL_PARAMETERS: [#scalar; #number] = #nominal;
    })
}
