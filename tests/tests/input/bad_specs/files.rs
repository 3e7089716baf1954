//! Files that are not there, cannot be read or cannot be written.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::input::{Input, faults};
use crate::common::{finish, gramforge, unplaced};

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The command's one line about `spec` holds `words`.
fn refused(folder: &Path, spec: &Path, words: &[&str]) {
    let lines = faults(folder, &[spec.to_path_buf()]);
    let [line] = lines.as_slice() else { panic!("{lines:#?}") };
    assert!(unplaced(line).starts_with(&format!("{}: ", spec.display())), "{line}");
    for word in words {
        assert!(line.contains(word), "no {word:?} in {line}");
    }
}

#[test]
fn specification_is_missing() {
    let folder = folder();
    let words = ["cannot be read", "give the path of a specification file"];
    refused(folder.path(), &folder.path().join("nowhere.json"), &words);
}

#[test]
fn specification_is_a_folder() {
    let folder = folder();
    let path = folder.path().join("arm.json");
    fs::create_dir(&path).expect("a folder");
    refused(folder.path(), &path, &["cannot be read", "give the path of a specification file"]);
}

#[test]
fn specification_is_not_utf8() {
    let folder = folder();
    let path = folder.path().join("arm.json");
    fs::write(&path, [b'{', b'"', 0xff, 0xfe, b'"', b'}']).expect("written");
    refused(folder.path(), &path, &["cannot be read", "UTF-8"]);
}

#[test]
fn motion_is_a_folder() {
    let folder = folder();
    fs::create_dir(folder.path().join("motion.csv")).expect("a folder");
    let mut input = Input::good();
    input.set("/motion", serde_json::json!({ "csv": { "file": "motion.csv" } }));
    let spec = input.write(folder.path(), "arm.json");
    refused(folder.path(), &spec, &["motion.csv.file: ", "cannot read", "name a readable CSV file"]);
}

#[test]
fn motion_is_not_utf8() {
    let folder = folder();
    fs::write(folder.path().join("motion.csv"), [b'0', 0xff]).expect("written");
    let mut input = Input::good();
    input.set("/motion", serde_json::json!({ "csv": { "file": "motion.csv" } }));
    let spec = input.write(folder.path(), "arm.json");
    refused(folder.path(), &spec, &["motion.csv.file: ", "cannot read", "name a readable CSV file"]);
}

#[test]
fn output_below_a_file() {
    let folder = folder();
    let spec = Input::good().write(folder.path(), "arm.json");
    let blocked = folder.path().join("file");
    fs::write(&blocked, "not a folder").expect("written");
    for out in [blocked.clone(), blocked.join("below")] {
        let outcome = finish(gramforge().arg("generate").arg(&spec).arg("--out").arg(&out).arg("--json"));
        let outcome = outcome.expect(2);
        let start = format!("{}: cannot be written", out.join("arm3_xi2.rs").display());
        assert!(outcome.stderr.starts_with(&start), "{outcome:#?}");
        assert!(outcome.stderr.contains("; name a folder that can be written to"), "{outcome:#?}");
        assert_eq!(outcome.stderr.lines().count(), 1);
        assert_eq!(fs::read_to_string(&blocked).expect("readable"), "not a folder");
    }
}

#[test]
fn plot_below_a_file() {
    let folder = folder();
    let spec = Input::good().write(folder.path(), "arm.json");
    let outcome = finish(gramforge().arg("simulate").arg(&spec).arg("--plot").arg(spec.join("a.svg")));
    assert!(outcome.expect(2).stderr.contains("a.svg: cannot be written"));
}
