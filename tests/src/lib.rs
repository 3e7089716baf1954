//! What the integration tests in `tests/` share: arms, reference values, random states.

pub mod chain;
pub mod double;
pub mod gains;
pub mod oracle;
pub mod plant;
pub mod random;
pub mod scratch;
pub mod tracked;
pub mod truth;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use gramforge::Generation;
use gramforge::internals::arm::{Arm, Built};
use gramforge::internals::check::prepare;
use gramforge::internals::error::Diagnostics;
use gramforge::internals::motion::Motion;
use gramforge::load::{Loaded, parse};
use serde_json::Value;

/// A fault line without the line and column that stand between the name of the file and the field.
pub fn unplaced(line: &str) -> String {
    let end = |word: &str| line.find(&format!("{word}:")).map(|at| at + word.len());
    let Some(end) = [".json", ".jsonc", ".urdf", ".csv"].into_iter().filter_map(end).min() else {
        return line.to_string();
    };
    let place = line[end..].trim_start_matches(|c: char| c == ':' || c.is_ascii_digit());
    if place.starts_with(' ') { format!("{}:{place}", &line[..end]) } else { line.to_string() }
}

/// The specification file of `name`, from `data/` or else from the committed ones.
pub fn spec(name: &str) -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let own = here.join("data").join(format!("{name}.json"));
    if own.exists() { own } else { here.join("../generated/specs").join(format!("{name}.json")) }
}

/// The arm of specification `name`.
pub fn arm(name: &str) -> Arm {
    prepare(&spec(name)).unwrap_or_else(|error| panic!("{error}")).built.arm
}

/// The motion of specification `name`.
pub fn motion(name: &str) -> Motion {
    let checked = prepare(&spec(name)).unwrap_or_else(|error| panic!("{error}"));
    let mut faults = Diagnostics::of(&checked.loaded.path);
    let spec = checked.loaded.spec.motion.as_ref().expect("the specification has a motion");
    Motion::from_spec(spec, checked.built.arm.dof(), &checked.loaded, &mut faults)
        .expect("a motion without faults")
}

/// All stages for specification `name`, made once in a test binary.
pub fn generation(name: &str) -> Arc<Generation> {
    static MADE: Mutex<BTreeMap<String, Arc<OnceLock<Arc<Generation>>>>> = Mutex::new(BTreeMap::new());
    // The lock on all names is not held while one is made; another test that wants the same waits for it.
    let own =
        MADE.lock().unwrap_or_else(PoisonError::into_inner).entry(name.to_string()).or_default().clone();
    own.get_or_init(|| {
        Generation::from_file(&spec(name)).map(Arc::new).unwrap_or_else(|error| panic!("{error}"))
    })
    .clone()
}

/// All stages for specification `name` with some of its JSON changed.
///
/// # Errors
/// The message of the first stage that refuses it.
pub fn edited(name: &str, edit: impl FnOnce(&mut Value)) -> Result<Generation, String> {
    let loaded = edited_spec(name, edit)?;
    Generation::new(loaded).map_err(|error| error.to_string())
}

/// The arm of specification `name` with some of its JSON changed, and the family that it allows.
pub fn edited_arm(name: &str, edit: impl FnOnce(&mut Value)) -> Built {
    let loaded = edited_spec(name, edit).unwrap_or_else(|message| panic!("{message}"));
    let mut faults = Diagnostics::of(&loaded.path);
    Arm::from_spec(&loaded, &mut faults).unwrap_or_else(|| panic!("{}", faults.into_error()))
}

fn edited_spec(name: &str, edit: impl FnOnce(&mut Value)) -> Result<Loaded, String> {
    let path = spec(name);
    let text = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
    let mut value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    edit(&mut value);
    parse(&value.to_string(), &path).map_err(|error| error.to_string())
}

/// `values` as an array.
pub fn array<const N: usize>(values: &[f64]) -> [f64; N] {
    values.try_into().expect("one entry a joint")
}

/// Largest |x|.
pub fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Largest |a − b| over two sequences of the same length.
pub fn difference<'a>(a: impl IntoIterator<Item = &'a f64>, b: impl IntoIterator<Item = &'a f64>) -> f64 {
    let (a, b): (Vec<&f64>, Vec<&f64>) = (a.into_iter().collect(), b.into_iter().collect());
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| {
        let apart = (*a - b).abs();
        // max() would drop a NaN.
        if apart.is_nan() { f64::INFINITY } else { most.max(apart) }
    })
}

/// The code of README.md, compiled.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// The code of the guide for the first steps, compiled; the simulation runs.
#[cfg(doctest)]
#[doc = include_str!("../../docs/guides/start.md")]
struct Start;
