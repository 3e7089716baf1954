//! What is said about files that are not specifications.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::unplaced;

use super::{Loaded, load, parse, spec_hash};

const ARM3: &str = include_str!("../../../generated/specs/arm3_xi2.json");

fn arm3() -> Value {
    serde_json::from_str(ARM3).expect("JSON")
}

fn read(text: &str) -> Result<Loaded, String> {
    parse(text, Path::new("a.json")).map_err(|e| e.to_string())
}

/// The faults of arm3.json after `edit` are exactly `lines`, each by its beginning.
fn expect(edit: impl Fn(&mut Value), lines: &[&str]) {
    let mut value = arm3();
    edit(&mut value);
    let message = read(&value.to_string()).expect_err("a fault");
    let found: Vec<&str> = message.lines().map(unplaced).collect();
    assert_eq!(found.len(), lines.len(), "{message}");
    for line in lines {
        assert!(found.iter().any(|f| f.starts_with(line)), "no {line:?} in\n{message}");
    }
}

fn remove(value: &mut Value, pointer: &str, name: &str) {
    let object = value.pointer_mut(pointer).and_then(Value::as_object_mut).expect("an object");
    object.remove(name).expect("the member");
}

#[test]
fn syntax_faults_name_line_and_column() {
    let says = |text: &str, part: &str| {
        let message = read(text).expect_err("a fault");
        unplaced(&message);
        assert!(message.contains(part), "{message}");
    };
    says(
        "{\n  \"name\": \"a\"\n  \"arm\": {}\n}",
        "a.json:3:3: is not JSON that can be read (expected `,` or `}`); correct the JSON there",
    );
    says(
        "{ \"name\": \"a\"",
        "a.json:1:13: is not JSON that can be read (EOF while parsing an object); complete the file",
    );
    says("", "(EOF while parsing a value); complete the file");
    says("{ \"period\": 1e999 }", "(number out of range); write a finite number");
    says("{} {}", "trailing characters");
    says("{ \"period\": NaN }", "expected value");
}

#[test]
fn structural_faults_name_field_value_and_help() {
    expect(|v| v["model"] = json!("exactly"), &["model: is \"exactly\"; write "]);
    expect(
        |v| remove(v, "/arm/dh/links/1", "mass"),
        &["arm.dh.links[1].mass: is missing; write a number (Mass, kg)"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][1]["mass"] = json!("heavy"),
        &["arm.dh.links[1].mass: is \"heavy\"; write a number"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][1]["first_moment"] = json!([1.0, 2.0]),
        &["arm.dh.links[1].first_moment: has 2 entries: [1.0,2.0]; write a list of 3 numbers"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][0]["pseudo_inertia"]["xx"] = Value::Null,
        &["arm.dh.links[0].pseudo_inertia.xx: is null; write a number"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][0]["joint"] = json!("revolving"),
        &["arm.dh.links[0].joint: is \"revolving\"; write \"revolute\" or \"prismatic\""],
    );
    expect(
        |v| v["model"] = json!({ "shared": { "functions": "two" } }),
        &["model.shared.functions: is \"two\"; write a whole number"],
    );
    expect(
        |v| v["model"] = json!({ "shared": { "functions": 2.5 } }),
        &["model.shared.functions: is 2.5; write a whole number"],
    );
    expect(
        |v| v["model"] = json!({ "shared": { "functions": -1 } }),
        &["model.shared.functions: is -1; write a whole number of at least 0"],
    );
    expect(
        |v| v["model"] = json!({ "shared": { "functions": 1e30 } }),
        &["model.shared.functions: is 1e+30; write a whole number of at most 4294967295"],
    );
    expect(
        |v| v["model"] = json!("shard"),
        &[
            "model: is \"shard\"; write \"auto\", \"exact\", { \"shared\": … }, { \"separate\": … } or { \"tolerance\": … }",
        ],
    );
    expect(
        |v| v["model"] = json!(3),
        &[
            "model: is 3; write \"auto\", \"exact\", { \"shared\": … }, { \"separate\": … } or { \"tolerance\": … }",
        ],
    );
    expect(
        |v| v["measure"] = json!({ "tubes": { "position_error": 0.1 } }),
        &[
            "measure: is {\"tubes\":{\"position_error\":0.1}}; write \"trajectory\", { \"tube\": … } or \"workspace\"",
        ],
    );
    expect(
        |v| v["measure"] = json!({ "tube": { "position_error": [0.1, "x"] } }),
        &["measure.tube.position_error[1]: is \"x\"; write a number"],
    );
    expect(
        |v| v["measure"] = json!({ "tube": { "position_error": "x" } }),
        &["measure.tube.position_error: is \"x\"; write a number or a list of numbers"],
    );
    expect(
        |v| v["control"]["W"] = json!([[1.0, 0.0], [0.0, true]]),
        &["control.W[1][1]: is true; write a number"],
    );
    expect(|v| v["control"]["W"] = json!([1.0, {}]), &["control.W[1]: is {}; write a number"]);
    expect(
        |v| v["control"]["Wq"] = json!(1.0),
        &["control.Wq: is not a field; did you mean `W`? The fields here are `"],
    );
    expect(
        |v| {
            remove(v, "/arm/dh/links/0", "mass");
            v["arm"]["dh"]["links"][0]["mas"] = json!(5.5);
        },
        &["arm.dh.links[0].mas: is not a field; did you mean `mass`?"],
    );
    expect(
        |v| v["colour"] = json!("red"),
        &["colour: is not a field; remove it; the fields here are `$schema`, `arm`, "],
    );
    expect(
        |v| v["motion"]["quintic"]["until"] = json!(3),
        &["motion.quintic.until: is not a field; remove it; the fields here are `duration`, `from`, `to`"],
    );
    expect(
        |v| v["motion"]["csv"] = json!({ "file": "a.csv" }),
        &["motion: has `quintic`, `csv` at once; keep one of them"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][0]["limits"] = json!({ "velocity": "fast" }),
        &["arm.dh.links[0].limits.velocity: is \"fast\"; write a number"],
    );
    expect(
        |v| v["arm"]["dh"]["links"][0]["coulomb_friction"] = json!([1.0]),
        &["arm.dh.links[0].coulomb_friction: has 1 entry: [1.0]; write a list of 2 numbers"],
    );
    expect(
        |v| v["control"]["compensate_coulomb"] = json!(1),
        &["control.compensate_coulomb: is 1; write true or false"],
    );
    expect(|v| v["arm"]["lock"] = json!({ "j": "up" }), &["arm.lock.j: is \"up\"; write a number"]);
    expect(|v| *v = json!([]), &["is []; write an object with `arm`"]);
}

#[test]
fn all_faults_are_shown_at_once() {
    expect(
        |v| {
            v["name"] = json!(5);
            remove(v, "/control", "period");
            v["arm"]["dh"]["links"][2]["a"] = json!([]);
            v["motion"]["quintic"]["to"] = json!(1.0);
        },
        &[
            "name: is 5",
            "control.period: is missing",
            "arm.dh.links[2].a: is []",
            "motion.quintic.to: is 1.0; write a list of numbers",
        ],
    );
}

#[test]
fn repeated_keys_are_refused_where_they_stand() {
    let text = ARM3.replace("\"mass\": 4.0,", "\"mass\": 4.0, \"mass\": 5.0,");
    let message = read(&text).expect_err("a fault");
    assert_eq!(
        unplaced(&message),
        "arm.dh.links[1].mass: occurs twice in the same object; keep one of the two"
    );
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let message = load(Path::new("/nowhere/a.json")).expect_err("a fault").to_string();
    assert!(message.starts_with("/nowhere/a.json: cannot be read ("), "{message}");
}

#[test]
fn every_named_file_is_listed() {
    let mut value = arm3();
    value["motion"] = json!({ "csv": { "file": "motions/a.csv" } });
    let loaded = parse(&value.to_string(), Path::new("specs/a.json")).expect("a specification");
    assert_eq!(loaded.files, [Path::new("specs/a.json"), Path::new("specs/motions/a.csv")]);
}

#[test]
fn whole_numbers_may_be_written_as_floats() {
    let mut value = arm3();
    value["model"]["shared"]["functions"] = json!(2.0);
    let spec = |text: &str| read(text).expect("a specification").spec;
    assert_eq!(spec(&value.to_string()), spec(ARM3));
}

#[test]
fn the_hash_sees_what_is_said_and_not_how() {
    let hash = |text: &str| spec_hash(&read(text).expect("a specification")).expect("a hash");
    let plain = hash(ARM3);
    assert_eq!(plain.len(), 64);
    // Members in reverse order, and a default written out.
    fn reversed(value: &Value) -> String {
        match value {
            Value::Object(map) => {
                let members: Vec<String> =
                    map.iter().rev().map(|(k, v)| format!("{}: {}", json!(k), reversed(v))).collect();
                format!("{{ {} }}", members.join(",\n"))
            }
            Value::Array(list) => format!("[{}]", list.iter().map(reversed).collect::<Vec<_>>().join(",")),
            other => other.to_string(),
        }
    }
    let mut value = arm3();
    value["refit"] = json!("minimax");
    value["control"]["W"] = json!(40);
    assert_eq!(hash(&reversed(&value)), plain);
    value["control"]["W"] = json!(40.5);
    assert_ne!(hash(&value.to_string()), plain);
}

#[test]
fn the_hash_covers_named_files() {
    let folder = std::env::temp_dir().join(format!("gramforge-hash-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut value = arm3();
    value["motion"] = json!({ "csv": { "file": "a.csv" } });
    let loaded = || parse(&value.to_string(), &folder.join("a.json")).expect("a specification");
    let missing = spec_hash(&loaded()).expect_err("a fault").to_string();
    assert!(missing.contains("motion.csv.file: names \"a.csv\", which cannot be read"), "{missing}");
    let with = |text: &str| {
        std::fs::write(folder.join("a.csv"), text).expect("a file");
        loaded()
    };
    let (one, two) = (with("t,q1\n0,0\n"), with("t,q1\n0,1\n"));
    // Both are hashed after the file was gone: it is what was read that counts, for a pipe gives its bytes once.
    let _ = std::fs::remove_dir_all(&folder);
    assert_ne!(spec_hash(&one).expect("a hash"), spec_hash(&two).expect("a hash"));
}

#[test]
fn hidden_characters_are_refused_in_names_paths_and_keys() {
    for hidden in
        ["\n", "\r", "\t", "\0", "\x1b", "\x7f", "\u{85}", "\u{200f}", "\u{202e}", "\u{2028}", "\u{2069}"]
    {
        let word = format!("a{hidden}b");
        let mut value = arm3();
        value["name"] = json!(word);
        value["motion"] = json!({ "csv": { "file": word } });
        value["arm"]["joints"] = json!({ word: { "armature": 1.0 } });
        let message = read(&value.to_string()).expect_err("a fault").to_string();
        assert!(!message.chars().any(|c| c != '\n' && crate::text::is_hidden(c)), "{message:?}");
        for field in ["name", "motion.csv.file", "arm.joints.a"] {
            let line = message.lines().find(|line| line.contains(&format!(": {field}")));
            assert!(
                line.is_some_and(|line| line.contains("with the hidden character U+")),
                "{field}: {message}"
            );
        }
        assert_eq!(message.lines().count(), 3, "{message}");
    }
}
