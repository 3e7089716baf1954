//! What gains do not change is kept from one run of a build script to the next.

use serde_json::{Value, json};

use super::certified::Certified;
use super::{Means, Wanted};
use crate::bounds::Effort;
use crate::cache::Cache;
use crate::check::Checked;
use crate::error::Error;
use crate::load::Loaded;

/// The kind of these entries.
const KIND: &str = "model";

/// What the cache holds of `checked`, or else what `prove` gives, which is kept.
pub(super) fn kept_or(
    checked: Checked,
    wanted: Wanted,
    means: Means,
    prove: impl FnOnce(Checked) -> Result<Certified, Error>,
) -> Result<Certified, Error> {
    let Some((cache, key)) = means.cache.and_then(|cache| {
        let controlled = checked.control.is_some();
        Some((cache, key(cache, &checked.loaded, wanted, controlled, means.effort)?))
    }) else {
        return prove(checked);
    };
    if let Some(proved) = cache.get(KIND, &key) {
        return Ok(Certified::restored(checked, proved));
    }
    let certified = prove(checked)?;
    cache.put(KIND, &key, &certified.proved);
    Ok(certified)
}

/// Lets the entry behind the whole module of `loaded` stay, though nobody reads it: the gains may change next.
pub(crate) fn keep(cache: &Cache, loaded: &Loaded, effort: &Effort) {
    for wanted in [Wanted::Asked, Wanted::Exact] {
        if let Some(key) = key(cache, loaded, wanted, loaded.spec.control.is_some(), effort) {
            cache.keep(KIND, &key);
        }
    }
}

/// The key of everything that the model and its bounds follow from. Of the controller that is whether there is one, which
/// law it is, what is uncertain, and what is learnt.
fn key(cache: &Cache, loaded: &Loaded, wanted: Wanted, controlled: bool, effort: &Effort) -> Option<String> {
    let mut spec = serde_json::to_value(&loaded.spec).ok()?;
    let fields = spec.as_object_mut()?;
    fields.remove("simulation");
    if let Some(control) = fields.get("control").filter(|control| !control.is_null()) {
        let part = |name: &str| control.get(name).cloned().unwrap_or(Value::Null);
        let learns = control.get("adaptation").and_then(|adaptation| adaptation.get("parameters")).cloned();
        let kept = json!({ "law": part("law"), "uncertainty": part("uncertainty"), "learns": learns });
        fields.insert("control".to_string(), kept);
    }
    cache.key(loaded, &spec, &format!("{KIND} {wanted:?} {controlled} {effort:?}"))
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};
    use std::sync::Mutex;

    use serde_json::{Value, json};

    use crate::bounds::Effort;
    use crate::cache::Cache;
    use crate::load::parse;
    use crate::pipeline::Generation;
    use crate::progress::Progress;

    /// A folder of its own for each case, removed when it goes out of scope.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("gramforge-proved-{}-{name}", std::process::id()));
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    /// Keeps the names of the stages that ran.
    #[derive(Debug, Default)]
    struct Stages(Mutex<Vec<String>>);

    impl Progress for Stages {
        fn report(&self, stage: &str, _done: usize, _total: usize) {
            self.0.lock().unwrap().push(stage.to_string());
        }
    }

    /// The generation of `spec`, and whether its model was made anew.
    fn made(spec: &Value, cache: Option<&Cache>) -> (Generation, bool) {
        let loaded = parse(&spec.to_string(), Path::new("arm.json")).unwrap();
        let stages = Stages::default();
        let effort = Effort::default().boxes(300);
        let generation = Generation::cached(loaded, &effort, &stages, cache).unwrap();
        let anew = stages.0.lock().unwrap().iter().any(|stage| stage == "reduction");
        (generation, anew)
    }

    /// Runs a specification with other gains first, then `spec` on the stages that this run has kept.
    fn restored(name: &str, spec: &Value) -> Generation {
        let folder = Folder::new(name);
        let cache = Cache::below(&folder.0).expect("the program can be read");
        let mut other = spec.clone();
        other["control"]["W"] = json!(1.25 * spec["control"]["W"].as_f64().unwrap());
        let (other, anew) = made(&other, Some(&cache));
        assert!(anew, "{name}: the cache was empty");
        let (restored, anew) = made(spec, Some(&cache));
        assert!(!anew, "{name}: the model was made twice");
        let (fresh, _) = made(spec, None);
        assert_eq!(restored.module().unwrap(), fresh.module().unwrap(), "{name}");
        assert_eq!(restored.warnings(), fresh.warnings(), "{name}");
        assert_ne!(restored.module().unwrap(), other.module().unwrap(), "{name}: the gains count");
        restored
    }

    fn file(path: &str) -> Value {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    #[test]
    fn restored_stages_give_the_module_of_an_adaptive_law() {
        let restored = restored("adaptive", &file("generated/specs/arm3_adaptive.json"));
        assert!(restored.module().unwrap().contains("AdaptiveLaw"));
    }

    #[test]
    fn restored_stages_give_the_module_of_a_sparse_model() {
        let mut spec = file("tests/data/puma3_tolerance.json");
        spec["control"] = json!({
            "law": "tight", "period": 0.001, "W": 40.0, "Pqq": 10.0, "Omega": 40.0, "boundary_layer": 0.1,
            "allow_long_period": true, "initial_error": { "position": 0.01 }
        });
        assert!(restored("sparse", &spec).reduced().sparse().is_some());
    }

    #[test]
    fn restored_stages_give_the_module_of_a_table_of_sines() {
        let restored = restored("table", &file("tests/data/arm3_table.json"));
        assert!(restored.module().unwrap().contains("Table"));
    }
}
