//! The law, its settings and the reference motion.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::literal::{Numbers, count};
use super::{Module, constant, spaced, unused};
use crate::control::{Adaptation, Design, RobustGain};
use crate::error::Error;
use crate::spec::{CoriolisTermSpec, LawSpec, OnFaultSpec};

pub(super) fn controller(module: &Module, model: &Ident) -> Result<TokenStream, Error> {
    let n = count(module.arm.dof());
    let (unused, constant) = (unused(), constant());
    let reference = super::reference::reference(module)?;
    let Some(design) = module.design else { return Ok(quote!(#reference)) };
    let numbers = module.numbers();
    let scalar = numbers.name();
    let rounding = super::rounding::constants(module)?;
    let settings = settings(design, numbers)?;
    let (law_type, law) = law(design, numbers)?;
    let guarantee = match module.statement {
        Some(statement) => super::guarantee::guarantee(module, design, statement)?,
        None => quote!(),
    };
    let made = match module.step {
        Some(step) => super::step::step(module, step, model)?,
        None => quote! {
            /// The controller: model, law and settings put together.
            ///
            /// # Errors
            /// None as generated; names the parameter if a constant above was edited into an impossible one.
            #unused
            pub fn controller() -> ::core::result::Result<
                ::gramforge_runtime::Controller<#model, ::gramforge_runtime::#law_type, #n>,
                ::gramforge_runtime::ConfigError,
            > {
                ::gramforge_runtime::Controller::new(#model, LAW, SETTINGS)
            }
        },
    };
    let reference_limits = super::reference_limits::constants(module)?;
    Ok(quote! {
        #guarantee
        #reference_limits
        /// Period, torque limits and fault policy.
        #constant
        pub const SETTINGS: ::gramforge_runtime::Settings<#scalar, #n> = #settings;
        /// The tracking law with its gains.
        #constant
        pub const LAW: ::gramforge_runtime::#law_type = #law;
        #reference
        #rounding

        #made
    })
}

fn settings(design: &Design, numbers: Numbers) -> Result<TokenStream, Error> {
    let period = numbers.float(design.period)?;
    let limit = |limit: &Option<f64>| match limit {
        Some(limit) => numbers.float(*limit).map(|x| quote!(::core::option::Option::Some(#x))),
        None => Ok(quote!(::core::option::Option::None)),
    };
    let limits = spaced(design.torque_limit.iter().map(limit).collect::<Result<Vec<_>, _>>()?);
    let on_fault = match design.on_fault {
        OnFaultSpec::Hold => quote!(Hold),
        OnFaultSpec::Zero => quote!(Zero),
        OnFaultSpec::Gravity => quote!(Gravity),
    };
    Ok(quote!(::gramforge_runtime::Settings {
        period: #period,
        torque_limit: #limits,
        on_fault: ::gramforge_runtime::OnFault::#on_fault,
    }))
}

fn law(design: &Design, numbers: Numbers) -> Result<(TokenStream, TokenStream), Error> {
    let scalar = numbers.name();
    let p12 = numbers.matrix(&design.gains.p12)?;
    let damping = numbers.matrix(&design.gains.damping)?;
    let pqq = numbers.matrix(&design.gains.pqq)?;
    let gains = quote!(::gramforge_runtime::Gains { p12: #p12, damping: #damping, pqq: #pqq });
    let coulomb = numbers.matrix(&design.coulomb)?;
    let disturbance = numbers.vector(&design.disturbance)?;
    let switching = match &design.boundary_layer {
        None => quote!(::gramforge_runtime::Switching::Sign),
        Some(phi) => {
            let phi = numbers.vector(phi)?;
            quote!(::gramforge_runtime::Switching::BoundaryLayer(#phi))
        }
    };
    let n = count(design.gains.pqq.len());
    let report = || -> Result<TokenStream, Error> {
        let delta_c = numbers.matrix(&design.delta_c)?;
        let term = match design.coriolis_term {
            CoriolisTermSpec::Matrix => {
                let delta_c1 = numbers.matrix(&design.delta_c1)?;
                quote!(::gramforge_runtime::CoriolisTerm::Matrix(#delta_c1))
            }
            CoriolisTermSpec::Switching => quote!(::gramforge_runtime::CoriolisTerm::Switching),
        };
        Ok(quote!(::gramforge_runtime::ReportLaw {
            gains: #gains,
            delta_c: #delta_c,
            coriolis_term: #term,
            disturbance: #disturbance,
            switching: #switching,
            coulomb: #coulomb,
        }))
    };
    Ok(match (design.law, &design.adaptation) {
        (LawSpec::Report | LawSpec::Tight, _) if let RobustGain::Constant(gain) = &design.robust_gain => {
            let gain = numbers.vector(gain)?;
            let law = quote!(::gramforge_runtime::ConstantGainLaw {
                gains: #gains,
                robust_gain: #gain,
                switching: #switching,
                coulomb: #coulomb,
            });
            (quote!(ConstantGainLaw<#scalar, #n>), law)
        }
        (LawSpec::Exact, _) => (
            quote!(ExactLaw<#scalar, #n>),
            quote!(::gramforge_runtime::ExactLaw { gains: #gains, coulomb: #coulomb }),
        ),
        (LawSpec::Adaptive, Some(adaptation)) => {
            let parameters = count(adaptation.rate.len());
            let robust = report()?;
            let Adaptation { rate, low, high, initial, .. } = adaptation;
            let [rate, low, high, initial] = [rate, low, high, initial].map(|x| numbers.vector(x));
            let (rate, low, high, initial) = (rate?, low?, high?, initial?);
            let law = quote!(::gramforge_runtime::AdaptiveLaw {
                robust: #robust,
                rate: #rate,
                low: #low,
                high: #high,
                initial: #initial,
            });
            (quote!(AdaptiveLaw<#scalar, #n, #parameters>), law)
        }
        (LawSpec::Report | LawSpec::Adaptive, _) => (quote!(ReportLaw<#scalar, #n>), report()?),
        (LawSpec::Tight, _) => {
            let law = quote!(::gramforge_runtime::TightLaw {
                gains: #gains,
                disturbance: #disturbance,
                switching: #switching,
                coulomb: #coulomb,
            });
            (quote!(TightLaw<#scalar, #n>), law)
        }
    })
}
