//! The manifest of the crate that gives the C library.

use super::Interface;

/// The manifest.
///
/// The profiles put all into one object of which only the functions of the header can be seen: two such archives go into
/// one program, whatever compilers made them.
pub(super) fn text(interface: &Interface) -> String {
    // The standard library has a panic handler.
    let part = if interface.std {
        include_str!("manifest_std.toml.in")
    } else {
        include_str!("manifest_core.toml.in")
    };
    interface.fill(&(include_str!("manifest.toml.in").to_string() + part))
}
