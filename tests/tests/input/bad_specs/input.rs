//! A good specification with its files, spoilt step by step, and what the command says of it.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{Outcome, finish, gramforge, value};

/// What a user might have written.
pub struct Input {
    /// The specification; starts as that of the three-link arm.
    pub spec: Value,
    /// The text of the specification where it is not `spec`'s.
    pub text: Option<Vec<u8>>,
    /// Files beside it.
    pub files: Vec<(&'static str, String)>,
}

impl Input {
    pub fn good() -> Self {
        Self { spec: value("arm3_xi2"), text: None, files: Vec::new() }
    }

    /// Sets the value at a JSON pointer, whose parent must exist.
    pub fn set(&mut self, pointer: &str, value: Value) -> &mut Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a JSON pointer");
        match self.spec.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}")) {
            Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
            other => other[key] = value,
        }
        self
    }

    /// Removes the member at a JSON pointer.
    pub fn remove(&mut self, pointer: &str) -> &mut Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a JSON pointer");
        let parent = self.spec.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
        parent.remove(key).unwrap_or_else(|| panic!("no {pointer}"));
        self
    }

    /// Sets a field of the link with this index.
    pub fn link(&mut self, index: usize, field: &str, value: Value) -> &mut Self {
        self.set(&format!("/arm/dh/links/{index}/{field}"), value)
    }

    /// Puts a field of the control section.
    pub fn control(&mut self, field: &str, value: Value) -> &mut Self {
        self.set(&format!("/control/{field}"), value)
    }

    /// The specification's text with its first `from` replaced.
    pub fn replace(&mut self, from: &str, to: &str) -> &mut Self {
        let text = self.spec.to_string();
        assert!(text.contains(from), "no {from} in {text}");
        self.text = Some(text.replacen(from, to, 1).into_bytes());
        self
    }

    /// A motion from a table.
    pub fn csv(&mut self, table: &str) -> &mut Self {
        self.files.push(("motion.csv", table.to_string()));
        self.set("/motion", json!({ "csv": { "file": "motion.csv" } }))
    }

    /// An arm of one joint from a URDF file with these elements inside `<robot>`.
    pub fn urdf(&mut self, elements: &str) -> &mut Self {
        self.urdf_text(&format!("<robot name=\"r\">{elements}</robot>"))
    }

    /// An arm of one joint from this text of a URDF file.
    pub fn urdf_text(&mut self, text: &str) -> &mut Self {
        self.files.push(("arm.urdf", text.to_string()));
        self.set("/arm", json!({ "urdf": "arm.urdf" })).set("/model", json!("exact"));
        self.set("/motion", json!({ "quintic": { "from": [0.0], "to": [1.0], "duration": 2.0 } }))
    }

    /// Writes everything into `folder`, the specification as `name`, and gives its path.
    pub fn write(&self, folder: &Path, name: &str) -> PathBuf {
        for (file, text) in &self.files {
            fs::write(folder.join(file), text).expect("written");
        }
        let path = folder.join(name);
        let text = self.text.clone().unwrap_or_else(|| self.spec.to_string().into_bytes());
        fs::write(&path, text).expect("written");
        path
    }
}

/// A link of a URDF file with a mass of 1 kg.
pub fn urdf_link(name: &str) -> String {
    format!(
        "<link name=\"{name}\"><inertial><mass value=\"1\"/>\
         <inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
    )
}

/// A joint of a URDF file about z, with further elements.
pub fn urdf_joint(name: &str, kind: &str, parent: &str, child: &str, more: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" velocity=\"2\" effort=\"9\"/>{more}</joint>"
    )
}

/// The fault lines of `gramforge generate SPECS --out DIR --json`; see [`refused`].
pub fn faults(folder: &Path, specs: &[PathBuf]) -> Vec<String> {
    refused(folder, specs).faults()
}

/// `gramforge generate SPECS --out DIR --json`, after asserting exit code 2, the same faults on standard output as on
/// standard error, and an output folder that stays as it was.
pub fn refused(folder: &Path, specs: &[PathBuf]) -> Outcome {
    let out = folder.join("out");
    fs::create_dir_all(&out).expect("a folder");
    let standing = out.join("arm3_xi2.rs");
    fs::write(&standing, "standing\n").expect("written");
    let before = fs::metadata(&standing).and_then(|m| m.modified()).expect("a time");
    let outcome = finish(gramforge().arg("generate").args(specs).arg("--out").arg(&out).arg("--json"));
    let fresh = folder.join("fresh");
    let again = finish(gramforge().arg("generate").args(specs).arg("--out").arg(&fresh).arg("--json"));

    let outcome = outcome.expect(2);
    assert_eq!(again.expect(2).stderr, outcome.stderr, "the same faults every time");
    assert!(!fresh.exists(), "the output folder was created");
    let files: Vec<_> = fs::read_dir(&out).expect("a folder").map(|e| e.expect("an entry").path()).collect();
    assert_eq!(files.as_slice(), std::slice::from_ref(&standing), "nothing else was written");
    assert_eq!(fs::read_to_string(&standing).expect("readable"), "standing\n");
    assert_eq!(fs::metadata(&standing).and_then(|m| m.modified()).expect("a time"), before);
    let lines = outcome.faults();
    let told = lines.iter().filter(|line| !line.starts_with("and ")).count();
    assert_eq!(outcome.errors().len().min(MOST_TOLD), told, "{outcome:#?}");
    for (error, line) in outcome.errors().iter().zip(&lines) {
        let text = |key: &str| error[key].as_str().expect("a text").to_string();
        for part in [text("file"), text("field")] {
            assert!(line.contains(&part), "{part:?} is not in {line:?}");
        }
        assert!(
            error["column"].is_null() || line.contains(&format!(":{}:{}: ", error["line"], error["column"]))
        );
    }
    outcome
}

/// Faults that are shown.
const MOST_TOLD: usize = 100;
