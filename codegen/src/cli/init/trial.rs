//! Trying a first specification out.

use std::fs;
use std::path::PathBuf;

use crate::bounds::Effort;
use crate::cache::Cache;
use crate::cli::progress::watched;
use crate::error::{Diagnostic, Error};
use crate::init::{First, Request, TRIALS, first};
use crate::pipeline::Generation;
use crate::progress::Stage;
use crate::report::worst;

/// A specification, what was said of it, and whether it can be used as it is.
pub(super) struct Tried {
    pub(super) first: First,
    pub(super) said: String,
    pub(super) good: bool,
}

/// The first specification with a promise, of those whose errors converge faster or slower; the last one otherwise. What is
/// promised, in words.
pub(super) fn tried(request: &Request) -> Result<Tried, Error> {
    let kept = Kept::new();
    let mut last = None;
    for (number, trial) in TRIALS.into_iter().enumerate() {
        let first = first(request, trial)?;
        let generation = watched(|progress| {
            let loaded = first.loaded.clone();
            let _stage = Stage::new(progress, "first design", 1);
            Generation::cached(loaded, &Effort::default(), progress, kept.cache.as_ref())
        });
        let said = match &generation {
            Err(Error::Input(faults)) => refused(faults),
            Err(_) => return Err(generation.err().unwrap_or(Error::Internal("a result was lost".into()))),
            Ok(generation) => promised(generation),
        };
        // Who mends what stood in the way may ask for more again.
        let slower = match number {
            0 => String::new(),
            _ => format!(
                "`convergence_time` is {:?} s: shorter times were tried first, without a promise\n",
                trial.convergence_time
            ),
        };
        match said {
            Ok(text) => return Ok(Tried { first, said: text + &slower, good: true }),
            Err(text) => last = Some(Tried { first, said: text + &slower, good: false }),
        }
    }
    last.ok_or_else(|| Error::Internal("no specification was tried".into()))
}

/// What one trial leaves for the next: the model and its bounds, in a folder that goes with it. Nothing is kept where the folder is
/// there already: what lies in it may be another's.
struct Kept {
    folder: Option<PathBuf>,
    cache: Option<Cache>,
}

impl Kept {
    fn new() -> Self {
        let folder = std::env::temp_dir().join(format!("gramforge-init-{}", std::process::id()));
        let folder = fs::create_dir(&folder).is_ok().then_some(folder);
        Self { cache: folder.as_deref().and_then(Cache::below), folder }
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if let Some(folder) = &self.folder {
            // Nothing depends on it.
            let _ = fs::remove_dir_all(folder);
        }
    }
}

/// Why the design was refused.
fn refused(faults: &[Diagnostic]) -> Result<String, String> {
    let list: Vec<String> = faults
        .iter()
        .map(|fault| format!("  {}: {}; {}\n", fault.field, fault.problem, fault.help))
        .collect();
    Err(format!(
        "Tried out: refused, so nothing is promised yet. Change the specification first:\n{}",
        list.concat()
    ))
}

/// What is promised of the loop; an error where that is nothing although it could be something.
fn promised(generation: &Generation) -> Result<String, String> {
    let verdict = generation.verdict();
    let Some(statement) = generation.statement() else {
        return Ok(format!("Tried out: {verdict}\n"));
    };
    let kind = statement.kind.name();
    let mut out = format!("Tried out: {verdict}\nGuarantee: {kind}");
    if let Some(sampled) = statement.promised() {
        let [any, end] =
            [&sampled.reach, &sampled.end_error].map(|errors| worst(&generation.arm().joints, errors));
        out += &format!("; |q - q_d| stays below {any} at any time, at the end of the motion below {end}");
    } else if let Some(reason) = statement.reasons.first() {
        out += &format!(": {reason}");
    }
    out.push('\n');
    let none = statement.promised().is_none() && kind == "none";
    if none { Err(out) } else { Ok(out) }
}
