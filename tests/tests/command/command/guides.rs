//! What the guides show works as it is written.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{finish, gramforge, root};

fn guide(name: &str) -> String {
    fs::read_to_string(root().join("docs/guides").join(name)).expect("the guide")
}

/// The blocks of `text` in the language `kind`.
fn blocks<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    let fence = format!("```{kind}\n");
    text.split(fence.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// A robot file of the name that the guides use.
fn robot(folder: &Path, file: &str) {
    fs::copy(root().join("tests/data").join(file), folder.join("ur5.urdf")).expect("copied");
}

#[test]
fn the_first_steps_are_commands_that_work_one_after_the_other() {
    let folder = tempfile::tempdir().expect("a folder");
    // A small arm, so that all of it takes seconds.
    robot(folder.path(), "follower.urdf");
    let text = guide("start.md");
    let commands: Vec<&str> = blocks(&text, "sh").into_iter().flat_map(str::lines).collect();
    assert!(commands.len() >= 7, "{commands:?}");
    for line in commands {
        let words: Vec<&str> = line.split_whitespace().skip(1).collect();
        let done = finish(gramforge().current_dir(folder.path()).args(&words)).expect(0);
        assert!(!done.stdout.is_empty(), "{line}: {done:#?}");
    }
    for file in ["src/ur5.rs", "ur5.svg", "ur5.html", "specs/gramforge.schema.json"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}

/// Puts the members of `part` into `whole`, object by object.
fn merge(whole: &mut Value, part: &Value) {
    match (whole, part) {
        (Value::Object(whole), Value::Object(part)) => {
            for (key, value) in part {
                merge(whole.entry(key.clone()).or_insert(Value::Null), value);
            }
        }
        (whole, part) => *whole = part.clone(),
    }
}

#[test]
fn the_fragments_of_specifications_fit_into_one() {
    let folder = tempfile::tempdir().expect("a folder");
    robot(folder.path(), "ur5.urdf");
    let begun = "{ \"arm\": { \"urdf\": \"ur5.urdf\", \"tip\": \"tool0\" },
        \"motion\": { \"quintic\": { \"from\": [0, 0, 0, 0, 0, 0], \"to\": [1, 1, 1, 1, 1, 1], \"duration\": 5 } },
        \"control\": { \"law\": \"tight\", \"design\": { \"convergence_time\": 1.0 } } }";
    let mut seen = 0;
    for name in ["payloads.md", "tuning.md"] {
        for block in blocks(&guide(name), "json") {
            let mut spec: Value = serde_json::from_str(begun).expect("JSON");
            let part = serde_json::from_str(&format!("{{ {block} }}")).expect("JSON");
            merge(&mut spec, &part);
            let path = folder.path().join("ur5.json");
            fs::write(&path, spec.to_string()).expect("written");
            gramforge::internals::check::prepare(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
            seen += 1;
        }
    }
    assert_eq!(seen, 3);
}
