//! What a build script has made before: modules, and the stages behind them that gains do not change.
//!
//! An entry is found by a key of everything that it follows from: the program that runs (generator, dependencies, compiler
//! and settings are in its bytes), the work for each bound, the specification and the bytes of the files that it names. It
//! carries a hash of its own bytes. Where anything differs, it is made anew.

mod fingerprint;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::load::{Loaded, canonical, read_text};
use crate::output::write_all;

/// Name of the cache's folder.
const FOLDER: &str = "gramforge-cache";

/// The entries that this process has read or written: a build script may run several configurations one after the other.
static USED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Entries of one program in one folder.
#[derive(Debug)]
pub struct Cache {
    folder: PathBuf,
    /// Stands for the program that runs.
    program: String,
}

impl Cache {
    /// The cache below `folder`; `None` where the program that runs cannot be told from others.
    pub fn below(folder: &Path) -> Option<Self> {
        let program = fingerprint::of_program()?;
        Some(Self { folder: folder.join(FOLDER), program })
    }

    /// The key of what follows from `spec`, the files that `loaded` names and `more`; `None` where a file is missing.
    ///
    /// The path of the specification counts: warnings name it.
    pub fn key(&self, loaded: &Loaded, spec: &Value, more: &str) -> Option<String> {
        let mut hasher = Sha256::new();
        let mut part = |bytes: &[u8]| {
            hasher.update((bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        };
        part(self.program.as_bytes());
        part(more.as_bytes());
        part(loaded.path.as_os_str().as_encoded_bytes());
        part(canonical(spec).as_bytes());
        for named in &loaded.named {
            part(named.name.as_bytes());
            part(named.content.as_ref().ok()?);
        }
        Some(hex(&hasher.finalize()))
    }

    /// The entry of `kind` under `key`, whole.
    pub fn get<T: DeserializeOwned>(&self, kind: &str, key: &str) -> Option<T> {
        let path = self.path(kind, key);
        let text = read_text(&path).ok()?;
        let (hash, body) = text.split_once('\n')?;
        if hash != hex(&Sha256::digest(body.as_bytes())) {
            return None;
        }
        let value = serde_json::from_str(body).ok()?;
        mark(path);
        Some(value)
    }

    /// Keeps `value` under `key`. What cannot be kept is made anew the next time.
    pub fn put(&self, kind: &str, key: &str, value: &impl Serialize) {
        let Ok(body) = serde_json::to_string(value) else { return };
        let path = self.path(kind, key);
        let text = format!("{}\n{body}", hex(&Sha256::digest(body.as_bytes())));
        if write_all(&[(&path, &text)]).is_ok() {
            mark(path);
        }
    }

    /// Lets the entry of `kind` under `key` stay, where there is one.
    pub fn keep(&self, kind: &str, key: &str) {
        mark(self.path(kind, key));
    }

    /// Removes every entry that this process has not used.
    pub fn sweep(&self) {
        let Ok(used) = USED.lock() else { return };
        for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            if !used.contains(&entry.path()) {
                // One that stays is only room lost.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    fn path(&self, kind: &str, key: &str) -> PathBuf {
        self.folder.join(format!("{kind}-{key}.json"))
    }
}

fn mark(path: PathBuf) {
    if let Ok(mut used) = USED.lock() {
        used.insert(path);
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
