//! Several processes that write the same file, and targets that are no files.

use std::fs;
use std::process::{Child, Stdio};

use crate::common::{committed, finish, gramforge, value};

/// Pairs of processes; a thousand pairs of writers within one process stand beside the writer itself.
const PAIRS: usize = 40;

#[test]
fn pairs_of_processes_lose_and_tear_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let specs = [0.001, 0.002].map(|period| {
        let mut spec = value("arm3_exact");
        spec["control"]["period"] = serde_json::json!(period);
        let path = folder.path().join(format!("{period}.json"));
        fs::write(&path, spec.to_string()).expect("written");
        path
    });
    let start = |spec, out: &std::path::Path| -> Child {
        let mut command = gramforge();
        command.arg("generate").arg(spec).arg("--out").arg(out).stdout(Stdio::null());
        command.spawn().expect("it starts")
    };
    let alone = specs.each_ref().map(|spec| {
        let out = folder.path().join("alone");
        assert!(start(spec, &out).wait().expect("it ends").success());
        fs::read(out.join("arm3_exact.rs")).expect("generated")
    });
    assert_ne!(alone[0], alone[1]);
    let out = folder.path().join("out");
    for pair in 0..PAIRS {
        if pair % 2 == 0 {
            let _ = fs::remove_file(out.join("arm3_exact.rs"));
        }
        for mut child in specs.each_ref().map(|spec| start(spec, &out)) {
            assert!(child.wait().expect("it ends").success());
        }
        let found = fs::read(out.join("arm3_exact.rs")).expect("generated");
        assert!(alone.contains(&found), "pair {pair}: {} bytes", found.len());
        assert_eq!(fs::read_dir(&out).expect("a folder").count(), 1, "no temporary file stays");
    }
}

#[test]
fn one_target_that_cannot_be_written_leaves_all_as_they_were() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, blocked) = (folder.path().join("arm3_exact.rs"), folder.path().join("arm3_xi1.rs"));
    fs::write(&first, "old").expect("written");
    fs::create_dir(&blocked).expect("a folder");
    let mut command = gramforge();
    command.arg("generate").args(["arm3_exact", "arm3_xi1"].map(committed)).arg("--out").arg(folder.path());
    let refused = finish(&mut command).expect(2);
    let wanted = format!("{}: is a folder; remove it, or name another folder", blocked.display());
    assert!(refused.stderr.starts_with(&wanted), "{}", refused.stderr);
    assert_eq!(fs::read_to_string(&first).expect("readable"), "old");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
}

#[cfg(unix)]
#[test]
fn check_waits_for_no_pipe_and_counts_every_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm3_exact.rs");
    let run = |more: &[&str]| {
        let mut command = gramforge();
        finish(
            command.arg("generate").arg(committed("arm3_exact")).arg("--out").arg(folder.path()).args(more),
        )
    };
    assert!(std::process::Command::new("mkfifo").arg(&path).status().expect("mkfifo runs").success());
    run(&["--check"]).expect(1);
    assert!(run(&[]).expect(2).stderr.contains("is not a regular file"));
    fs::remove_file(&path).expect("removed");
    run(&[]).expect(0);
    run(&["--check"]).expect(0);
    let text = fs::read_to_string(&path).expect("readable");
    fs::write(&path, text.replace('\n', "\r\n")).expect("written");
    run(&["--check"]).expect(1);
}
