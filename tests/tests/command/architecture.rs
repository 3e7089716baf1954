//! No stage of the generator imports a later one.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The stages in the order of `ARCHITECTURE.md`, each with its place.
fn order() -> BTreeMap<String, usize> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("the architecture");
    let list = text.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the list");
    let stages = list.lines().filter_map(|line| line.split_whitespace().next());
    stages.enumerate().map(|(place, stage)| (stage.to_string(), place)).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every Rust file below `folder`, test modules in files of their own apart.
fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if name == "tests" || name == "example" {
            continue;
        }
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|end| end == "rs") {
            out.push(path);
        }
    }
}

/// The stages that a source names outside comments and its test module, as `crate::STAGE` or in `crate::{…}`.
fn imports(text: &str) -> Vec<String> {
    let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code: String =
        own.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut out = Vec::new();
    for rest in code.split("crate::").skip(1) {
        let list = rest.strip_prefix('{').and_then(|rest| rest.split('}').next());
        for item in list.unwrap_or(rest).split(',').take(if list.is_some() { usize::MAX } else { 1 }) {
            let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
            out.push(item.trim().split(|c| !word(c)).next().unwrap_or_default().to_string());
        }
    }
    out
}

#[test]
fn no_stage_imports_a_later_one() {
    let order = order();
    let folder = root().join("codegen/src");
    let mut files = Vec::new();
    sources(&folder, &mut files);
    assert!(files.len() > 150, "{}", files.len());
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for file in files {
        let inside = file.strip_prefix(&folder).expect("a source").with_extension("");
        let stage = inside.iter().next().expect("a name").to_string_lossy().into_owned();
        if stage == "lib" || stage == "main" {
            continue;
        }
        let Some(own) = order.get(&stage) else {
            wrong.push(format!("{stage} has no place in ARCHITECTURE.md"));
            continue;
        };
        for import in imports(&fs::read_to_string(&file).expect("a source")) {
            // Macros and re-exports of the crate's root are no stages.
            let Some(place) = order.get(&import) else {
                wrong.push(format!("{}: crate::{import} is no stage", inside.display()));
                continue;
            };
            seen += 1;
            if place > own {
                wrong.push(format!("{}: imports the later stage {import}", inside.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 500, "{seen} imports");
}

#[test]
fn imports_are_read_from_code_alone() {
    let text = "use crate::arm::Arm;\n// crate::cli\nuse crate::{bounds::Bounds, check};\nlet x = crate::emit::emit();\n#[cfg(test)]\nmod tests {\nuse crate::cli;}";
    assert_eq!(imports(text), ["arm", "bounds", "check", "emit"]);
}

#[test]
fn the_readme_shows_a_specification_that_is_tested() {
    let readme = fs::read_to_string(root().join("README.md")).expect("the README");
    let shown =
        readme.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a specification");
    let kept = fs::read_to_string(root().join("tests/data/arm.json")).expect("the specification");
    assert_eq!(shown, kept);
}
