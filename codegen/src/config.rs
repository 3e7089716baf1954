//! The builder for `build.rs`, and the engine of the command.

mod build_script;
mod made;
mod modules;

use std::io::stdout;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use made::Made;

use crate::bounds::Effort;
use crate::cache::Cache;
use crate::check::read;
use crate::error::{Diagnostics, Error, Stale};
use crate::load::Loaded;
use crate::output::{Wanted, is_current, write_all};
use crate::pipeline::Generation;
use crate::progress::{Progress, Silent, Titled};

/// Generates modules from specifications.
///
/// ```no_run
/// // In build.rs, inside main:
/// gramforge::Config::new().spec("specs/arm.json").run_in_build_script();
/// ```
///
/// and in the crate, which depends on `gramforge-runtime`:
///
/// ```ignore
/// mod arm {
///     include!(concat!(env!("OUT_DIR"), "/arm.rs"));
/// }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Config {
    specs: Vec<PathBuf>,
    out_dir: Option<PathBuf>,
    effort: Effort,
    progress: Option<Arc<dyn Progress>>,
    uncached: bool,
}

/// One generated module.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct Output {
    /// The file: the output folder, the specification's name, `.rs`.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Whether the file was written: it was missing, or its content was different.
    pub written: bool,
    /// The C interface, where the specification asks for it.
    pub c_files: Vec<OutputFile>,
    /// What the module was made from.
    pub generation: Generation,
}

/// A file beside a module.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct OutputFile {
    /// Where it is.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Whether it was written: it was missing, or its content was different.
    pub written: bool,
}

impl Output {
    /// All files: the module first.
    fn wanted(&self) -> Vec<Wanted<'_>> {
        let module: Wanted = (&self.path, &self.text);
        let beside = self.c_files.iter().map(|file| -> Wanted { (&file.path, &file.text) });
        std::iter::once(module).chain(beside).collect()
    }
}

impl Config {
    /// No specification yet; output to `OUT_DIR`.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a specification file.
    #[must_use]
    pub fn spec(mut self, path: impl Into<PathBuf>) -> Self {
        self.specs.push(path.into());
        self
    }

    /// Sets the folder that the modules go to.
    #[must_use]
    pub fn out_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(path.into());
        self
    }

    /// Sets how much work each bound may take. More gives smaller bounds; every bound is certified in any case.
    #[must_use]
    pub fn effort(mut self, effort: Effort) -> Self {
        self.effort = effort;
        self
    }

    /// Sets where progress is reported; by default it is not reported.
    #[must_use]
    pub fn progress(mut self, progress: Arc<dyn Progress>) -> Self {
        self.progress = Some(progress);
        self
    }

    /// Sets whether [`Config::run_in_build_script`] may use the results of earlier runs in `OUT_DIR`, which it does by
    /// default. They come from the same specification, files, effort and generator, and have the same bytes.
    #[must_use]
    pub fn cache(mut self, cache: bool) -> Self {
        self.uncached = !cache;
        self
    }

    /// Generates every module, with the C interface where it is asked for, and writes the files that changed. No file is touched unless all can be generated and written.
    ///
    /// # Errors
    /// [`Error::Input`] with the faults of all specifications, or where a file cannot be written.
    pub fn generate(&self) -> Result<Vec<Output>, Error> {
        let mut outputs = self.build(self.load())?;
        let written = write_all(&outputs.iter().flat_map(Output::wanted).collect::<Vec<_>>())?;
        let flags = outputs.iter_mut().flat_map(|output| {
            std::iter::once(&mut output.written)
                .chain(output.c_files.iter_mut().map(|file| &mut file.written))
        });
        for (flag, written) in flags.zip(written) {
            *flag = written;
        }
        Ok(outputs)
    }

    /// Compares every module, and every file of a C interface, with its file, byte for byte, and writes nothing.
    ///
    /// # Errors
    /// [`Error::Stale`] with every file that differs or is missing; otherwise as [`Config::generate`].
    pub fn check(&self) -> Result<Vec<Output>, Error> {
        let outputs = self.build(self.load())?;
        let mut stale = Vec::new();
        for (output, spec) in outputs.iter().zip(&self.specs) {
            let folder = output.path.parent().unwrap_or(Path::new(".")).display();
            let command = format!("gramforge generate {} --out {folder}", spec.display());
            let differing = output.wanted().into_iter().filter(|(path, text)| !is_current(path, text));
            stale.extend(differing.map(|(path, _)| Stale { path: path.into(), command: command.clone() }));
        }
        if stale.is_empty() { Ok(outputs) } else { Err(Error::Stale(stale)) }
    }

    /// [`Config::generate`] for a build script.
    ///
    /// Cargo runs the script again when a specification or a file that it names changes, and it shows warnings. Modules
    /// below `OUT_DIR` that no specification gives any more are removed.
    ///
    /// If anything is wrong, cargo shows every fault, and each of these modules is replaced by one that does not compile
    /// and that holds the message. The process then ends with exit code 1: `build.rs` stops, and the build fails.
    ///
    /// Files outside `OUT_DIR` (see [`Config::out_dir`]) are written but never removed. The C interface of `emit.c_api` is not
    /// written: a crate has no use for it.
    pub fn run_in_build_script(&self) {
        let done = build_script::run(self, &mut stdout().lock());
        if !done {
            std::process::exit(1);
        }
    }

    /// Reads every specification, with the files that it names, once.
    fn load(&self) -> Vec<Result<Loaded, Error>> {
        self.specs.iter().map(|spec| read(spec)).collect()
    }

    fn build(&self, loaded: Vec<Result<Loaded, Error>>) -> Result<Vec<Output>, Error> {
        let made = self.make(loaded, None)?;
        made.into_iter().filter_map(|made| made.into_output().transpose()).collect()
    }

    /// Makes every module that `cache` does not hold.
    fn make(&self, loaded: Vec<Result<Loaded, Error>>, cache: Option<&Cache>) -> Result<Vec<Made>, Error> {
        let out_dir = self.folder()?;
        let mut faults = Vec::new();
        let mut all: Vec<Made> = Vec::new();
        for (spec, loaded) in self.specs.iter().zip(loaded) {
            let made = loaded.and_then(|loaded| {
                let told = self.progress.as_deref().unwrap_or(&Silent);
                let titled = Titled { title: loaded.spec.name.clone(), progress: told };
                let progress = if self.specs.len() < 2 { told } else { &titled };
                Made::new(loaded, &out_dir, &self.effort, progress, cache)
            });
            match made {
                Ok(made) => match all.iter().find(|other| other.module == made.module) {
                    Some(other) => faults.extend(same_name(spec, &made, other)),
                    None => all.push(made),
                },
                Err(Error::Input(more)) => faults.extend(more),
                Err(other) => return Err(other),
            }
        }
        if faults.is_empty() { Ok(all) } else { Err(Error::Input(faults)) }
    }

    fn folder(&self) -> Result<PathBuf, Error> {
        let unset = || {
            let help = "set it with `out_dir`, or run inside a build script, where cargo sets OUT_DIR";
            Error::input(Path::new("gramforge::Config"), "out_dir", "is not set", help)
        };
        self.out_dir.clone().or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from)).ok_or_else(unset)
    }
}

fn same_name(spec: &Path, made: &Made, other: &Made) -> Vec<crate::error::Diagnostic> {
    let mut faults = Diagnostics::of(spec);
    let first = other.spec.display();
    faults.push(
        "name",
        format!("is {:?}, which {first} also uses", made.name),
        "give each specification a different name",
    );
    match faults.into_error() {
        Error::Input(list) => list,
        _ => Vec::new(),
    }
}
