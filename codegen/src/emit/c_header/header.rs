//! The C header, for C99 and C++17.

use super::Interface;

/// The header.
pub(super) fn text(interface: &Interface) -> String {
    let mut text = include_str!("header_head.h.in").to_string();
    if interface.parameters > 0 {
        text += "\n/* Parameters that the law learns. */\n#define {{NAME}}_PARAMETERS {{parameters}}\n";
    }
    if interface.duration.is_some() {
        text += "\n/* Time that the desired motion takes, s. */\n#define {{NAME}}_DURATION {{duration}}\n";
    }
    text += include_str!("header_types.h.in");
    text += include_str!("header_functions.h.in");
    if interface.duration.is_some() {
        text += include_str!("header_reference.h.in");
    }
    if interface.parameters > 0 {
        text += include_str!("header_learnt.h.in");
    }
    text += include_str!("header_tail.h.in");
    interface.fill(&text)
}
