//! The files that a specification names, read once: what is hashed is what is used.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Loaded;
use super::reader::bytes;
use crate::spec::{MotionSpec, Spec};

/// A file that a specification names, with the bytes that it held when the specification was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// The field that names it, such as `arm.urdf`.
    pub field: &'static str,
    /// The path as the specification writes it.
    pub name: String,
    /// The path from the working directory.
    pub path: PathBuf,
    /// Its bytes, or why they could not be read.
    pub content: Result<Arc<[u8]>, String>,
}

impl Named {
    /// The content as text.
    ///
    /// # Errors
    /// Why the file could not be read, or that it is not UTF-8.
    pub fn text(&self) -> Result<&str, String> {
        let bytes = self.content.as_ref().map_err(String::clone)?;
        std::str::from_utf8(bytes).map_err(|error| format!("it is not UTF-8 text: {error}"))
    }
}

impl Loaded {
    /// The file that `field` names as `name`; one that was not read with the specification has no content.
    pub fn named(&self, field: &'static str, name: &str) -> Named {
        let known = self.named.iter().find(|named| named.field == field && named.name == name);
        known.cloned().unwrap_or_else(|| Named {
            field,
            name: name.to_string(),
            path: self.resolve(name),
            content: Err("the specification named another file when it was read".to_string()),
        })
    }
}

#[cfg(feature = "cli")]
impl Named {
    /// The file at `path` by itself, as a message names it.
    pub(crate) fn alone(field: &'static str, path: &Path) -> Self {
        let content = bytes(path).map(Arc::from).map_err(|error| error.to_string());
        Self { field, name: path.display().to_string(), path: path.to_path_buf(), content }
    }
}

/// Reads every file that `spec`, itself in the file `path`, names.
pub(super) fn read(spec: &Spec, path: &Path) -> Vec<Named> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = |(field, name): (&'static str, &str)| {
        let path = folder.join(name);
        let content = bytes(&path).map(Arc::from).map_err(|error| error.to_string());
        Named { field, name: name.to_string(), path, content }
    };
    fields(spec).into_iter().map(read).collect()
}

/// The names of files in `spec`, each with its field.
fn fields(spec: &Spec) -> Vec<(&'static str, &str)> {
    let mut out = Vec::new();
    if let Some(file) = &spec.arm.urdf {
        out.push(("arm.urdf", file.as_str()));
    }
    if let Some(MotionSpec::Csv { file }) = &spec.motion {
        out.push(("motion.csv.file", file.as_str()));
    }
    out
}
