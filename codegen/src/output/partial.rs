//! A file on its way: written beside its target, then put in its place.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use super::leftover;

/// Attempts before giving up. Each one fails only if another process takes the very file away or holds the very name.
const ATTEMPTS: usize = 100;

/// A temporary file, removed where it does not take its target's place.
#[derive(Debug)]
pub(super) struct Partial {
    path: PathBuf,
    /// Open, because it holds the lock that tells others that somebody still works on it.
    file: Option<File>,
}

impl Partial {
    /// Writes `text` beside `target`, in the same folder, so that it can take the target's place in one step.
    ///
    /// # Errors
    /// What is wrong with the path, as a message says it.
    pub fn beside(target: &Path, text: &str) -> Result<Self, String> {
        let (folder, name) = parts(target)?;
        let failed = |error: std::io::Error| format!("cannot be written ({error})");
        fs::create_dir_all(folder).map_err(failed)?;
        Self::create(folder, name)
            .and_then(|mut partial| partial.fill(text).map(|()| partial))
            .map_err(failed)
    }

    fn create(folder: &Path, name: &str) -> std::io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let mut attempts = 0;
        loop {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(leftover::name(name, process::id(), number));
            // Neither an existing file nor what a link points to is ever opened.
            match File::options().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Self { path, file: Some(file) }),
                Err(error) if error.kind() == ErrorKind::AlreadyExists && attempts < ATTEMPTS => {
                    attempts += 1
                }
                Err(error) => return Err(error),
            }
        }
    }

    fn fill(&mut self, text: &str) -> std::io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        // Where the file system has no locks, nothing is ever taken for left behind either.
        let _ = file.lock();
        file.write_all(text.as_bytes())?;
        // A full disk may show only now, and a name must not stand before its content.
        file.sync_all()
    }

    /// Puts the file in the place of `target`, which is to say `text`.
    ///
    /// # Errors
    /// What is wrong with the path, as a message says it.
    pub fn take_place(mut self, target: &Path, text: &str) -> Result<(), String> {
        for _ in 0..ATTEMPTS {
            match fs::rename(&self.path, target) {
                Ok(()) => {
                    // Nothing is left to be removed.
                    self.path = PathBuf::new();
                    return Ok(());
                }
                // Taken for left behind before it was locked: once more.
                Err(error) if error.kind() == ErrorKind::NotFound => self = Self::beside(target, text)?,
                Err(error) => return Err(format!("cannot be written ({error})")),
            }
        }
        Err("cannot be written (other processes keep removing the temporary file)".to_string())
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            // Nothing to be done if even this fails: the first error is the one to tell.
            let _ = fs::remove_file(&self.path);
        }
        self.file = None;
    }
}

/// Removes what ended processes have left beside `target`.
pub(super) fn clean(target: &Path) {
    if let Ok((folder, name)) = parts(target) {
        leftover::clean(folder, name);
    }
}

/// Folder and name of `target`.
fn parts(target: &Path) -> Result<(&Path, &str), String> {
    let name = target.file_name().ok_or("names no file")?;
    let name = name.to_str().ok_or("cannot be written (its name is not Unicode)")?;
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Ok((folder, name))
}
