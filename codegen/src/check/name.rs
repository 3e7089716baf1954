//! Names of specifications: each names a Rust module, a file and a type.

use crate::error::Diagnostics;

/// Words that cannot name a Rust module.
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop",
    "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static",
    "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual",
    "where", "while", "yield",
];

/// Names that Windows keeps for devices, whatever ending follows.
const DEVICES: [&str; 4] = ["aux", "con", "nul", "prn"];

/// Files of the crate itself, which a module must not overwrite.
const ROOTS: [&str; 2] = ["lib", "main"];

/// Longest name: with the ending and what temporary files add it stays below the 255 bytes of most file systems.
const LONGEST: usize = 200;

/// Whether `name` can name a module.
pub(crate) fn is_module_name(name: &str) -> bool {
    refusal(name).is_none()
}

/// Adds a fault where `name` cannot name a module.
pub(super) fn check(name: &str, faults: &mut Diagnostics) {
    if let Some((problem, help)) = refusal(name) {
        faults.push("name", problem, help);
    }
}

/// Problem and help for a name that cannot name a module.
fn refusal(name: &str) -> Option<(String, &'static str)> {
    const OTHER: &str = "choose another name";
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(letters) {
        let help = "write a lower-case letter, then lower-case letters, digits and underscores: it names a Rust module";
        Some((format!("is {name:?}"), help))
    } else if name.len() > LONGEST {
        Some((format!("has {} characters", name.len()), "write at most 200: it names a file"))
    } else if name.contains("__") {
        Some((format!("is {name:?}, and Rust warns about two underscores in a row"), "write one underscore"))
    } else if KEYWORDS.contains(&name) {
        Some((format!("is {name:?}, a word of the Rust language"), OTHER))
    } else if DEVICES.contains(&name) || is_port(name) {
        Some((format!("is {name:?}, which is the name of a device in Windows"), OTHER))
    } else if ROOTS.contains(&name) {
        Some((format!("is {name:?}, which is the name of a crate's own file"), OTHER))
    } else {
        None
    }
}

/// Whether `name` is a serial or parallel port of Windows.
fn is_port(name: &str) -> bool {
    let number = name.strip_prefix("com").or_else(|| name.strip_prefix("lpt"));
    number.is_some_and(|number| number.len() == 1 && number.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_refusal_says_why() {
        let long = "a".repeat(201);
        let cases = [
            ("", "is \"\""),
            ("Arm", "is \"Arm\""),
            ("../arm", "is \"../arm\""),
            ("_arm", "is \"_arm\""),
            ("self", "a word of the Rust language"),
            ("con", "which is the name of a device in Windows"),
            ("com1", "which is the name of a device in Windows"),
            ("lpt9", "which is the name of a device in Windows"),
            ("lib", "which is the name of a crate's own file"),
            ("a__b", "two underscores"),
            (&long, "has 201 characters"),
        ];
        for (name, words) in cases {
            let refused = refusal(name).map(|(problem, _)| problem).unwrap_or_default();
            assert!(refused.contains(words), "{name}: {refused}");
            assert!(!is_module_name(name));
        }
    }

    #[test]
    fn other_names_are_good() {
        for name in ["arm3_xi2", "some", "none", "p_s_i", "self_", "com", "com10", "console", "a_"] {
            assert_eq!(refusal(name), None);
        }
    }
}
