//! One specification at several model sizes: what each costs, and what it is wrong by.

mod defaults;
mod gains;
mod kept;
mod label;
mod plan;
mod read;
mod row;
mod size;
mod sweep;

pub use defaults::default_sizes;
pub use gains::{with_gains, with_gains_of};
pub use kept::{Kept, merged};
pub use plan::{Entry, Plan, Shard};
pub use row::{Counts, Gain, Promise, Row};
pub use size::Size;
pub use sweep::sweep;

use crate::bounds::Effort;
use crate::error::Error;
use crate::load::Loaded;
use crate::pipeline::Generation;
use crate::progress::Progress;

/// Generates `loaded` at `size` and gives its figures with all that they come from.
///
/// Without `guarantee` the errors of the sampled loop along a motion are not followed, which saves seconds: see
/// [`Generation::unjudged`].
///
/// # Errors
/// [`Error::Input`] where the specification has no model or no controller of that size.
pub fn run(
    loaded: &Loaded,
    size: &Size,
    guarantee: bool,
    progress: &dyn Progress,
) -> Result<(Row, Generation), Error> {
    let (sized, effort) = (size.apply(loaded), Effort::default());
    let generation = match guarantee {
        true => Generation::with_progress(sized, &effort, progress)?,
        false => Generation::unjudged(sized, &effort, progress)?,
    };
    Ok((Row::new(size, &generation)?, generation))
}

#[cfg(test)]
mod tests;
