//! The sizes that are tried where none are named.

use super::Size;
use crate::error::Error;
use crate::load::Loaded;
use crate::pipeline::candidates;
use crate::spec::{LawSpec, ModelSpec, TrigSpec};

/// Torque errors as fractions of each joint's peak torque.
const TOLERANCES: [f64; 4] = [0.005, 0.01, 0.02, 0.05];
/// Numbers of functions from 1 to all of them, each about the same multiple of the one before.
const COUNTS: u32 = 7;
/// Terms of the exact model beyond which one of all its functions takes minutes, and the most functions that are tried then.
const LONG: usize = 4000;
const FEW: usize = 30;

/// The sizes that show what `loaded` has to choose from, about a dozen: the exact model, tolerances where the specification can
/// have them, and numbers of functions from one to all.
///
/// # Errors
/// [`Error::Input`] with all faults of the specification and the files that it names.
pub fn default_sizes(loaded: &Loaded) -> Result<Vec<Size>, Error> {
    let (functions, terms) = candidates(loaded)?;
    let mut models = vec![ModelSpec::Exact];
    if takes_tolerance(loaded) {
        models.extend(TOLERANCES.map(|torque| ModelSpec::Tolerance { torque }));
    }
    let most = if terms > LONG { functions.min(FEW) } else { functions };
    let mut counts = counts(most);
    let own = loaded.spec.model.clone();
    if let ModelSpec::Shared { functions } = own {
        counts.push(functions);
        counts.sort_unstable();
        counts.dedup();
    }
    models.extend(counts.into_iter().map(|functions| ModelSpec::Shared { functions }));
    if !models.contains(&own) && own.tolerance() != Some(0.01) {
        models.push(own);
    }
    Ok(models.into_iter().map(Size::of).collect())
}

/// Whether the rest of the specification goes with a tolerance.
fn takes_tolerance(loaded: &Loaded) -> bool {
    let spec = &loaded.spec;
    let adaptive = spec.control.as_ref().is_some_and(|control| control.law == LawSpec::Adaptive);
    !adaptive && !matches!(spec.emit.sines(), TrigSpec::Table { .. })
}

/// Whole numbers from 1 to `most`, spread evenly by their ratio.
fn counts(most: usize) -> Vec<usize> {
    let step = |k: u32| {
        let power = f64::from(k) / f64::from(COUNTS - 1);
        // Exact powers are not needed, the same whole numbers on every machine are.
        libm::round(libm::pow(most as f64, power)) as usize
    };
    let mut counts: Vec<usize> = (0..COUNTS).map(step).filter(|&count| count >= 1).collect();
    counts.dedup();
    counts
}

#[cfg(test)]
mod tests {
    use super::counts;

    #[test]
    fn counts_reach_from_one_to_all() {
        assert_eq!(counts(141), [1, 2, 5, 12, 27, 62, 141]);
        assert_eq!(counts(3), [1, 2, 3]);
        assert_eq!(counts(1), [1]);
        assert_eq!(counts(0), [1]);
    }
}
