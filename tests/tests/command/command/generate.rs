//! `gramforge generate`: when files are written, and that the same specification gives the same bytes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde_json::Value;

use crate::common::{Outcome, committed, finish, gramforge, root, run, text, value};

fn generate(spec: &Path, out: &Path, more: &[&str]) -> Outcome {
    finish(gramforge().arg("generate").arg(spec).arg("--out").arg(out).args(more))
}

/// Every file below `folder` with its bytes and its time of writing.
fn state(folder: &Path) -> BTreeMap<String, (Vec<u8>, SystemTime)> {
    let mut out = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let time = fs::metadata(&path).and_then(|m| m.modified()).expect("a time");
        out.insert(text(&path), (fs::read(&path).expect("readable"), time));
    }
    out
}

/// Turns back the clock of a file, so that any writing shows.
fn age(path: &Path) {
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    fs::File::options().append(true).open(path).and_then(|f| f.set_modified(long_ago)).expect("a time");
}

#[test]
fn writes_once_and_then_leaves_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = committed("arm3_xi2");
    let first = generate(&spec, folder.path(), &["--json"]).json();
    assert_eq!(first[0]["written"], true);
    let path = folder.path().join("arm3_xi2.rs");
    assert_eq!(first[0]["path"], text(&path));
    assert_eq!(first[0]["bytes"], fs::read(&path).expect("readable").len());
    age(&path);
    let before = state(folder.path());
    let second = generate(&spec, folder.path(), &["--json"]).json();
    assert_eq!(second[0]["written"], false);
    assert_eq!(state(folder.path()), before);
    assert!(generate(&spec, folder.path(), &[]).expect(0).stdout.contains("unchanged"));
}

#[test]
fn check_tells_current_from_stale_from_missing_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, out) = (committed("arm3_xi2"), folder.path().join("out"));
    let missing = generate(&spec, &out, &["--check"]).expect(1);
    assert!(missing.stderr.contains("arm3_xi2.rs differs from what its specification gives"), "{missing:#?}");
    let command = format!("`gramforge generate {} --out {}`", spec.display(), out.display());
    assert!(missing.stderr.contains(&command), "{missing:#?}");
    assert!(!out.exists());

    generate(&spec, &out, &[]).expect(0);
    let path = out.join("arm3_xi2.rs");
    age(&path);
    let before = state(&out);
    assert!(generate(&spec, &out, &["--check"]).expect(0).stdout.contains("current"));
    assert_eq!(state(&out), before);

    let good = fs::read_to_string(&path).expect("readable");
    fs::write(&path, good.replacen('0', "1", 1)).expect("written");
    age(&path);
    let before = state(&out);
    let stale = generate(&spec, &out, &["--check", "--json"]).expect(1);
    assert_eq!(stale.stderr, missing.stderr);
    assert_eq!(state(&out), before);
}

#[test]
fn check_takes_bad_input_for_bad_input() {
    let folder = tempfile::tempdir().expect("a folder");
    generate(&folder.path().join("nowhere.json"), folder.path(), &["--check"]).expect(2);
    run(["generate"]).expect(2);
    run(["generalise"]).expect(2);
    run(["--version"]).expect(0);
    run(["--help"]).expect(0);
}

#[test]
fn the_same_bytes_from_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = committed("arm3_xi2");
    let generated = |name: &str| fs::read(folder.path().join(name).join("arm3_xi2.rs")).expect("generated");
    generate(&spec, &folder.path().join("plain"), &[]).expect(0);
    let plain = generated("plain");

    let moved = folder.path().join("moved.json");
    fs::write(&moved, reversed(&value("arm3_xi2"))).expect("written");
    generate(&moved, &folder.path().join("moved"), &[]).expect(0);
    assert!(generated("moved") == plain, "shuffled keys, another file");

    let inside = finish(gramforge().current_dir(&folder).args(["generate", "moved.json", "--out", "inside"]));
    inside.expect(0);
    assert!(generated("inside") == plain, "another working directory");

    for threads in ["1", "2"] {
        let out = folder.path().join(threads);
        let mut command = gramforge();
        command.env("RAYON_NUM_THREADS", threads).arg("generate").arg(&spec).arg("--out").arg(&out);
        finish(&mut command).expect(0);
        assert!(generated(threads) == plain, "{threads} threads");
    }
}

/// JSON with the members of every object in reverse order, and other white space.
fn reversed(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let members: Vec<String> =
                map.iter().rev().map(|(key, value)| format!("\"{key}\" :\n\t{}", reversed(value))).collect();
            format!("{{ {} }}", members.join(" ,\n"))
        }
        Value::Array(list) => {
            format!("[ {} ]", list.iter().map(reversed).collect::<Vec<_>>().join(" , "))
        }
        other => other.to_string(),
    }
}

#[test]
fn several_specifications_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["arm3_xi1", "arm3_xi2", "arm3_exact"];
    let specs = names.map(committed);
    let done = finish(gramforge().arg("generate").args(&specs).arg("--out").arg(folder.path()).arg("--json"));
    let list = done.json();
    for (index, name) in names.iter().enumerate() {
        let path = folder.path().join(format!("{name}.rs"));
        assert_eq!(list[index]["path"], text(&path));
        assert!(path.exists());
    }
    assert_eq!(state(folder.path()).len(), names.len(), "no partial file stays behind");
}

#[test]
fn the_committed_modules_are_current() {
    let specs = ["arm3_exact", "arm3_xi1", "arm3_xi2", "arm3_xi3"].map(|name| format!("specs/{name}.json"));
    let mut command = gramforge();
    command.current_dir(root().join("generated")).arg("generate").args(specs);
    finish(command.args(["--out", "src", "--check"])).expect(0);
}
