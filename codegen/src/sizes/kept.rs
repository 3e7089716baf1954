//! The file of a sweep: one line that says of which, then a line a row. What is there of it counts, wherever it ends.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Entry, Plan};
use crate::error::{Diagnostics, Error};
use crate::load::read_text;
use crate::text::escaped_json;

/// The first line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    /// Version of the generator.
    gramforge: String,
    /// [`Plan::fingerprint`].
    sweep: String,
    /// Rows of the whole sweep.
    rows: usize,
    /// [`Plan::guarantee`].
    guarantee: bool,
}

/// What a file holds of a sweep, or what is to be written of it.
///
/// Holds: every row has a number below that of the whole sweep, and no number occurs twice.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    head: Head,
    /// Rows by their number.
    pub entries: BTreeMap<usize, Entry>,
}

impl Kept {
    /// Nothing yet of `plan`.
    ///
    /// # Errors
    /// As [`Plan::fingerprint`].
    pub fn new(plan: &Plan) -> Result<Self, Error> {
        let head = Head {
            gramforge: env!("CARGO_PKG_VERSION").to_string(),
            sweep: plan.fingerprint()?,
            rows: plan.tasks.len(),
            guarantee: plan.guarantee,
        };
        Ok(Self { head, entries: BTreeMap::new() })
    }

    /// What the file at `path` holds. A last line that is cut short does not count.
    ///
    /// # Errors
    /// [`Error::Input`] where it cannot be read or is no file of a sweep.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let help = "give a file that `gramforge sweep --out` has written";
        let text = read_text(path)
            .map_err(|error| Error::input(path, "", format!("cannot be read ({error})"), help))?;
        let mut faults = Diagnostics::of(path);
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = (1..).zip(whole.lines());
        let head = lines.next().and_then(|(_, line)| serde_json::from_str::<Head>(line).ok());
        let Some(head) = head else {
            faults.push_at(path, Some(1), "", "is not the first line of a sweep", help);
            return Err(faults.into_error());
        };
        let mut entries = BTreeMap::new();
        for (number, line) in lines {
            let mut fault = |problem: String| faults.push_at(path, Some(number), "", problem, help);
            match serde_json::from_str::<Entry>(line) {
                Err(error) => fault(format!("is no row of a sweep ({error})")),
                Ok(entry) if entry.index >= head.rows => {
                    fault(format!("is row {} of a sweep of {}", entry.index, head.rows));
                }
                Ok(entry) => {
                    if let Some(other) = entries.insert(entry.index, entry) {
                        fault(format!("is row {} for the second time", other.index));
                    }
                }
            }
        }
        faults.finish(Self { head, entries })
    }

    /// Takes the rows `wanted` over from the file at `path`, where that is of the same sweep; they are kept up to the first one that
    /// is missing, since rows are written in order.
    pub fn keep_from(&mut self, path: &Path, wanted: &[usize]) {
        let Ok(mut before) = Self::read(path) else { return };
        if self.is_of(&before) {
            let known = wanted.iter().map_while(|index| before.entries.remove_entry(index));
            self.entries.extend(known);
        }
    }

    /// Whether what is promised of the sampled loop is part of the rows.
    pub fn has_guarantee(&self) -> bool {
        self.head.guarantee
    }

    /// Whether both are of the same sweep.
    pub fn is_of(&self, other: &Self) -> bool {
        self.head == other.head
    }

    /// Numbers of the rows that are missing.
    pub fn missing(&self) -> Vec<usize> {
        (0..self.head.rows).filter(|index| !self.entries.contains_key(index)).collect()
    }

    /// The text of the file.
    ///
    /// # Errors
    /// [`Error::Internal`] for defects.
    pub fn text(&self) -> Result<String, Error> {
        let mut text = line(&self.head)?;
        for entry in self.entries.values() {
            text += &line(entry)?;
        }
        Ok(text)
    }
}

/// `value` as a line of the file, with its line feed.
///
/// # Errors
/// [`Error::Internal`] for defects.
pub(super) fn line(value: &impl Serialize) -> Result<String, Error> {
    let text = serde_json::to_string(value).map_err(|error| Error::Internal(error.to_string()))?;
    Ok(escaped_json(&text) + "\n")
}

impl Entry {
    /// The line of the file.
    ///
    /// # Errors
    /// [`Error::Internal`] for defects.
    pub fn line(&self) -> Result<String, Error> {
        line(self)
    }
}

/// All rows of the files at `paths` together; with `partial` some may be missing.
///
/// # Errors
/// [`Error::Input`] where a file is of another sweep than the first one, rows differ between files, or rows are missing.
pub fn merged<P: AsRef<Path>>(paths: &[P], partial: bool) -> Result<Kept, Error> {
    let mut faults = Diagnostics::of(Path::new(""));
    let mut all: Option<Kept> = None;
    for path in paths {
        let path = path.as_ref();
        let kept = match Kept::read(path) {
            Ok(kept) => kept,
            Err(Error::Input(more)) => {
                faults.extend(more);
                continue;
            }
            Err(other) => return Err(other),
        };
        let Some(all) = &mut all else {
            all = Some(kept);
            continue;
        };
        if !all.is_of(&kept) {
            let help =
                "merge files that the same version wrote for the same specifications, sizes and options";
            faults.push_in(path, "", "is of another sweep than the first file", help);
            continue;
        }
        for (index, entry) in kept.entries {
            if all.entries.get(&index).is_some_and(|known| *known != entry) {
                faults.push_in(
                    path,
                    format!("row {index}"),
                    "differs from that of another file",
                    "run it again",
                );
            }
            all.entries.insert(index, entry);
        }
    }
    let Some(all) = all else { return Err(faults.into_error()) };
    let missing = all.missing();
    if let (Some(first), false, Some(path)) = (missing.first(), partial, paths.first()) {
        let problem = format!("lacks {} of {} rows, the first is row {first}", missing.len(), all.head.rows);
        let help = "add the files of the other shards, run those that did not end again, or take what is there with `--partial`";
        faults.push_in(path.as_ref(), "", problem, help);
    }
    faults.finish(all)
}
