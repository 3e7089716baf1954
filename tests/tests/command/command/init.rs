//! `gramforge init`: from a robot file to a specification that the other commands take.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{finish, gramforge, root, run, text};

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The command in `folder` with `arguments`.
fn inside(folder: &Path, arguments: &[&str]) -> crate::common::Outcome {
    finish(gramforge().current_dir(folder).args(arguments))
}

fn ur5(folder: &Path) {
    fs::copy(root().join("tests/data/ur5.urdf"), folder.join("ur5.urdf")).expect("copied");
}

#[test]
fn a_specification_from_a_robot_file_is_taken_by_the_other_commands() {
    let folder = folder();
    fs::copy(root().join("tests/data/follower.urdf"), folder.path().join("arm.urdf")).expect("copied");
    let told = inside(folder.path(), &["init", "arm.urdf", "--control", "exact"]).expect(0).stdout;
    let named = "Module: chain, in chain.rs\n";
    for words in [named, "Arm: 2 joints to the link", "Armature: zero for", "Next:\n  gramforge inspect"] {
        assert!(told.contains(words), "no {words:?} in\n{told}");
    }
    let spec = told.lines().next().and_then(|line| line.strip_suffix(": written")).expect("a file");
    let written = fs::read_to_string(folder.path().join(spec)).expect("a specification");
    for words in
        ["\"$schema\": \"./gramforge.schema.json\"", "\"convergence_time\": ", "// Armature: rotor inertia"]
    {
        assert!(written.contains(words), "no {words:?} in\n{written}");
    }
    let schema = fs::read_to_string(folder.path().join("gramforge.schema.json")).expect("a schema");
    let printed: Value = serde_json::from_str(&run(["schema"]).expect(0).stdout).expect("JSON");
    assert_eq!(serde_json::from_str::<Value>(&schema).expect("JSON"), printed);

    let shown = inside(folder.path(), &["inspect", spec, "--json"]).json();
    assert_eq!(shown["joints"], 2);
    assert!(shown["control"]["period"].as_f64().is_some_and(|period| period == 0.001));
    assert!(
        told.contains(&format!("Guarantee: {}", shown["guarantee"]["kind"].as_str().expect("a kind"))),
        "{told}"
    );
    inside(folder.path(), &["generate", spec, "--out", "src"]).expect(0);
    assert!(folder.path().join("src/chain.rs").exists());
    assert_eq!(fs::read_dir(folder.path().join("src")).expect("a folder").count(), 1);
}

#[test]
fn nothing_is_replaced_unless_asked() {
    let folder = folder();
    ur5(folder.path());
    fs::write(folder.path().join("a.jsonc"), "mine").expect("written");
    let arguments = ["init", "ur5.urdf", "--tip", "tool0", "--untried", "--out", "a.jsonc"];
    let refused = inside(folder.path(), &arguments).expect(2);
    assert!(refused.stderr.starts_with("a.jsonc: is there already; write --force"), "{}", refused.stderr);
    assert_eq!(fs::read_to_string(folder.path().join("a.jsonc")).expect("a file"), "mine");
    assert!(!folder.path().join("gramforge.schema.json").exists());
    inside(folder.path(), &[&arguments[..], &["--force"]].concat()).expect(0);
    assert_ne!(fs::read_to_string(folder.path().join("a.jsonc")).expect("a file"), "mine");
}

#[test]
fn an_arm_that_ends_in_several_links_gets_the_likeliest_and_the_others_are_offered() {
    let folder = folder();
    ur5(folder.path());
    let told =
        inside(folder.path(), &["init", "ur5.urdf", "--control", "none", "--untried"]).expect(0).stdout;
    assert!(told.contains("to the link tool0"), "{told}");
    let refused = inside(folder.path(), &["init", "ur5.urdf", "--tip", "hand", "--untried"]).expect(2);
    assert!(refused.stderr.contains("ur5.urdf: has no link \"hand\"") && refused.stderr.contains("tool0"));
}

#[test]
fn every_example_is_generated_with_a_promise_for_the_sampled_loop() {
    let folder = folder();
    // The Panda is generated the same way, but takes minutes in this build.
    for example in ["arm3", "puma560"] {
        inside(folder.path(), &["init", "--example", example]).expect(0);
        let spec = format!("{example}.jsonc");
        let shown = inside(folder.path(), &["inspect", &spec, "--json"]).json();
        assert_eq!(shown["guarantee"]["kind"], "sampled", "{example}: {}", shown["guarantee"]["reasons"]);
    }
}

#[test]
fn an_arm_alone_has_exact_dynamics() {
    let folder = folder();
    ur5(folder.path());
    let spec = folder.path().join("My-Arm.json");
    fs::write(&spec, "{ \"arm\": { \"urdf\": \"ur5.urdf\", \"tip\": \"tool0\" } } // nothing else")
        .expect("written");
    let out = text(&folder.path().join("src"));
    let made = run(["generate", &text(&spec), "--out", &out, "--json"]).json();
    assert_eq!(made[0]["verdict"].as_str().map(|verdict| verdict.contains("exact")), Some(true), "{made}");
    assert!(folder.path().join("src/my_arm.rs").exists());
}
