//! What is promised of the controller, as a constant with its documentation.

use proc_macro2::TokenStream;
use quote::quote;

use super::docs::list;
use super::literal::{Numbers, Rounding, count};
use super::{Module, constant};
use crate::bounds::{printed_above, printed_below, printed_down, printed_up, six_digits_up};
use crate::control::Design;
use crate::error::Error;
use crate::guarantee::{Kind, Sampled, Statement};
use crate::text::escaped;

pub(super) fn guarantee(
    module: &Module,
    design: &Design,
    statement: &Statement,
) -> Result<TokenStream, Error> {
    let (n, numbers) = (count(module.arm.dof()), module.numbers());
    let (scalar, attributes) = (numbers.name(), constant());
    let promised = &design.guarantee;
    let value = match (statement.kind, &statement.sampled) {
        (Kind::Sampled, Some(sampled)) => {
            let errors = errors(sampled, numbers)?;
            quote!(::gramforge_runtime::Guarantee::Sampled(#errors))
        }
        (Kind::Continuous, _) => {
            let final_error = numbers.vector_to(&promised.final_error, Rounding::Up)?;
            quote!(::gramforge_runtime::Guarantee::Continuous { final_error: #final_error })
        }
        _ => quote!(::gramforge_runtime::Guarantee::None),
    };
    let period_max = match promised.period_certified {
        true => some(numbers.rounded(promised.period_max, Rounding::Down)?),
        false => none(),
    };
    let docs = docs(design, statement);
    Ok(quote! {
        #(#[doc = #docs])*
        #attributes
        pub const GUARANTEE: ::gramforge_runtime::Guarantee<#scalar, #n> = #value;
        /// Control period, s, below which the sampled loop is stable at every D of the domain, each D kept constant. `None` if
        /// it could not be certified.
        #attributes
        pub const PERIOD_MAX: ::core::option::Option<#scalar> = #period_max;
    })
}

fn some(value: TokenStream) -> TokenStream {
    quote!(::core::option::Option::Some(#value))
}

fn none() -> TokenStream {
    quote!(::core::option::Option::None)
}

fn errors(sampled: &Sampled, numbers: Numbers) -> Result<TokenStream, Error> {
    let bound = |x: &[f64]| {
        let up: Vec<f64> = x.iter().map(|x| six_digits_up(*x)).collect();
        numbers.vector_to(&up, Rounding::Up)
    };
    let (reach, end_error) = (bound(&sampled.reach)?, bound(&sampled.end_error)?);
    let settle = numbers.rounded(sampled.settle, Rounding::Up)?;
    let settled_error = match &sampled.settled_error {
        Some(error) => some(bound(error)?),
        None => none(),
    };
    let valid_until = match sampled.valid_until {
        Some(end) => some(numbers.rounded(end, Rounding::Down)?),
        None => none(),
    };
    let [low, high] = sampled.torque_range();
    let torque_min = numbers.vector_to(&low, Rounding::Down)?;
    let torque_max = numbers.vector_to(&high, Rounding::Up)?;
    Ok(quote!(::gramforge_runtime::SampledErrors {
        reach: #reach,
        settle: #settle,
        settled_error: #settled_error,
        end_error: #end_error,
        valid_until: #valid_until,
        torque_min: #torque_min,
        torque_max: #torque_max,
    }))
}

/// A line each.
fn docs(design: &Design, statement: &Statement) -> Vec<String> {
    let mut lines = vec![format!(" What is promised: `{}`.", statement.kind.name()), String::new()];
    match (statement.kind, &statement.sampled) {
        (Kind::Sampled, Some(sampled)) => lines.extend(sampled_docs(sampled)),
        (Kind::Continuous, _) => {
            let most = design.guarantee.initial_error_max.iter().map(|&e| printed_down(e));
            let [whose, lasts] = match &design.reference {
                None => ["planned", "lasts"],
                Some(_) => ["desired", "keeps `REFERENCE_LIMITS`"],
            };
            lines.extend([
                format!(
                    " The joints stay inside the domain of the bounds from every initial error specified, as long as the {whose}"
                ),
                format!(
                    " motion {lasts} and no torque limit cuts the command. It is a promise of the continuous law: the lag of a torque"
                ),
                " that is held for a period counts to first order.".to_string(),
                String::new(),
                format!(
                    " Largest initial position error for which that domain is enough, other reasons apart: ({}).",
                    most.collect::<Vec<_>>().join(", ")
                ),
            ]);
        }
        _ => lines.push(" Nothing is promised.".to_string()),
    }
    if !statement.reasons.is_empty() {
        let more = if statement.kind == Kind::Continuous { " It is not `sampled`" } else { " It is `none`" };
        lines.extend([String::new(), format!("{more}, because:")]);
        lines.extend(statement.reasons.iter().map(|reason| format!(" - {}", escaped(reason))));
    }
    lines
}

fn sampled_docs(sampled: &Sampled) -> Vec<String> {
    let until = match sampled.valid_until {
        None => "for ever".to_string(),
        Some(end) => format!("until t = {} s", printed_down(end)),
    };
    let [low, high] = sampled.torque_range();
    let shown = |x: &[f64], of: fn(f64) -> String| x.iter().map(|x| of(*x)).collect::<Vec<_>>().join(", ");
    let (low, high) = (shown(&low, printed_below), shown(&high, printed_above));
    let mut lines = vec![
        format!(" From every initial error specified, the loop that runs holds {until}:"),
        String::new(),
        format!(" - |q − q_d| by joint at any time: at most ({}).", list(&sampled.reach)),
    ];
    if let Some(error) = &sampled.settled_error {
        lines.push(format!(
            " - The same from t = {} s on: at most ({}).",
            printed_up(sampled.settle),
            list(error)
        ));
    }
    lines.extend([
        format!(" - The same at the end of the motion: at most ({}).", list(&sampled.end_error)),
        format!(" - The torque that the law asks for, by joint: from ({}) to ({}).", low, high),
        String::new(),
        " The torque is computed at each sample from q, q̇ and the reference of that instant, and held for one period. The arm is"
            .to_string(),
        " the one of the specification, or one of its intervals of uncertainty.".to_string(),
    ]);
    lines
}
