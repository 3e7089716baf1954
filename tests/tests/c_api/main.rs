//! The C interface: compiled by cargo, gcc and g++, it gives the bits of the module.

mod build;
mod calls;
mod guide;

use std::sync::LazyLock;

use gramforge_generated::arm3_adaptive;
use gramforge_runtime::StepController;

use build::{Language, Library};
use calls::{Answering, compare};

#[allow(dead_code, reason = "a test does not use the whole module")]
#[rustfmt::skip]
mod step_exact {
    include!(concat!(env!("OUT_DIR"), "/step_exact.rs"));
}

/// The modules that both programs use, built once.
static LIBRARY: LazyLock<Library> = LazyLock::new(|| Library::new(&["arm3_adaptive", "step_exact"]));

#[test]
fn torques_have_the_bits_of_the_module_in_c_and_in_cpp() {
    let compiled = |language| LIBRARY.compile("torques.c", language);
    let programs: Vec<_> = Language::installed().into_iter().map(compiled).collect();
    let mut adaptive = Answering::new('a', StepController::<arm3_adaptive::Arm3Adaptive, 3, 1>::new());
    let mut exact = Answering::new('e', StepController::<step_exact::StepExact, 3>::new());
    let script = calls::script(&mut adaptive, &arm3_adaptive::REFERENCE, &mut exact, &step_exact::REFERENCE);
    for program in &programs {
        compare(&script, &program.answers(&script.input));
    }
}

#[test]
fn no_pointer_and_no_memory_does_harm() {
    for language in Language::installed() {
        let said = LIBRARY.compile("misuse.c", language).answers("");
        assert_eq!(said, ["good"], "{language:?}");
    }
}

#[test]
fn the_module_is_the_same_with_a_c_interface() {
    let committed = include_str!("../../../generated/src/arm3_adaptive.rs");
    let made = std::fs::read_to_string(LIBRARY.file("arm3_adaptive.rs")).expect("a module");
    let body = |text: &str| text.split_once("below this line").map(|(_, body)| body.to_string());
    assert_eq!(body(&made), body(committed));
}
