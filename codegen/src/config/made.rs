//! A module, made or taken from an earlier run.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Output, OutputFile};
use crate::bounds::Effort;
use crate::cache::Cache;
use crate::emit::CFile;
use crate::error::Error;
use crate::load::Loaded;
use crate::output::Wanted;
use crate::pipeline::{Generation, keep};
use crate::progress::Progress;

/// The kind of these entries of the cache.
const KIND: &str = "module";

/// The module of one specification.
#[derive(Clone, Debug)]
pub(super) struct Made {
    /// The specification's file.
    pub spec: PathBuf,
    /// Its name.
    pub name: String,
    /// The file that the module goes to.
    pub module: PathBuf,
    /// The module, and what is odd about the specification without being wrong.
    pub text: Text,
    /// What it was made from; `None` where it was taken from an earlier run.
    generation: Option<Generation>,
}

/// What is kept of a module.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Text {
    pub module: String,
    pub warnings: Vec<String>,
}

impl Made {
    /// The module that `loaded` gives in the folder `out_dir`.
    ///
    /// # Errors
    /// As [`Generation::from_file`].
    pub fn new(
        loaded: Loaded,
        out_dir: &Path,
        effort: &Effort,
        progress: &dyn Progress,
        cache: Option<&Cache>,
    ) -> Result<Self, Error> {
        let (spec, name) = (loaded.path.clone(), loaded.spec.name.clone());
        let module = out_dir.join(format!("{name}.rs"));
        let cache = cache.and_then(|cache| Some((cache, key(cache, &loaded, effort)?)));
        if let Some((cache, key)) = &cache
            && let Some(text) = cache.get(KIND, key)
        {
            keep(cache, &loaded, effort);
            return Ok(Self { spec, name, module, text, generation: None });
        }
        let generation = Generation::cached(loaded, effort, progress, cache.as_ref().map(|kept| kept.0))?;
        let text = Text { module: generation.module()?, warnings: generation.warnings().to_vec() };
        if let Some((cache, key)) = cache {
            cache.put(KIND, &key, &text);
        }
        Ok(Self { spec, name, module, text, generation: Some(generation) })
    }

    /// What is to be written.
    pub fn wanted(&self) -> Wanted<'_> {
        (&self.module, &self.text.module)
    }

    /// The same for users, with the C interface; `None` where it was taken from an earlier run.
    ///
    /// # Errors
    /// As [`Generation::module`].
    pub fn into_output(self) -> Result<Option<Output>, Error> {
        let Some(generation) = self.generation else { return Ok(None) };
        let folder = self.module.parent().unwrap_or(Path::new("")).to_path_buf();
        let beside =
            |file: CFile| OutputFile { path: folder.join(file.path), text: file.text, written: false };
        let c_files = generation.c_files()?.into_iter().map(beside).collect();
        Ok(Some(Output { path: self.module, text: self.text.module, written: false, c_files, generation }))
    }
}

/// The key of everything that a module follows from.
fn key(cache: &Cache, loaded: &Loaded, effort: &Effort) -> Option<String> {
    let spec = serde_json::to_value(&loaded.spec).ok()?;
    cache.key(loaded, &spec, &format!("{KIND} {effort:?}"))
}
