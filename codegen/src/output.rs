//! The only place that writes files.

use std::fs;
use std::path::Path;

use crate::error::Error;

/// Writes `text` to `path` if the file says something else, creating folders on the way; true if it wrote.
///
/// A temporary file beside the target takes its place at the end, so that no reader sees half a file.
///
/// # Errors
/// [`Error::Input`] naming the path where it cannot be written.
pub fn write_if_changed(path: &Path, text: &str) -> Result<bool, Error> {
    if is_current(path, text) {
        return Ok(false);
    }
    let unwritable = |error: std::io::Error| {
        Error::input(path, "", format!("cannot be written ({error})"), "name a folder that can be written to")
    };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(unwritable)?;
    }
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    let written = fs::write(&partial, text).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // Nothing to be done if even this fails: the first error is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    written.map(|()| true).map_err(unwritable)
}

/// Whether the file at `path` says `text`, line endings aside.
pub fn is_current(path: &Path, text: &str) -> bool {
    fs::read_to_string(path).is_ok_and(|found| found == text || found.replace("\r\n", "\n") == text)
}
