//! What a module with fused operations needs of its compiler.

use proc_macro2::TokenStream;
use quote::quote;

use super::Module;
use crate::graph::{Graph, Node};

/// What is said where the processor that is compiled for is not known to multiply and add in one instruction.
const NO_INSTRUCTION: &str = "this module multiplies and adds in one operation (`emit.fma` in its specification), which would be \
    a slow library call here: compile it with RUSTFLAGS=\"-C target-feature=+fma\" or \"-C target-cpu=native\" on x86, or \
    generate it without `emit.fma`";

/// What a module with fused operations begins with; nothing for the others.
///
/// The flags of the compiler are those of the crate that the module is part of, so the module itself looks at them. The function
/// exists only with the feature `std` of the runtime.
pub(super) fn needs(module: &Module) -> Option<TokenStream> {
    let step = module.step.map(|step| &step.code);
    let regressor = module.regressor.map(|regressor| &regressor.code);
    let fused = |code: &Graph| code.nodes.iter().any(|node| matches!(node, Node::MulAdd(..)));
    let needed = [Some(&module.model.code), step, regressor].into_iter().flatten().any(fused);
    needed.then(|| {
        quote! {
            #[cfg(not(any(
                all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "fma"),
                all(target_arch = "aarch64", target_feature = "neon")
            )))]
            ::core::compile_error!(#NO_INSTRUCTION);

            // Exists only with the feature `std` of `gramforge-runtime`.
            use ::gramforge_runtime::step::mul_add;
        }
    })
}
