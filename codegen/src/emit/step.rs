//! The control step: law and model written out as one function.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::constants::counted;
use super::literal::count;
use super::{Module, plain_numbers, spaced, statements, unused};
use crate::control::StepGraph;
use crate::error::Error;
use crate::graph::{Node, Variable};

/// The impl of the runtime's `ControlStep`, its operation counts, and the controller.
pub(super) fn step(module: &Module, step: &StepGraph, model: &Ident) -> Result<TokenStream, Error> {
    let (n, scalar) = (count(module.arm.dof()), module.numbers().name());
    let learns = step.parameters;
    let p = count(learns);
    let learnt = |learning: TokenStream, none: TokenStream| if learns == 0 { none } else { learning };
    let parameters = learnt(quote!(#n, #p), quote!(#n));
    let learning = learnt(
        quote!(::gramforge_runtime::step::Learning { low: LAW.low, high: LAW.high, initial: LAW.initial }),
        quote!(::gramforge_runtime::step::Learning::NONE),
    );
    let wanted: Vec<_> = step.asked().into_iter().chain(step.code.outputs.iter().copied()).collect();
    let (statements, values) = statements::parts_with(&step.code, &wanted, module.numbers())?;
    let (asked, rest) = values.split_at(step.joints.min(values.len()));
    let (limited, rest) = rest.split_at(step.joints.min(rest.len()));
    let (correction, unread) = rest.split_at(learns.min(rest.len()));
    let unread = unread.first().cloned().unwrap_or(quote!(0.0));
    let [asked, limited, correction] =
        [asked, limited, correction].map(|values| spaced(values.iter().cloned()));
    let used = |test: fn(&Node) -> bool| step.code.nodes.iter().any(test);
    let functions: Vec<Ident> = [
        (used(|node| matches!(node, Node::Clamp(..))), "clamp"),
        (used(|node| matches!(node, Node::Select(..))), "select"),
    ]
    .into_iter()
    .filter(|(used, _)| *used)
    .map(|(_, name)| format_ident!("{name}"))
    .collect();
    let functions =
        (!functions.is_empty()).then(|| quote!(use ::gramforge_runtime::step::{#(#functions),*};));
    let read = used(|node| matches!(node, Node::Input(Variable::Theta(_))));
    let learnt_so_far = if read { format_ident!("theta") } else { format_ident!("_theta") };
    let (unused, plain, counts) = (unused(), plain_numbers(), counts(step));
    let checked = super::reference_limits::checked(module);
    // A firmware has one place that takes the step: written out there, the step's torques are not stored and read again.
    Ok(quote! {
        #counts

        #plain
        impl ::gramforge_runtime::ControlStep<#parameters> for #model {
            type Scalar = #scalar;
            const SETTINGS: ::gramforge_runtime::Settings<#scalar, #n> = SETTINGS;
            const LEARNING: ::gramforge_runtime::step::Learning<#scalar, #p> = #learning;
            #checked

            #[inline(always)]
            fn step(
                q: &[#scalar; #n],
                qd: &[#scalar; #n],
                desired: &::gramforge_runtime::Desired<#scalar, #n>,
                #learnt_so_far: &[#scalar; #p],
            ) -> ::gramforge_runtime::step::StepTorque<#scalar, #parameters> {
                #functions
                #(#statements)*
                ::gramforge_runtime::step::StepTorque {
                    asked: #asked,
                    limited: #limited,
                    unread: #unread,
                    correction: #correction,
                }
            }

            fn gravity_torque(q: &[#scalar; #n]) -> [#scalar; #n] {
                ::gramforge_runtime::Model::gravity(&#model, q)
            }
        }

        /// The controller before its first step. All its numbers were checked when it was generated, so it can be a `static`.
        #unused
        pub const fn controller() -> ::gramforge_runtime::StepController<#model, #parameters> {
            ::gramforge_runtime::StepController::new()
        }
    })
}

/// What one step computes, the desired motion apart.
fn counts(step: &StepGraph) -> TokenStream {
    let operations = step.operations();
    let counts = [
        ("STEP_MULTIPLICATIONS", operations.mul, " Multiplications in one control step, law and model."),
        (
            "STEP_ADDITIONS",
            operations.add,
            " Additions, subtractions, negations and absolute values in one control step.",
        ),
        ("STEP_CLAMPS", operations.other, " Numbers that one control step clamps or chooses by a sign."),
    ];
    let fused = (
        "STEP_FUSED_MULTIPLY_ADDS",
        operations.fused,
        " Multiplications together with an addition in one control step.",
    );
    counted(counts.into_iter().chain(step.code.fma.then_some(fused)))
}
