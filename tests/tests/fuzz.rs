//! Damaged specifications and robot files: no panic, no internal error, and an end in good time and memory.
//!
//! `FUZZ_INPUTS` says how many of each; `.ci/nightly` runs 20 000.

#[path = "fuzz/robots.rs"]
mod robots;
#[path = "fuzz/specifications.rs"]
mod specifications;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use gramforge::{Error, Generation, load};

/// Inputs of each kind where the environment does not say.
const INPUTS: usize = 500;
/// The longest that one input may take.
const LONGEST: Duration = Duration::from_secs(20);
/// The most memory that the whole process may have had, bytes.
const MEMORY: usize = 2_000_000_000;

fn inputs() -> usize {
    std::env::var("FUZZ_INPUTS").ok().and_then(|count| count.parse().ok()).unwrap_or(INPUTS)
}

fn outcome(text: &str, path: &Path) -> Result<(), Error> {
    let generation = Generation::new(load::parse(text, path)?)?;
    generation.module().map(drop)
}

/// The most memory that this process has had, bytes; 0 where the system does not say.
fn memory() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<usize>().ok()).map_or(0, |kb| 1000 * kb)
}

/// Runs all inputs; at least a twentieth must be generated and a twentieth refused.
fn run(kind: &str, input: impl Fn(usize) -> String, judge: impl Fn(usize) -> Result<(), Error>) {
    let (mut good, mut refused) = (0, 0);
    let mut slowest = (Duration::ZERO, 0);
    let mut failures = Vec::new();
    let count = inputs();
    for number in 0..count {
        let start = Instant::now();
        let fault = match catch_unwind(AssertUnwindSafe(|| judge(number))) {
            Ok(Ok(())) => {
                good += 1;
                None
            }
            Ok(Err(Error::Input(faults))) if !faults.is_empty() => {
                refused += 1;
                None
            }
            Ok(Err(error)) => Some(error.to_string()),
            Err(_) => Some("panic".to_string()),
        };
        slowest = slowest.max((start.elapsed(), number));
        let late = (start.elapsed() > LONGEST).then(|| format!("{:?}", start.elapsed()));
        failures.extend(fault.or(late).map(|what| format!("{kind} {number}: {what}\n{}", input(number))));
    }
    println!(
        "{kind}: {good} generated, {refused} refused, {} failed; slowest {:.1} s ({}), {} MB at most",
        failures.len(),
        slowest.0.as_secs_f64(),
        slowest.1,
        memory() / 1_000_000
    );
    let shown = failures.iter().take(5).cloned().collect::<Vec<_>>().join("\n\n");
    assert!(failures.is_empty(), "{} of {count}:\n{shown}", failures.len());
    assert!(good >= count / 20 && refused >= count / 20, "{good} generated, {refused} refused");
    assert!(memory() < MEMORY, "{} bytes", memory());
}

#[test]
fn the_unspoilt_inputs_are_good() {
    for motion in specifications::MOTIONS {
        outcome(&specifications::SPEC.replace("MOTION", motion), Path::new("whole.json"))
            .unwrap_or_else(|error| panic!("{error}"));
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("whole.urdf"), robots::ROBOT).expect("a file");
    outcome(&robots::SPEC.replace("FILE", "whole.urdf"), &folder.path().join("whole.json"))
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn damaged_specifications_are_generated_or_refused() {
    let judge = |number| outcome(&specifications::mutant(number), Path::new("mutant.json"));
    run("specification", specifications::mutant, judge);
}

#[test]
fn damaged_robot_files_are_generated_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mutant.urdf");
    let spec = robots::SPEC.replace("FILE", "mutant.urdf");
    let judge = |number| {
        std::fs::write(&file, robots::mutant(number)).expect("a file");
        outcome(&spec, &folder.path().join("mutant.json"))
    };
    run("robot file", |number| String::from_utf8_lossy(&robots::mutant(number)).into_owned(), judge);
}
