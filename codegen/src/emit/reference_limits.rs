//! What a desired motion of the program's own must keep, and the check of it.

use proc_macro2::TokenStream;
use quote::quote;

use super::constants::counted;
use super::literal::{Rounding, count};
use super::{Module, constant};
use crate::control::ReferenceLimits;
use crate::error::Error;

/// Comparisons of numbers that one check makes for each joint, and absolute values that it takes.
pub(crate) const COMPARISONS: usize = 4;
/// The same of absolute values.
pub(crate) const ABSOLUTE_VALUES: usize = 2;

/// The constants; nothing with a motion, or without a controller.
pub(super) fn constants(module: &Module) -> Result<TokenStream, Error> {
    let Some(limits) = module.design.and_then(|design| design.reference.as_ref()) else {
        return Ok(quote!());
    };
    let (n, numbers) = (module.arm.dof(), module.numbers());
    let (joints, scalar, attributes) = (count(n), numbers.name(), constant());
    let ReferenceLimits { position, velocity, acceleration } = limits;
    let [lowest, highest] = [0, 1].map(|end| position.iter().map(|range| range[end]).collect::<Vec<_>>());
    let (lowest, highest) =
        (numbers.vector_to(&lowest, Rounding::Up)?, numbers.vector_to(&highest, Rounding::Down)?);
    let velocity = numbers.vector_to(velocity, Rounding::Down)?;
    let acceleration = numbers.vector_to(acceleration, Rounding::Down)?;
    let checked = match module.check_reference {
        true => " The step reports a desired motion beyond them as a fault.",
        false => {
            " The step does not look at them: `emit.check_reference` in the specification makes it report a fault."
        }
    };
    let counts = [
        (
            "REFERENCE_COMPARISONS",
            COMPARISONS * n,
            " Comparisons in the check of the desired motion, which the counts of the step leave out.",
        ),
        (
            "REFERENCE_ABSOLUTE_VALUES",
            ABSOLUTE_VALUES * n,
            " Absolute values in the check of the desired motion.",
        ),
    ];
    let counts = counted(module.check_reference.then_some(counts).into_iter().flatten());
    Ok(quote! {
        /// What the desired motion must keep: what is proved of the controller supposes it. The acceleration may jump within its limits.
        ///
        #[doc = #checked]
        #attributes
        pub const REFERENCE_LIMITS: ::gramforge_runtime::ReferenceLimits<#scalar, #joints> =
            ::gramforge_runtime::ReferenceLimits {
                lowest: #lowest,
                highest: #highest,
                velocity: #velocity,
                acceleration: #acceleration,
            };
        #counts
    })
}

/// What the step is told of them; nothing where it takes any motion.
pub(super) fn checked(module: &Module) -> TokenStream {
    let reference = module.design.and_then(|design| design.reference.as_ref());
    if !module.check_reference || reference.is_none() {
        return quote!();
    }
    let (n, scalar) = (count(module.arm.dof()), module.numbers().name());
    quote! {
        const REFERENCE: ::core::option::Option<::gramforge_runtime::ReferenceLimits<#scalar, #n>> =
            ::core::option::Option::Some(REFERENCE_LIMITS);
    }
}
