//! Damaged specifications and robot files: no panic, no internal error, and an end in good time and memory.
//!
//! `FUZZ_INPUTS` says how many of each; `.ci/nightly` runs 20 000.

mod robots;
mod specifications;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use gramforge::{Error, Generation, load};
use serde_json::Value;

/// Inputs of each kind where the environment does not say.
const INPUTS: usize = 1000;
/// The longest that one input may take.
const LONGEST: Duration = Duration::from_secs(20);
/// The most memory that the whole process may have had, bytes.
const MEMORY: usize = 2_000_000_000;

fn inputs() -> usize {
    let given = std::env::var("FUZZ_INPUTS").ok();
    given.map_or(INPUTS, |text| {
        text.parse().unwrap_or_else(|_| panic!("FUZZ_INPUTS is {text:?}, no whole number"))
    })
}

fn outcome(text: &str, path: &Path) -> Result<(), Error> {
    let generation = Generation::new(load::parse(text, path)?)?;
    generation.module().map(drop)
}

/// The most memory that this process has had, bytes; `None` where the system does not say.
fn memory() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse::<usize>().ok().map(|kibibytes| 1024 * kibibytes)
}

/// Whether an input was generated; a message where it was neither generated nor refused.
fn judged(text: &str, path: &Path) -> Result<bool, String> {
    match catch_unwind(AssertUnwindSafe(|| outcome(text, path))) {
        Ok(Ok(())) => Ok(true),
        Ok(Err(Error::Input(faults))) if !faults.is_empty() => Ok(false),
        Ok(Err(error)) => Err(error.to_string()),
        Err(_) => Err("panic".to_string()),
    }
}

/// Judges `count` inputs on a thread of its own, so that one that does not end is told. `input` gives the specification,
/// beside which it may write files.
fn run(
    kind: &'static str,
    count: usize,
    folder: &Path,
    input: impl Fn(usize, &Path) -> String + Send + 'static,
) {
    let (started, starts) = channel();
    let path = folder.join("mutant.json");
    let worker = std::thread::spawn(move || {
        let (mut good, mut failures, mut slowest) = (0, Vec::new(), (Duration::ZERO, 0));
        for number in 0..count {
            let text = input(number, path.parent().expect("a folder"));
            let start = Instant::now();
            // The watcher is gone only where it has failed already.
            let _ = started.send((number, text.clone()));
            match judged(&text, &path) {
                Ok(generated) => good += usize::from(generated),
                Err(what) => failures.push(format!("{kind} {number}: {what}\n{text}")),
            }
            slowest = slowest.max((start.elapsed(), number));
        }
        (good, failures, slowest)
    });
    let mut last = (0, String::new());
    loop {
        match starts.recv_timeout(LONGEST) {
            Ok(now) => last = now,
            Err(std::sync::mpsc::RecvTimeoutError::Disconnected) => break,
            Err(_) => panic!("{kind} {} takes more than {LONGEST:?}:\n{}", last.0, last.1),
        }
    }
    let (good, failures, slowest) = worker.join().expect("a thread that catches panics");
    let (refused, most) = (count - good - failures.len(), memory());
    println!(
        "{kind}: {good} generated, {refused} refused, {} failed; slowest {:.1} s ({}), {} MB at most",
        failures.len(),
        slowest.0.as_secs_f64(),
        slowest.1,
        most.map_or("unknown".to_string(), |bytes| (bytes / 1_000_000).to_string())
    );
    let shown = failures.iter().take(5).cloned().collect::<Vec<_>>().join("\n\n");
    assert!(failures.is_empty(), "{} of {count}:\n{shown}", failures.len());
    assert!(good > count / 20 && refused > count / 4, "{good} generated, {refused} refused");
    assert!(most.is_none_or(|bytes| bytes < MEMORY), "{most:?} bytes");
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("motion.csv"), specifications::CSV).expect("a file");
    std::fs::write(folder.path().join("robot.urdf"), robots::ROBOT).expect("a file");
    folder
}

/// Every base, every variant of some base, and the robot under every specification are good before they are damaged.
#[test]
fn the_unspoilt_inputs_are_good() {
    let folder = folder();
    let path = folder.path().join("whole.json");
    let good = |spec: &Value| outcome(&spec.to_string(), &path);
    for number in 0..specifications::BASES {
        good(&specifications::base(number)).unwrap_or_else(|error| panic!("base {number}: {error}"));
    }
    for number in 0..specifications::variants() {
        let tried: Vec<_> = (0..specifications::BASES)
            .map(|base| good(&specifications::varied(specifications::base(base), number)))
            .collect();
        assert!(tried.iter().any(Result::is_ok), "variant {number}: {tried:?}");
    }
    for spec in robots::SPECS {
        outcome(spec, &path).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn damaged_specifications_are_generated_or_refused() {
    let folder = folder();
    run("specification", inputs(), folder.path(), |number, _| specifications::mutant(number));
}

#[test]
fn damaged_robot_files_are_generated_or_refused() {
    let folder = folder();
    run("robot file", inputs(), folder.path(), |number, folder| {
        std::fs::write(folder.join("robot.urdf"), robots::mutant(number)).expect("a file");
        robots::SPECS[number % robots::SPECS.len()].to_string()
    });
}

/// Found were: a spline of which three seconds of an optimised build went into pieces that were looked at again in every
/// round, though nothing was left to do for them; sinusoids of 1e300 s, which took without end; a link so heavy that no
/// gains bear it, whose search took half a minute.
#[test]
fn inputs_that_were_found_are_judged() {
    let folder = folder();
    let mut slow = specifications::base(1);
    slow["arm"]["dh"]["links"][0]["limits"]["acceleration"] = Value::Null;
    slow["control"]["initial_error"]["velocity"] = serde_json::json!([0.0, 1e-18]);
    let mut endless = specifications::base(0);
    endless["motion"] = serde_json::json!({ "sinusoids": {
        "duration": 1e300, "offset": [0.1, 0.2],
        "terms": [[{ "amplitude": 0.5, "frequency": 2.0, "phase": 0.1 }], []]
    } });
    let mut heavy = specifications::base(specifications::BASES - 1);
    heavy["arm"]["dh"]["links"][2]["inertia"] =
        serde_json::json!({ "xx": 4_294_967_295.0, "yy": 0.05, "zz": std::f64::consts::FRAC_PI_2 });
    heavy["control"] = serde_json::json!({
        "law": "report", "design": { "convergence_time": 2.0, "period": 0.001 },
        "initial_error": { "position": 0.001 }
    });
    for (spec, good) in [(slow, true), (endless, false), (heavy, false)] {
        let path = folder.path().join("found.json");
        let (sender, done) = channel();
        std::thread::spawn(move || sender.send(judged(&spec.to_string(), &path)));
        assert_eq!(done.recv_timeout(LONGEST).expect("an end in good time"), Ok(good));
    }
}
