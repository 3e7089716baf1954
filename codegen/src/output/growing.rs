//! A file to which lines are added while work goes on, so that an interruption keeps what is done.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::{unwritable, write_if_changed};
use crate::error::{Diagnostics, Error};

/// An open file that grows.
#[derive(Debug)]
pub struct Growing {
    path: PathBuf,
    file: File,
}

impl Growing {
    /// Makes `path` hold `text` and keeps it open for more.
    ///
    /// # Errors
    /// As [`write_if_changed`].
    pub fn start(path: &Path, text: &str) -> Result<Self, Error> {
        write_if_changed(path, text)?;
        let file = OpenOptions::new().append(true).open(path).map_err(|error| told(path, &error))?;
        Ok(Self { path: path.to_path_buf(), file })
    }

    /// Adds `text`, which is in the file when this returns.
    ///
    /// # Errors
    /// [`Error::Input`] where the file does not take it, as on a full disk.
    pub fn add(&mut self, text: &str) -> Result<(), Error> {
        let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.flush());
        written.map_err(|error| told(&self.path, &error))
    }
}

fn told(path: &Path, error: &std::io::Error) -> Error {
    let mut faults = Diagnostics::of(path);
    unwritable(path, &format!("cannot be written ({error})"), &mut faults);
    faults.into_error()
}
