//! What a specification that says little is taken to mean.

use std::path::Path;

use serde_json::Value;

use crate::spec::{MeasureSpec, ModelSpec, Spec};

/// Gives `value`, where it has no name, one from the file at `path`: `UR5-left.json` is `ur5_left`.
pub(super) fn name(value: &mut Value, path: &Path) {
    let Some(map) = value.as_object_mut().filter(|map| !map.contains_key("name")) else { return };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    map.insert("name".into(), module_name(&stem).into());
}

/// `words` as the name of a module: lower-case letters, digits and underscores.
pub(crate) fn module_name(words: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    let name: String = words.chars().map(plain).collect();
    let name = name.trim_matches('_');
    match name.chars().next() {
        None => "arm".to_string(),
        Some(first) if first.is_ascii_digit() => format!("arm_{name}"),
        Some(_) => name.to_string(),
    }
}

/// An arm alone stands for its exact dynamics wherever its joints can go.
pub(super) fn measure(spec: &mut Spec) {
    let alone = spec.motion.is_none() && spec.measure.is_none() && spec.control.is_none();
    if alone && matches!(spec.model, ModelSpec::Auto | ModelSpec::Exact) {
        spec.model = ModelSpec::Exact;
        spec.measure = Some(MeasureSpec::Workspace);
    }
}

#[cfg(test)]
mod tests {
    use super::module_name;

    #[test]
    fn a_name_is_made_of_any_words() {
        for (words, name) in [
            ("UR5-left", "ur5_left"),
            ("7dof arm", "arm_7dof_arm"),
            ("", "arm"),
            ("é", "arm"),
            ("a.b", "a_b"),
        ] {
            assert_eq!(module_name(words), name);
        }
    }
}
