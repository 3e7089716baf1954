//! All stages in order: from a specification to a model, its bounds, its controller and its code.

mod angles;
mod certified;
mod designed;
mod expanded;
mod generation;
mod modelled;
mod proved;
mod sampled;
mod setting;
mod step_rounding;
mod threads;
mod verdict;

pub use generation::Generation;
pub(crate) use proved::keep;

use certified::Certified;
use designed::Designed;
use expanded::Expanded;
use modelled::Modelled;
use sampled::Sampled;

use crate::bounds::Effort;
use crate::cache::Cache;
use crate::check::{Checked, Extent, checked};
use crate::error::Error;
use crate::load::Loaded;
use crate::progress::{Progress, Silent};

/// What the stages are told besides the specification.
#[derive(Clone, Copy)]
struct Means<'a> {
    /// Work for each bound.
    effort: &'a Effort,
    /// Who hears of it.
    progress: &'a dyn Progress,
    /// What earlier runs have proved; `None` to prove all anew.
    cache: Option<&'a Cache>,
}

/// Which model is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// The one that the specification asks for.
    Asked,
    /// The exact one, since a step with the cheapest reduced one saves too little.
    Exact,
}

/// Runs every stage on `loaded`.
///
/// # Errors
/// [`Error::Input`] with all faults of the specification and the files that it names.
fn run(loaded: Loaded, extent: Extent, means: Means) -> Result<Generation, Error> {
    threads::check()?;
    let checked = checked(loaded.clone(), extent).map_err(|error| expanded::with_count(error, &loaded))?;
    let mut designed = Designed::new(certified(checked, Wanted::Asked, means)?, means)?;
    // The same stages once more; each is reported once.
    let quiet = Means { progress: &Silent, ..means };
    let exact = |designed: &Designed| {
        let checked = designed.certified.checked.clone();
        Designed::new(certified(checked, Wanted::Exact, quiet)?, quiet)
    };
    let mut twin = None;
    if designed.needs_twin() {
        // Where no exact controller can be had, there is no step to compare with.
        twin = exact(&designed).ok();
        designed.exact_step = twin.as_ref().and_then(|twin| twin.step.clone());
    }
    if let Some(saving) = designed.too_small() {
        let twin = twin.map_or_else(|| exact(&designed), Ok)?;
        designed = Designed { not_worth: Some(saving), ..twin };
    }
    Ok(Generation::concluded(designed, means))
}

/// The stages before the controller.
fn certified(checked: Checked, wanted: Wanted, means: Means) -> Result<Certified, Error> {
    proved::kept_or(checked, wanted, means, |checked| {
        let expanded = Expanded::new(checked, means)?;
        let sampled = Sampled::new(expanded, means)?;
        let modelled = Modelled::new(sampled, wanted, means)?;
        Certified::new(modelled, means)
    })
}
