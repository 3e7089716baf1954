//! All stages in order: from a specification to a model, its bounds, its controller and its code.

mod angles;
mod certified;
mod designed;
mod expanded;
mod generation;
mod judged;
#[cfg(feature = "cli")]
mod limits;
mod modelled;
mod proved;
mod replaced;
mod requested;
mod sampled;
mod setting;
mod step_rounding;
mod threads;
mod verdict;
mod written;

#[cfg(feature = "cli")]
pub(crate) use expanded::candidates;
pub use generation::Generation;
#[cfg(feature = "cli")]
pub(crate) use limits::Limits;
pub(crate) use proved::keep;

use certified::Certified;
use designed::Designed;
use expanded::Expanded;
use modelled::Modelled;
use replaced::Replaced;
use sampled::Sampled;

use crate::bounds::Effort;
use crate::cache::Cache;
use crate::check::{Checked, Extent, checked};
use crate::error::{Error, problems};
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
    /// Whether the errors of the sampled loop are followed, which takes seconds.
    judges: bool,
}

/// Which model is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// The one that the specification asks for.
    Asked,
    /// The exact one, to compare with or to replace the one that was asked for.
    Exact,
}

/// Runs every stage on `loaded`.
///
/// # Errors
/// [`Error::Input`] with all faults of the specification and the files that it names.
fn run(loaded: Loaded, extent: Extent, means: Means) -> Result<Generation, Error> {
    threads::check()?;
    let means = Means { judges: extent != Extent::Unjudged, ..means };
    let made = || {
        let checked =
            checked(loaded.clone(), extent).map_err(|error| expanded::with_count(error, &loaded))?;
        chosen(checked, means)
    };
    let designed = made().map_err(|error| error.pointing_into_files(&loaded))?;
    Ok(Generation::concluded(designed, means))
}

/// The controller about the model that the specification asks for, or about the exact one where that leaves the choice
/// open and the reduced model is refused or saves too little.
///
/// # Errors
/// Where the controller is refused; with the choice open that is what the exact model breaks: it asks least of the rest.
fn chosen(checked: Checked, means: Means) -> Result<Designed, Error> {
    // The same stages once more; each is reported once.
    let quiet = Means { progress: &Silent, ..means };
    let exact = |checked: &Checked| Designed::new(certified(checked.clone(), Wanted::Exact, quiet)?, quiet);
    let asked = certified(checked, Wanted::Asked, means)?;
    let (checked, open) = (asked.checked.clone(), asked.is_chosen_reduced());
    let mut designed = match Designed::new(asked, means) {
        Err(Error::Input(faults)) if open => {
            return Ok(Designed { replaced: Some(Replaced::Refused(problems(&faults))), ..exact(&checked)? });
        }
        designed => designed?,
    };
    let mut twin = None;
    if designed.needs_twin() {
        // Where no exact controller can be had, there is no step to compare with.
        twin = exact(&checked).ok();
        designed.exact_step = twin.as_ref().and_then(|twin| twin.step.clone());
    }
    if let Some(saving) = designed.saving().filter(|saving| open && !saving.pays()) {
        let twin = twin.map_or_else(|| exact(&checked), Ok)?;
        designed = Designed { replaced: Some(Replaced::SavesTooLittle(saving)), ..twin };
    }
    Ok(designed)
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
