//! What a C interface needs.

use crate::error::Diagnostics;
use crate::spec::{LawCodeSpec, Spec, TrigSpec};

/// Names whose functions would be those of the C library of an operating system, such as `sem_init`.
const LIBRARY: [&str; 2] = ["pthread", "sem"];

/// The same of all names that begin so.
const FAMILIES: [&str; 2] = ["posix_", "pthread_"];

/// Adds a fault for everything that a C interface cannot be made of.
pub(super) fn check(spec: &Spec, faults: &mut Diagnostics) {
    if !spec.emit.c_api {
        return;
    }
    if spec.control.is_none() {
        let problem = "asks for a C interface, which is that of a controller, but there is no `control`";
        faults.push("emit.c_api", problem, "add `control`, or remove `emit.c_api`");
    }
    if spec.emit.law == LawCodeSpec::Runtime {
        let problem =
            "asks for a C interface, which needs a step that is written out, but `emit.law` is `runtime`";
        faults.push("emit.c_api", problem, "remove `emit.law` or `emit.c_api`");
    }
    if spec.emit.sines() == TrigSpec::Std {
        let problem = "is \"std\", which puts the standard library into the C library: two of these do not link into one program";
        faults.push("emit.trig", problem, "write \"polynomial\", or remove `emit.c_api`");
    }
    if spec.emit.fma {
        let problem = "needs the standard library, and two C libraries with it do not link into one program";
        faults.push("emit.fma", problem, "remove `emit.fma` or `emit.c_api`");
    }
    let name = spec.name.as_str();
    if LIBRARY.contains(&name) || FAMILIES.iter().any(|start| name.starts_with(start)) {
        let problem =
            format!("is {name:?}, and `{name}_init` in C may be a function of the operating system");
        faults.push("name", problem, "choose another name, or remove `emit.c_api`");
    }
}
