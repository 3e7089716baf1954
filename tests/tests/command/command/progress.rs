//! What the command says of long work while it lasts: nothing, where standard error is not a terminal.

use std::fs;

use serde_json::json;

use crate::common::{finish, gramforge, value};

#[test]
fn a_pipe_hears_nothing_of_progress() {
    let folder = tempfile::tempdir().expect("a folder");
    // The search for gains takes seconds, so that a bar would have had the time to appear.
    let mut spec = value("arm3_xi2");
    spec["control"] = json!({
        "law": "tight",
        "design": { "convergence_time": 1.5, "tube": 0.1 },
        "initial_error": { "position": 0.02 },
    });
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    for command in ["inspect", "simulate"] {
        let quiet = finish(gramforge().arg(command).arg(&path).arg("--json"));
        quiet.json();
        assert_eq!(quiet.stderr, "", "{command}");
    }
    let out = folder.path().join("out");
    let quiet = finish(gramforge().arg("generate").arg(&path).arg("--out").arg(&out)).expect(0);
    assert_eq!(quiet.stderr, "", "generate");
}
