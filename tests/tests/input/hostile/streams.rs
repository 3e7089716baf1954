//! Standard output that does not take what is printed, and inputs that can be read once.

use std::fs;
use std::process::Stdio;

use crate::common::{committed, finish, gramforge, value};

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_of() {
    let spec = committed("arm3_xi1");
    let spec = spec.to_str().expect("UTF-8");
    let full = || fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    for arguments in [
        &["inspect", spec][..],
        &["inspect", spec, "--json"],
        &["generate", spec, "--out", out],
        &["schema"],
        &["--help"],
        &["--version"],
    ] {
        let child =
            gramforge().args(arguments).stdout(full()).stderr(Stdio::piped()).spawn().expect("it starts");
        let output = child.wait_with_output().expect("it ends");
        let told = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains("standard output: cannot be written (No space left"), "{arguments:?}: {told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
}

/// A device without end is read up to a limit, whatever field or argument names it.
#[cfg(target_os = "linux")]
#[test]
fn an_endless_file_is_refused() {
    let spec = committed("arm3_xi1");
    let spec = spec.to_str().expect("UTF-8");
    for arguments in [&["inspect", "/dev/zero"][..], &["evaluate", spec, "--states", "/dev/zero"]] {
        let output = finish(gramforge().args(arguments)).expect(2);
        let told = "/dev/zero: cannot be read (it has more than 64 MiB); give ";
        assert!(output.stderr.starts_with(told), "{arguments:?}: {}", output.stderr);
    }
}

#[test]
fn a_closed_pipe_ends_it_quietly() {
    let spec = committed("arm3_xi1");
    for arguments in [&["inspect", spec.to_str().expect("UTF-8")][..], &["schema"], &["--help"]] {
        let mut command = gramforge();
        let mut child =
            command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(output.stderr.is_empty(), "{arguments:?}");
    }
}

/// What a pipe gives once must be what is used and what is hashed: the same module as from a file, and another one for
/// other bytes.
#[cfg(unix)]
#[test]
fn a_piped_table_is_read_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = |end: f64| format!("t,q1,q2,q3\n0,0,0.3,-1.2\n1,0.5,0.6,-1.5\n2.5,{end},1,-2\n");
    let path = folder.path().join("arm.json");
    let pipe = folder.path().join("motion.csv");
    let mut spec = value("arm3_xi1");
    spec["motion"] = serde_json::json!({ "csv": { "file": "motion.csv" } });
    fs::write(&path, spec.to_string()).expect("written");
    let module = |out: &str| {
        let out = folder.path().join(out);
        finish(gramforge().arg("generate").arg(&path).arg("--out").arg(&out)).expect(0);
        fs::read_to_string(out.join("arm3_xi1.rs")).expect("generated")
    };
    let piped = |out: &str, text: String| {
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
        let writer = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::write(pipe, text).expect("read by somebody")
        });
        let module = module(out);
        writer.join().expect("written");
        fs::remove_file(&pipe).expect("removed");
        module
    };
    let (one, two) = (piped("one", table(1.0)), piped("two", table(0.9)));
    let hash = |text: &str| text.lines().nth(1).map(str::to_string);
    assert!(one != two && hash(&one) != hash(&two), "other bytes, another hash");
    fs::write(&pipe, table(1.0)).expect("written");
    assert!(module("file") == one, "the same bytes, the same module");
}
