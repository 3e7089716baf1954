//! What every command has in common.

use std::fs;

use serde_json::Value;

use crate::common::{committed, finish, gramforge, run, text};

const COMMANDS: [&str; 12] = [
    "init",
    "inspect",
    "evaluate",
    "generate",
    "simulate",
    "sweep",
    "diff",
    "report",
    "reproduce",
    "schema",
    "completions",
    "man",
];

#[test]
fn every_command_has_help_with_an_example_and_a_page_of_the_manual() {
    for command in COMMANDS {
        let help = run([command, "--help"]).expect(0).stdout;
        assert!(help.contains("Example"), "{command}:\n{help}");
        assert!(
            help.contains("--quiet") && help.contains("--threads") && help.contains("--color"),
            "{command}"
        );
    }
    let page = run(["man"]).expect(0).stdout;
    assert!(page.contains(".TH gramforge 1"), "{page}");
    for command in COMMANDS.iter().take(10) {
        assert!(run(["man", command]).expect(0).stdout.contains(".SH SYNOPSIS"), "{command}");
        assert!(page.contains(command), "{command} is not in the manual");
    }
    for shell in ["bash", "zsh", "fish"] {
        assert!(run(["completions", shell]).expect(0).stdout.contains("inspect"), "{shell}");
    }
}

#[test]
fn colours_and_silence_are_as_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.json");
    fs::write(&path, "{ \"arm\": 3 }").expect("written");
    let inspect = |more: &[&str]| finish(gramforge().arg("inspect").arg(&path).args(more)).expect(2).stderr;
    assert!(!inspect(&[]).contains('\u{1b}'), "no terminal, no colour");
    assert!(!inspect(&["--color", "never"]).contains('\u{1b}'));
    assert!(inspect(&["--color", "always"]).contains("\u{1b}["));
    assert_eq!(inspect(&["--quiet"]), inspect(&[]), "faults are told all the same");

    let loud = run(["inspect", &text(&committed("puma560_xi6"))]).expect(0);
    assert!(loud.stderr.starts_with("warning: "), "{}", loud.stderr);
    let quiet = run(["--quiet", "inspect", &text(&committed("puma560_xi6"))]).expect(0);
    assert_eq!((quiet.stderr.as_str(), quiet.stdout), ("", loud.stdout));
}

#[test]
fn the_number_of_threads_changes_nothing_but_the_time() {
    let spec = text(&committed("arm3_xi2"));
    let one = run(["inspect", &spec, "--json", "--threads", "1"]).expect(0).stdout;
    assert_eq!(run(["inspect", &spec, "--json", "--threads", "3"]).expect(0).stdout, one);
    let refused = run(["inspect", &spec, "--threads", "0"]).expect(2);
    assert!(refused.stderr.starts_with("command line: --threads: is 0; write a number from 1 to 1024"));
}

#[test]
fn faults_as_json_name_their_places() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.jsonc");
    let refused = |text: &str| {
        fs::write(&path, text).expect("written");
        finish(gramforge().arg("inspect").arg(&path).arg("--json")).expect(2)
    };
    let place = |error: &Value| ["line", "column", "end_column"].map(|key| error[key].as_u64());
    let outcome = refused("{\n  // a comment\n  \"arm\": { \"urdf\": \"ä.urdf\", \"tipp\": 1 }\n}");
    let misspelt = &outcome.errors()[0];
    assert_eq!(misspelt["field"], "arm.tipp");
    assert_eq!(place(misspelt), [Some(3), Some(30), Some(36)], "{outcome:#?}");
    let line = "3 |   \"arm\": { \"urdf\": \"ä.urdf\", \"tipp\": 1 }\n";
    assert!(outcome.stderr.contains(line), "{}", outcome.stderr);

    // A fault of a value has its place too.
    let outcome = refused("{ \"arm\": { \"urdf\": \"ä.urdf\" } }");
    let missing = &outcome.errors()[0];
    assert_eq!(missing["field"], "arm.urdf");
    assert_eq!(place(missing), [Some(1), Some(20), Some(28)], "{outcome:#?}");
}
