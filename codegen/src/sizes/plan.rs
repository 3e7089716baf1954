//! What a sweep consists of: specifications, each at several sizes, all numbered.

use std::fmt::Write as _;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::{Row, Size};
use crate::error::Error;
use crate::load::{Loaded, spec_hash};

/// Specifications with their sizes, in order. The same plan gives the same rows on every machine.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What is generated: number k gives row k.
    pub tasks: Vec<(Loaded, Size)>,
    /// Whether what is promised of the sampled loop is part of the rows.
    pub guarantee: bool,
}

/// One row of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its number, from 0.
    pub index: usize,
    /// Name of the specification.
    pub spec: String,
    /// Name of the size.
    pub size: String,
    /// Why there is no model or no controller of that size.
    pub refused: Option<String>,
    /// The figures; `None` where it is refused.
    pub row: Option<Row>,
}

impl Plan {
    /// Every specification at each of its sizes.
    pub fn new(specs: &[(Loaded, Vec<Size>)], guarantee: bool) -> Self {
        let each = |(loaded, sizes): &(Loaded, Vec<Size>)| {
            let pairs = sizes.iter().map(|size| (loaded.clone(), size.clone()));
            pairs.collect::<Vec<_>>()
        };
        Self { tasks: specs.iter().flat_map(each).collect(), guarantee }
    }

    /// SHA-256, in hexadecimal, of all specifications at their sizes and of the generator's version: plans with the same one
    /// have the same rows.
    ///
    /// # Errors
    /// [`Error::Input`] where a named file cannot be read.
    pub fn fingerprint(&self) -> Result<String, Error> {
        let mut hasher = Sha256::new();
        hasher.update(format!("{} {}", env!("CARGO_PKG_VERSION"), self.guarantee));
        for (loaded, size) in &self.tasks {
            hasher.update(format!("\n{} {size}", spec_hash(&size.apply(loaded))?));
        }
        let mut hex = String::with_capacity(64);
        for byte in hasher.finalize().iter() {
            // Writing to a text cannot fail.
            let _ = write!(hex, "{byte:02x}");
        }
        Ok(hex)
    }
}

/// A part of a plan: rows `part − 1`, `part − 1 + parts`, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1 to `parts`.
    pub part: usize,
    /// Number of parts.
    pub parts: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { part: 1, parts: 1 };

    /// The numbers of its rows, in order, of a plan with `count` tasks.
    pub fn rows(self, count: usize) -> impl Iterator<Item = usize> {
        (self.part - 1..count).step_by(self.parts)
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `i/n`: part i of n.
    ///
    /// # Errors
    /// What to write instead.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/').map(|(part, parts)| [part, parts].map(str::parse::<usize>));
        match numbers {
            Some([Ok(part), Ok(parts)]) if (1..=parts).contains(&part) => Ok(Self { part, parts }),
            _ => Err("write i/n with whole numbers from 1/n to n/n, such as 1/3".to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn shards_hold_every_row_once() {
        let mut rows: Vec<usize> = ["1/3", "2/3", "3/3"]
            .iter()
            .flat_map(|shard| shard.parse::<Shard>().unwrap().rows(11).collect::<Vec<_>>())
            .collect();
        rows.sort_unstable();
        assert_eq!(rows, (0..11).collect::<Vec<_>>());
        assert!(["0/3", "4/3", "1", "a/b", "1/0", "-1/2"].iter().all(|bad| bad.parse::<Shard>().is_err()));
    }
}
