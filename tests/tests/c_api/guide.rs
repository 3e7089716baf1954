//! What `docs/guides/c.md` shows is compiled and run.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::build::{generate, installed, lock, patch, with_c_api};

const GUIDE: &str = include_str!("../../../docs/guides/c.md");

/// The block of the guide in `language`.
fn block(language: &str) -> &'static str {
    let start = format!("```{language}\n");
    let mut blocks =
        GUIDE.split(start.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap_or_default());
    let block = blocks.next().unwrap_or_else(|| panic!("a block in {language}"));
    assert!(blocks.next().is_none(), "one block in {language}");
    block
}

/// Runs the command to its end, as a user does; what it prints.
fn run(folder: &Path, program: &str, arguments: &[&str]) -> String {
    let mut command = Command::new(program);
    command.current_dir(folder).args(arguments);
    for (name, _) in std::env::vars().filter(|(name, _)| name.starts_with("CARGO_") && name != "CARGO_HOME") {
        command.env_remove(name);
    }
    let output = command.output().expect("it starts");
    let [out, err] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(output.status.success(), "{program} {arguments:?}: {out}{err}");
    out
}

#[test]
fn the_guide_builds_and_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    generate(&[with_c_api("arm3_xi2")], &path.join("specs"), &path.join("generated"));
    lock(&path.join("generated/arm3_xi2_c"));
    patch(path);
    for (file, language) in [("main.c", "c"), ("Makefile", "makefile"), ("CMakeLists.txt", "cmake")] {
        fs::write(path.join(file), block(language)).expect("written");
    }
    let shown = block("text");
    if installed("make") {
        run(path, "make", &[]);
        assert_eq!(run(path, "./main", &[]), shown);
    }
    if installed("cmake") {
        run(path, "cmake", &["-S", ".", "-B", "build"]);
        run(path, "cmake", &["--build", "build"]);
        assert_eq!(run(path, "./build/main", &[]), shown);
    }
}
