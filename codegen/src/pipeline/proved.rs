//! What gains do not change is kept from one run of a build script to the next.

use serde_json::{Value, json};

use super::{Means, Wanted};
use super::certified::Certified;
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
fn key(
    cache: &Cache,
    loaded: &Loaded,
    wanted: Wanted,
    controlled: bool,
    effort: &Effort,
) -> Option<String> {
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
