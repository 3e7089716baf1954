//! The modules that build scripts have written below `OUT_DIR`, old ones too.
//!
//! Cargo keeps `OUT_DIR` from one run to the next. A list there says what was written, so that no module outlives its
//! specification and none is taken for current after a failure.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::made::Made;
use crate::emit::spoilt;
use crate::error::Error;
use crate::load::read_text;
use crate::output::{Wanted, write_all};

/// Name of the list: a JSON array of paths relative to its folder.
const LIST: &str = "gramforge-modules.json";

/// What this process has written already: a build script may run several configurations one after the other.
static WRITTEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The modules in one folder.
#[derive(Debug)]
pub(super) struct Modules {
    folder: PathBuf,
    /// `OUT_DIR`, where the folder lies in it; what lies elsewhere is the user's own, and never removed.
    kept: Option<PathBuf>,
    /// What the list names.
    old: BTreeSet<PathBuf>,
}

impl Modules {
    /// The modules in `folder`.
    pub fn in_folder(folder: &Path) -> Self {
        let kept =
            std::env::var_os("OUT_DIR").map(PathBuf::from).filter(|out_dir| folder.starts_with(out_dir));
        let old = kept.as_deref().map(listed).unwrap_or_default();
        Self { folder: folder.to_path_buf(), kept, old }
    }

    /// `OUT_DIR`, where the folder lies in it.
    pub fn kept(&self) -> Option<&Path> {
        self.kept.as_deref()
    }

    /// Writes the modules of `made`, and removes what no specification gives any more.
    ///
    /// # Errors
    /// As [`write_all`].
    pub fn publish(&self, made: &[Made]) -> Result<(), Error> {
        let modules: Vec<Wanted> = made.iter().map(Made::wanted).collect();
        let Some(out_dir) = &self.kept else { return write_all(&modules).map(drop) };
        let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        written.extend(made.iter().filter_map(|made| relative(out_dir, &made.module)));
        // Listed before they are there and until they are gone: an interruption must not let one be forgotten.
        let list = out_dir.join(LIST);
        let all = text(self.old.union(&written));
        let files: Vec<Wanted> = [(list.as_path(), all.as_str())].into_iter().chain(modules).collect();
        write_all(&files)?;
        for old in self.old.difference(&written) {
            let path = out_dir.join(old);
            if path.is_file() {
                let told =
                    |error| Error::input(&path, "", format!("cannot be removed ({error})"), "remove it");
                fs::remove_file(&path).map_err(told)?;
            }
        }
        write_all(&[(&list, &text(&*written))]).map(drop)
    }

    /// Replaces every module, listed or named in `names`, by one that does not compile and says `problem`.
    pub fn spoil(&self, names: &[String], problem: &str) {
        let Some(out_dir) = &self.kept else { return };
        let written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        let named = names.iter().map(|name| self.folder.join(format!("{name}.rs")));
        let mut all: BTreeSet<PathBuf> = named.filter_map(|path| relative(out_dir, &path)).collect();
        all.extend(self.old.union(&written).cloned());
        let text = spoilt(problem);
        for module in all {
            let path = out_dir.join(module);
            if write_all(&[(&path, &text)]).is_err() {
                // Better none than the old one; the fault that led here is the one to tell.
                let _ = fs::remove_file(&path);
            }
        }
    }
}

/// The list's paths that lie in `out_dir`; nothing where there is no list.
fn listed(out_dir: &Path) -> BTreeSet<PathBuf> {
    let text = read_text(&out_dir.join(LIST)).unwrap_or_default();
    let paths: Vec<PathBuf> = serde_json::from_str(&text).unwrap_or_default();
    let inside = |path: &PathBuf| {
        path.components().all(|part| matches!(part, Component::Normal(_)))
            && path.extension().is_some_and(|end| end == "rs")
    };
    paths.into_iter().filter(inside).collect()
}

/// `path` as the list names it, if it can.
fn relative(out_dir: &Path, path: &Path) -> Option<PathBuf> {
    path.strip_prefix(out_dir).ok().filter(|path| path.to_str().is_some()).map(Path::to_path_buf)
}

fn text<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> String {
    let paths: Vec<&str> = paths.into_iter().filter_map(|path| path.to_str()).collect();
    serde_json::json!(paths).to_string() + "\n"
}
