//! The only place that writes files.
//!
//! All files are written beside their targets before the first one takes its place, so that a failure leaves everything
//! as it was and no reader ever sees half a file. Temporary files have names of their own and are locked while the process
//! runs. If a process ends early, the next one that writes the same file removes what it has left.

#[cfg(feature = "cli")]
mod growing;
mod leftover;
mod partial;

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use crate::error::{Diagnostics, Error};
#[cfg(feature = "cli")]
pub use growing::Growing;
use partial::Partial;

/// A file to be written: its path and its text.
pub type Wanted<'a> = (&'a Path, &'a str);

/// Writes every file whose text differs and creates missing folders. Gives for each file whether it was written.
///
/// # Errors
/// [`Error::Input`] naming every path that cannot be written or is something else than a regular file. No file has been
/// changed then, unless a temporary one could be written and the file system refused to let it take its place.
pub fn write_all(files: &[Wanted<'_>]) -> Result<Vec<bool>, Error> {
    let mut faults = Diagnostics::of(Path::new(""));
    let mut partials = Vec::with_capacity(files.len());
    for &(path, text) in files {
        partial::clean(path);
        if is_current(path, text) {
            partials.push(None);
            continue;
        }
        match replaceable(path).and_then(|()| Partial::beside(path, text)) {
            Ok(partial) => partials.push(Some(partial)),
            Err(problem) => unwritable(path, &problem, &mut faults),
        }
    }
    faults.finish(())?;
    let mut faults = Diagnostics::of(Path::new(""));
    let mut written = Vec::with_capacity(files.len());
    for (&(path, text), partial) in files.iter().zip(partials) {
        written.push(partial.is_some());
        let Some(partial) = partial else { continue };
        if let Err(problem) = partial.take_place(path, text) {
            unwritable(path, &problem, &mut faults);
        }
    }
    faults.finish(written)
}

/// [`write_all`] for a single file.
///
/// # Errors
/// As [`write_all`].
pub fn write_if_changed(path: &Path, text: &str) -> Result<bool, Error> {
    write_all(&[(path, text)]).map(|written| written == [true])
}

/// Whether the file at `path` holds `text`, byte for byte. Only a regular file is opened: reading a pipe could take for
/// ever.
pub fn is_current(path: &Path, text: &str) -> bool {
    let regular = fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() == text.len() as u64);
    regular && fs::read(path).is_ok_and(|found| found == text.as_bytes())
}

/// Why `path` may not be replaced, if it may not: links, pipes, devices and folders are never removed.
fn replaceable(path: &Path) -> Result<(), String> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() => Ok(()),
        Ok(found) if found.is_dir() => Err("is a folder".to_string()),
        Ok(found) if found.is_symlink() => Err("is a symbolic link".to_string()),
        Ok(_) => Err("is not a regular file".to_string()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(format!("cannot be written ({error})")),
    }
}

fn unwritable(path: &Path, problem: &str, faults: &mut Diagnostics) {
    let help = if problem.starts_with("is ") {
        "remove it, or name another folder: only regular files are replaced"
    } else {
        "name a folder that can be written to"
    };
    faults.push_in(path, "", problem, help);
}

#[cfg(test)]
mod tests;
