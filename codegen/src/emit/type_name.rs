//! The name of the model's type.

/// Names of the prelude, and `Self`. A module that shadowed them would read badly beside them, or not compile at all.
const TAKEN: [&str; 41] = [
    "AsMut",
    "AsRef",
    "AsyncFn",
    "AsyncFnMut",
    "AsyncFnOnce",
    "Box",
    "Clone",
    "Copy",
    "Debug",
    "Default",
    "DoubleEndedIterator",
    "Drop",
    "Eq",
    "Err",
    "ExactSizeIterator",
    "Extend",
    "Fn",
    "FnMut",
    "FnOnce",
    "From",
    "FromIterator",
    "Hash",
    "Into",
    "IntoIterator",
    "Iterator",
    "None",
    "Ok",
    "Option",
    "Ord",
    "PartialEq",
    "PartialOrd",
    "Result",
    "Self",
    "Send",
    "Sized",
    "Some",
    "String",
    "Sync",
    "ToOwned",
    "ToString",
    "Vec",
];

/// The model's type name: `arm3_xi2` becomes `Arm3Xi2`.
///
/// A name that Rust has taken, and one of capitals alone, as constants are called (`p_s_i` beside `PSI`), ends in `Model`.
pub fn type_name(name: &str) -> String {
    let camel: String = name.split('_').map(capitalised).collect();
    let constant = camel.len() > 1 && camel.bytes().all(|b| b.is_ascii_uppercase());
    if constant || TAKEN.contains(&camel.as_str()) { camel + "Model" } else { camel }
}

fn capitalised(part: &str) -> String {
    let mut letters = part.chars();
    let first = letters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::type_name;

    #[test]
    fn words_are_capitalised() {
        for (name, wanted) in
            [("arm3_xi2", "Arm3Xi2"), ("u_r_5", "UR5"), ("a", "A"), ("ur5", "Ur5"), ("model", "Model")]
        {
            assert_eq!(type_name(name), wanted);
        }
    }

    #[test]
    fn taken_names_are_completed() {
        for (name, wanted) in [
            ("some", "SomeModel"),
            ("none", "NoneModel"),
            ("self_", "SelfModel"),
            ("partial_eq", "PartialEqModel"),
            ("p_s_i", "PSIModel"),
            ("l_a_w", "LAWModel"),
        ] {
            assert_eq!(type_name(name), wanted);
        }
    }
}
