//! `gramforge diff`: what differs between two modules.

use std::path::{Path, PathBuf};

use clap::Args;

use super::json;
use super::progress::watched;
use crate::bounds::Effort;
use crate::changes::{Changes, ModuleText};
use crate::check::read;
use crate::error::Error;
use crate::load::Loaded;
use crate::pipeline::Generation;
use crate::report::changes_text;
use crate::sizes::{Size, run, with_gains};

/// Shows what differs between two modules: functions with their share, numbers that moved, costs, promises, then the source.
///
/// Each of A and B is a specification or a generated module (`.rs`). With --sizes it is one specification at two sizes.
#[derive(Debug, Args)]
#[command(after_help = "Example: gramforge diff arm.json --sizes exact,xi6")]
pub(super) struct Diff {
    /// The first specification or module.
    a: PathBuf,
    /// The second one; without --sizes.
    #[arg(conflicts_with = "sizes")]
    b: Option<PathBuf>,
    /// Two sizes of the specification A, such as exact,xi6: see `gramforge sweep`.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<Size>,
    /// Exit with 1 where the modules differ.
    #[arg(long)]
    exit_code: bool,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

impl Diff {
    /// What is printed, and whether the process ends with 1.
    pub(super) fn run(&self) -> Result<(String, bool), Error> {
        let [before, after] = self.modules()?;
        let changes = Changes::new(&before, &after);
        let text = if self.json { json(&changes)? } else { changes_text(&changes) };
        Ok((text, self.exit_code && changes.differ))
    }

    fn modules(&self) -> Result<[ModuleText; 2], Error> {
        match (&self.b, self.sizes.as_slice()) {
            (Some(b), _) => {
                // Both are read before anything is generated, which may take minutes.
                let [a, b] = both(source(&self.a), source(b))?;
                both(a.module(), b.module())
            }
            (None, [first, second]) => {
                let read = read(&self.a)?;
                let loaded = watched(|progress| with_gains(&read, progress))?;
                both(sized(&loaded, first), sized(&loaded, second))
            }
            (None, []) => {
                let help = "name a second one, or two sizes of a specification: --sizes exact,xi6";
                Err(Error::input(Path::new("arguments"), "", "name one module to compare", help))
            }
            (None, sizes) => {
                let problem = format!("names {} sizes", sizes.len());
                Err(Error::input(Path::new("arguments"), "--sizes", problem, "name two, such as exact,xi6"))
            }
        }
    }
}

/// The specification `loaded` at `size`.
fn sized(loaded: &Loaded, size: &Size) -> Result<ModuleText, Error> {
    let (_, generation) = watched(|progress| run(loaded, size, true, progress))?;
    ModuleText::new(size.label(), generation.module()?, &loaded.path)
}

/// What is compared: a module, or the specification of one.
enum Source {
    Module(Box<ModuleText>),
    Specification(Box<Loaded>),
}

fn source(path: &Path) -> Result<Source, Error> {
    if path.extension().is_some_and(|end| end == "rs") {
        return ModuleText::read(path).map(|text| Source::Module(Box::new(text)));
    }
    read(path).map(|loaded| Source::Specification(Box::new(loaded)))
}

impl Source {
    fn module(self) -> Result<ModuleText, Error> {
        let loaded = match self {
            Self::Module(text) => return Ok(*text),
            Self::Specification(loaded) => *loaded,
        };
        let path = loaded.path.clone();
        let generation = watched(|progress| Generation::with_progress(loaded, &Effort::default(), progress))?;
        ModuleText::new(path.display().to_string(), generation.module()?, &path)
    }
}

/// Both, or the faults of both.
fn both<T>(first: Result<T, Error>, second: Result<T, Error>) -> Result<[T; 2], Error> {
    match (first, second) {
        (Err(Error::Input(mut faults)), Err(Error::Input(more))) => {
            faults.extend(more.into_iter().filter(|fault| !faults.contains(fault)).collect::<Vec<_>>());
            Err(Error::Input(faults))
        }
        (first, second) => Ok([first?, second?]),
    }
}
