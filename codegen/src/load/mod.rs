//! From a file to a [`Spec`] of the right shape: JSON with comments, then structure against the schema.
//!
//! The stages `arm` and `check` check later what the values mean.

mod comments;
mod defaults;
mod hash;
mod json;
mod mismatch;
mod named;
mod place;
mod plain;
mod pointed;
mod reader;
mod repair;
mod schema;
mod structure;
mod wording;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;

use crate::error::{Diagnostics, Error};
use crate::spec::Spec;

#[cfg(feature = "cli")]
pub(crate) use defaults::module_name;
pub(crate) use hash::canonical;
pub use hash::spec_hash;
pub use named::Named;
pub use plain::plain;
pub(crate) use reader::text as read_text;
pub use schema::{SCHEMA, schema};

/// A specification of the right shape and the files that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The specification.
    pub spec: Spec,
    /// The file that it was read from; relative paths in it start at this file's folder.
    pub path: PathBuf,
    /// The specification and every file that it names, whether or not they can be read; a build
    /// script reruns when one of them changes.
    pub files: Vec<PathBuf>,
    /// The named files with their bytes.
    pub named: Vec<Named>,
    /// The text that the specification was read from.
    pub text: Arc<str>,
}

impl Loaded {
    /// `file`, a path relative to the specification, as a path from the working directory.
    pub fn resolve(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }
}

/// A specification as far as it can be read.
#[derive(Clone, Debug)]
pub struct Draft {
    /// What has the right shape, with stand-ins for what has not; `None` where too little has.
    pub loaded: Option<Loaded>,
    /// What has the wrong shape.
    pub faults: Diagnostics,
    /// The sections that are stand-ins or left out, such as `control`.
    pub lost: BTreeSet<String>,
    /// The text that was read.
    pub text: Arc<str>,
}

/// Reads the specification file at `path`.
///
/// # Errors
/// [`Error::Input`] where the file cannot be read, and those of [`parse`].
pub fn load(path: &Path) -> Result<Loaded, Error> {
    parse(&text(path)?, path)
}

/// Reads the specification file at `path` as far as possible.
///
/// # Errors
/// [`Error::Input`] where the file cannot be read.
pub fn draft(path: &Path) -> Result<Draft, Error> {
    drafted(&text(path)?, path)
}

fn text(path: &Path) -> Result<String, Error> {
    read_text(path).map_err(|error| {
        Error::input(
            path,
            "",
            format!("cannot be read ({error})"),
            "give the path of a specification file, UTF-8 encoded JSON",
        )
    })
}

/// Reads a specification from `text`, and the files that it names; `path` is the file that messages name and that
/// relative paths start from. A named file that cannot be read is reported where it is used.
///
/// # Errors
/// [`Error::Input`] with line and column where the text is not JSON, else with every field that is missing,
/// unknown, repeated, of the wrong type or a text with hidden characters (see [`plain()`]).
pub fn parse(text: &str, path: &Path) -> Result<Loaded, Error> {
    let Draft { loaded, faults, text, .. } = drafted(text, path)?;
    let error = match loaded {
        Some(loaded) if faults.is_empty() => return Ok(loaded),
        _ => faults.into_error(),
    };
    Err(error.pointing_into(path, &text))
}

/// The same, as far as it goes.
fn drafted(text: &str, path: &Path) -> Result<Draft, Error> {
    let mut faults = Diagnostics::of(path);
    let text: Arc<str> = Arc::from(text.trim_start_matches('\u{feff}'));
    let nothing = |faults| Draft { loaded: None, faults, lost: BTreeSet::new(), text: text.clone() };
    let Some(value) = comments::blanked(&text, &mut faults) else { return Ok(nothing(faults)) };
    let Some(mut value) = json::read(&value, &mut faults) else { return Ok(nothing(faults)) };
    let before = faults.count();
    plain::check(&value, &mut faults);
    let hidden = faults.count() > before;
    structure::check(&value, &mut faults)?;
    if hidden {
        // Names that are not what they look like are good for nothing more.
        return Ok(nothing(faults));
    }
    if faults.is_empty() {
        let loaded = Some(typed(value, path, &text)?);
        return Ok(Draft { loaded, faults, lost: BTreeSet::new(), text });
    }
    let Some(lost) = repair::repair(&mut value)? else { return Ok(nothing(faults)) };
    // What cannot be read even so has faults enough.
    Ok(Draft { loaded: typed(value, path, &text).ok(), faults, lost, text })
}

/// The specification that `value`, which has its shape, stands for.
fn typed(mut value: Value, path: &Path, text: &Arc<str>) -> Result<Loaded, Error> {
    json::narrow(&mut value);
    defaults::name(&mut value, path);
    let mut spec: Spec = serde_json::from_value(value).map_err(|error| {
        Error::input(path, "", format!("does not fit the schema ({error})"), "compare it with the schema")
    })?;
    spec.emit.leave_out_default();
    defaults::measure(&mut spec);
    let named = named::read(&spec, path);
    let files =
        [path.to_path_buf()].into_iter().chain(named.iter().map(|named| named.path.clone())).collect();
    Ok(Loaded { spec, path: path.to_path_buf(), files, named, text: text.clone() })
}

#[cfg(test)]
mod tests;
