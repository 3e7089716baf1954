//! The crate that gives the C library: the only generated code with `unsafe`.

use super::Interface;

/// Its source.
pub(super) fn text(interface: &Interface) -> String {
    let mut text = include_str!("shim_head.rs.in").to_string();
    text += include_str!("shim_panic.rs.in");
    text += include_str!("shim_types.rs.in");
    text += include_str!("shim_memory.rs.in");
    text += include_str!("shim_functions.rs.in");
    if interface.duration.is_some() {
        text += include_str!("shim_reference.rs.in");
    }
    if interface.parameters > 0 {
        text += include_str!("shim_learnt.rs.in");
    }
    interface.fill(&text)
}
