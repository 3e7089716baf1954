//! Names and paths that hold control characters, marks of direction, directives and code, in every place that takes one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rayon::prelude::*;
use serde_json::{Value, json};

use crate::common::{Outcome, finish, gramforge};

/// Characters that must not leave as they are.
const HIDDEN: [char; 28] = [
    '\0', '\x01', '\x07', '\x08', '\t', '\n', '\x0b', '\x0c', '\r', '\x1b', '\x7f', '\u{85}', '\u{9b}',
    '\u{61c}', '\u{200e}', '\u{200f}', '\u{202a}', '\u{202b}', '\u{202c}', '\u{202d}', '\u{202e}',
    '\u{2028}', '\u{2029}', '\u{2066}', '\u{2067}', '\u{2068}', '\u{2069}', '\u{80}',
];

/// What can be seen, and means something to a shell, to Rust, to Markdown, to XML or to cargo.
const SEEN: [&str; 12] = [
    "cargo::error=x",
    "cargo:rustc-link-arg=x",
    "*/ fn main() {}",
    "\"; panic!(); \"",
    "`code` [link](x)",
    "{0} {x:?} %s",
    "#![allow(warnings)]",
    "$(touch injected) `touch injected`; touch injected",
    "../../../injected",
    "é∫漢🤖",
    " ",
    "&amp;<b>",
];

fn corpus() -> Vec<String> {
    let directives = HIDDEN.iter().map(|c| format!("a{c}cargo:rustc-env=INJECTED=1"));
    let colours = HIDDEN.iter().map(|c| format!("{c}[31mred"));
    directives.chain(colours).chain(SEEN.map(str::to_string)).collect()
}

/// `text` as an XML attribute's value.
fn xml(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_ascii_alphanumeric() { c.to_string() } else { format!("&#{};", u32::from(c)) })
        .collect()
}

fn urdf(joint: &str, link: &str) -> String {
    let (joint, link) = (xml(joint), xml(link));
    format!(
        "<robot name=\"r\"><link name=\"base\"/><link name=\"{link}\"><inertial><mass value=\"1\"/>\
         <inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
         <joint name=\"{joint}\" type=\"revolute\"><parent link=\"base\"/><child link=\"{link}\"/><axis xyz=\"0 1 0\"/>\
         <limit lower=\"-2\" upper=\"2\" effort=\"9\" velocity=\"2\"/></joint></robot>"
    )
}

fn spec(name: &str) -> Value {
    json!({
        "name": name,
        "arm": { "urdf": "arm.urdf" },
        "motion": { "quintic": { "from": [0.1], "to": [0.6], "duration": 2.0 } },
        "model": "exact",
        "control": { "law": "exact", "period": 0.001, "W": 10.0, "Pqq": 4.0, "Omega": 16.0 }
    })
}

/// One specification for each place that takes a name or a path, with `word` there.
fn places(word: &str) -> Vec<(&'static str, Value, String)> {
    let plain = urdf("joint1", "link1");
    let mut out: Vec<(&str, Value, String)> = Vec::new();
    out.push(("name", spec(word), plain.clone()));
    out.push(("joint", spec("joint"), urdf(word, "link1")));
    out.push(("link", spec("link"), urdf("joint1", word)));
    let mut with = |name: &'static str, pointer: &str, value: Value| {
        let mut spec = spec(name);
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        spec.pointer_mut(parent).expect("a parent")[key] = value;
        out.push((name, spec, plain.clone()));
    };
    with("urdf", "/arm/urdf", json!(word));
    with("csv", "/motion", json!({ "csv": { "file": word } }));
    with("override", "/arm/joints", json!({ word: { "armature": 0.1 } }));
    with("lock", "/arm/lock", json!({ word: 0.0 }));
    with("tip", "/arm/tip", json!(word));
    with("field", "/simulation", json!({ word: 1.0 }));
    with("law", "/control/law", json!(word));
    out
}

fn is_raw(c: char) -> bool {
    c != '\n' && HIDDEN.contains(&c)
}

fn assert_plain(outcome: &Outcome, context: &str) {
    for text in [&outcome.stdout, &outcome.stderr] {
        assert!(!text.chars().any(is_raw), "{context}: {outcome:?}");
    }
}

/// All specifications at once, none of which may be accepted.
fn refused(folder: &Path, paths: &[PathBuf], context: &str) {
    let out = folder.join("out");
    let outcome =
        finish(gramforge().arg("generate").args(paths).arg("--out").arg(&out).arg("--json")).expect(2);
    assert_plain(&outcome, context);
    assert!(!out.exists());
    for path in paths {
        let folder = path.parent().expect("a folder").display().to_string();
        assert!(
            outcome.stderr.lines().any(|line| line.starts_with(&folder)),
            "{context}, {folder}: {outcome:?}"
        );
    }
    directives(folder, paths, false, context);
}

/// Every command about the specification at `path`; whether it was accepted.
fn run(folder: &Path, path: &Path, context: &str) -> bool {
    let out = folder.join("out");
    let generate =
        |more: &[&str]| finish(gramforge().arg("generate").arg(path).arg("--out").arg(&out).args(more));
    let outcome = generate(&["--json"]);
    assert_plain(&outcome, context);
    let good = outcome.code == Some(0);
    assert!(good || outcome.code == Some(2), "{context}: {outcome:?}");
    if good {
        outcome.json();
        let inspected = finish(gramforge().arg("inspect").arg(path).arg("--json"));
        assert_plain(&inspected, context);
        inspected.json();
        assert_plain(&finish(gramforge().arg("inspect").arg(path)), context);
        assert_plain(&generate(&["--check"]).expect(0), context);
        for entry in fs::read_dir(&out).expect("a folder") {
            let module = fs::read_to_string(entry.expect("an entry").path()).expect("readable");
            assert!(!module.chars().any(is_raw), "{context}: {module:?}");
        }
    } else {
        assert!(!outcome.stderr.is_empty() && !outcome.errors().is_empty(), "{context}: {outcome:?}");
    }
    directives(folder, &[path.to_path_buf()], good, context);
    good
}

/// What a build script tells cargo of them.
fn directives(folder: &Path, paths: &[PathBuf], good: bool, context: &str) {
    let out_dir = folder.join("out_dir");
    fs::create_dir_all(&out_dir).expect("a folder");
    let mut script = Command::new(env!("CARGO_BIN_EXE_build-script-under-test"));
    let told = finish(script.args(paths).env("OUT_DIR", &out_dir));
    assert_plain(&told, context);
    assert_eq!(told.code, Some(if good { 0 } else { 1 }), "{context}: {told:?}");
    for line in told.stdout.lines() {
        let known = ["cargo:rerun-if-changed=", "cargo:warning=", "cargo::error="];
        assert!(known.iter().any(|key| line.starts_with(key)), "{context}: {line:?}");
    }
    assert_eq!(
        good,
        !told.stdout.lines().any(|line| line.starts_with("cargo::error=")),
        "{context}: {told:?}"
    );
    for text in texts(&out_dir) {
        assert!(!text.chars().any(is_raw), "{context}: {text:?}");
    }
}

/// The files in a folder and in those below it, such as that of the cache.
fn texts(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let text = |path: std::path::PathBuf| match path.is_dir() {
        true => texts(&path),
        false => vec![fs::read_to_string(path).expect("readable")],
    };
    entries.flat_map(text).collect()
}

#[test]
fn no_name_or_path_leaves_raw() {
    let words = corpus();
    assert!(words.len() >= 60 && places("x").len() >= 6);
    let accepted: usize = words
        .par_iter()
        .map(|word| {
            let folder = tempfile::tempdir().expect("a folder");
            let write = |(place, spec, urdf): &(&str, Value, String)| {
                let folder = folder.path().join(place);
                fs::create_dir(&folder).expect("a folder");
                fs::write(folder.join("arm.urdf"), urdf).expect("written");
                let path = folder.join("arm.json");
                fs::write(&path, spec.to_string()).expect("written");
                path
            };
            let paths: Vec<PathBuf> = places(word).iter().map(write).collect();
            if word.contains(HIDDEN) {
                refused(folder.path(), &paths, &format!("{word:?}"));
                return 0;
            }
            let judge =
                |path: &&PathBuf| run(path.parent().expect("a folder"), path, &format!("{path:?} {word:?}"));
            paths.iter().filter(judge).count()
        })
        .sum();
    // Joints and links may be called what can be seen, which a blank cannot.
    let visible = SEEN.iter().filter(|word| !word.trim().is_empty()).count();
    assert!(accepted >= 2 * (visible - 1), "{accepted}");
}

/// Files and folders of the user's own are called what they are called; only what is printed of them is escaped.
#[cfg(unix)]
#[test]
fn paths_of_the_command_line_are_shown_escaped() {
    let words: Vec<String> = corpus().into_iter().filter(|word| !word.contains(['\0', '/', '['])).collect();
    assert!(words.len() > HIDDEN.len());
    words.par_iter().for_each(|word| {
        let folder = tempfile::tempdir().expect("a folder");
        let inner: PathBuf = folder.path().join(word);
        fs::create_dir(&inner).expect("a folder");
        fs::write(inner.join("arm.urdf"), urdf("joint1", "link1")).expect("written");
        let path = inner.join(format!("{word}.json"));
        fs::write(&path, spec("arm").to_string()).expect("written");
        assert!(run(&inner, &path, &format!("path {word:?}")));
        fs::write(&path, "{").expect("written");
        assert!(!run(&inner, &path, &format!("faulty file {word:?}")));
        let argument = finish(gramforge().arg(word));
        assert_plain(&argument, word);
        assert_eq!(argument.code, Some(2), "{argument:?}");
    });
}
