//! What the code rounds by, as constant and in words.

use proc_macro2::TokenStream;
use quote::quote;

use super::docs::list;
use super::literal::{Rounding, count};
use super::{Module, constant};
use crate::bounds::printed_up;
use crate::control::StepRounding;
use crate::error::Error;
use crate::motion::ReferenceError;
use crate::spec::ScalarSpec;

/// The constant of a step that is written out.
pub(super) fn constants(module: &Module) -> Result<Option<TokenStream>, Error> {
    let Some(rounding) = module.rounding.filter(|_| module.step.is_some()) else { return Ok(None) };
    let numbers = module.numbers();
    let (n, scalar, constant) = (count(module.arm.dof()), numbers.name(), constant());
    let value = numbers.vector_to(&rounding.torque, Rounding::Up)?;
    let docs = words(rounding, module.scalar);
    Ok(Some(quote! {
        #(#[doc = #docs])*
        #constant
        pub const ROUNDING: [#scalar; #n] = #value;
    }))
}

/// What is known of a step's rounding, a line each.
fn words(rounding: &StepRounding, scalar: ScalarSpec) -> Vec<String> {
    let StepRounding { states, sign, .. } = rounding;
    let mut lines = vec![
        format!(" Bound by joint, N·m or N, on what a control step rounds by in {}: how far the torque that it asks is from", scalar.name()),
        " that of the same step in real numbers, for the same inputs. It holds inside the domain for position errors up to"
            .to_string(),
        format!(
            " ({}) and velocity errors up to ({}).",
            list(&states.position_error),
            list(&states.velocity_error)
        ),
    ];
    if *sign > 0.0 {
        lines.extend([
            String::new(),
            format!(
                " Beside that, the law may switch with the wrong sign where |s| is at most {}{}.",
                printed_up(*sign),
                if scalar == ScalarSpec::F32 { "; the guarantee counts what this costs" } else { "" }
            ),
        ]);
    }
    lines
}

/// The documentation of a motion by the number of the period.
pub(super) fn by_period([q, qd, qdd]: &ReferenceError) -> Vec<String> {
    vec![
        " The desired motion by the number of the control period, counted from 0. In f32 a time would lose its digits.".to_string(),
        String::new(),
        format!(
            " It is off from the motion of the specification by joint by at most ({}) in position, ({}) in velocity and ({}) in",
            list(q),
            list(qd),
            list(qdd)
        ),
        " acceleration.".to_string(),
    ]
}
