//! The modules of all sizes, line by line: most lines of two sizes are the same.

use std::collections::BTreeMap;

use serde::Serialize;

use super::study::Study;

/// Bytes of all modules together, equal lines counted once, that a page holds.
const MOST: usize = 1_000_000;

/// Every different line once, and the modules as lists of them.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Modules {
    /// The lines.
    pub lines: Vec<String>,
    /// By size the numbers of its lines; `None` for a module that is too long for the page.
    pub modules: Vec<Option<Vec<usize>>>,
}

impl Modules {
    /// Of all sizes, in order, as far as there is room.
    pub(super) fn new(studies: &[Study]) -> Self {
        let mut out = Self::default();
        let (mut known, mut bytes) = (BTreeMap::new(), 0);
        for study in studies {
            let fresh = |line: &&str| !known.contains_key(*line);
            let more: usize = study.module.lines().filter(fresh).map(|line| line.len() + 8).sum();
            if bytes + more > MOST {
                out.modules.push(None);
                continue;
            }
            bytes += more;
            let mut number = |line: &'_ str| {
                *known.entry(line.to_string()).or_insert_with(|| {
                    out.lines.push(line.to_string());
                    out.lines.len() - 1
                })
            };
            let module = study.module.lines().map(&mut number).collect();
            out.modules.push(Some(module));
        }
        out
    }
}
