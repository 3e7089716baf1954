//! Stage 2: the exact model.

use super::Means;
use crate::arm::{Arm, Built, indefinite};
use crate::check::Checked;
#[cfg(feature = "cli")]
use crate::check::{Extent, checked};
use crate::domain::Domain;
use crate::dynamics::mass_matrix;
use crate::error::{Diagnostics, Error};
use crate::lagrangian::{Lagrangian, expand_family};
use crate::load::Loaded;
use crate::motion::Motion;
use crate::progress::Stage;
use crate::reduction::Dictionary;
use crate::spec::{DictionarySpec, ModelSpec, Spec};

/// Pieces of a motion from which on the module's size is told, and what one of one joint adds to its text, bytes.
const LONG_MOTION: usize = 2_000;
const BYTES_A_PIECE: usize = 80;

/// A checked specification with its exact model.
///
/// Holds: the model has as many functions as the specification asks for; over a workspace D(q) of a controlled arm was
/// positive definite wherever it was looked at within the joints' limits.
#[derive(Clone, Debug)]
pub(super) struct Expanded {
    /// The specification.
    pub checked: Checked,
    /// What is odd about it without being wrong.
    pub warnings: Vec<String>,
    /// The exact model.
    pub lagrangian: Lagrangian,
}

impl Expanded {
    /// # Errors
    /// [`Error::Input`] where D is not positive definite or too many functions are asked for.
    pub fn new(checked: Checked, means: Means) -> Result<Self, Error> {
        let arm = &checked.built.arm;
        let mut faults = Diagnostics::of(&checked.loaded.path);
        // The domain around a motion is looked at later, where its points are known; the limits may reach far beyond it.
        if checked.control.is_some()
            && matches!(checked.domain, Domain::Workspace(_))
            && let Some(state) = indefinite(arm, |q| mass_matrix(arm, q))
        {
            state.report(arm, &mut faults);
            return Err(faults.into_error());
        }
        let mut warnings = checked.built.warnings.clone();
        warnings.extend(checked.motion.as_ref().and_then(|motion| long(&checked, motion)));
        let stage = Stage::new(means.progress, "expansion", 1);
        let lagrangian = expand_family(arm, &checked.built.uncertainty);
        drop(stage);
        check_count(&checked.loaded.spec, &lagrangian, &mut faults);
        faults.finish(Self { checked, warnings, lagrangian })
    }
}

/// `error` with the fault of a model that has fewer functions than are asked for, where the arm alone is sound: all faults
/// are told at once.
pub(super) fn with_count(error: Error, loaded: &Loaded) -> Error {
    let Error::Input(known) = error else { return error };
    let mut faults = Diagnostics::of(&loaded.path);
    faults.extend(known);
    let asks = matches!(loaded.spec.model, ModelSpec::Shared { .. } | ModelSpec::Separate { .. });
    let built = Arm::from_spec(loaded, &mut Diagnostics::of(&loaded.path)).filter(|_| asks);
    if let Some(Built { arm, uncertainty, .. }) = built {
        check_count(&loaded.spec, &expand_family(&arm, &uncertainty), &mut faults);
    }
    faults.into_error()
}

/// The number of functions among which the reduction of `loaded` chooses, and of terms of the exact model.
///
/// # Errors
/// [`Error::Input`] with all faults of the specification and the files that it names.
#[cfg(feature = "cli")]
pub(crate) fn candidates(loaded: &Loaded) -> Result<(usize, usize), Error> {
    let checked = checked(loaded.clone(), Extent::Model)?;
    let lagrangian = expand_family(&checked.built.arm, &checked.built.uncertainty);
    let functions = Dictionary::of(loaded.spec.dictionary).functions(&lagrangian).len();
    Ok((functions, lagrangian.terms()))
}

/// Faults where more functions are asked for than there are.
fn check_count(spec: &Spec, lagrangian: &Lagrangian, faults: &mut Diagnostics) {
    let p = Dictionary::of(spec.dictionary).functions(lagrangian).len();
    let (field, functions) = match spec.model {
        ModelSpec::Shared { functions } => ("model.shared.functions", functions),
        ModelSpec::Separate { functions } => ("model.separate.functions", functions),
        ModelSpec::Exact | ModelSpec::Tolerance { .. } | ModelSpec::Auto => return,
    };
    if functions > p {
        let whose = match spec.dictionary {
            DictionarySpec::Harmonic => "exact model",
            DictionarySpec::Product => "dictionary `product`",
            DictionarySpec::Union => "dictionary `union`",
        };
        let problem = format!("is {functions}, but the {whose} has {p} functions");
        faults.push(field, problem, format!("write a number from 1 to {p}, or `\"exact\"`"));
    }
}

/// What is said of a motion of many pieces: all of them stand in the module.
fn long(checked: &Checked, motion: &Motion) -> Option<String> {
    let pieces = match motion {
        Motion::Spline(spline) => spline.pieces.len(),
        Motion::Quintic { .. } | Motion::Sinusoids { .. } => 0,
    };
    (pieces > LONG_MOTION).then(|| {
        let size = pieces * motion.dof() * BYTES_A_PIECE / 1_000_000;
        format!(
            "{}: motion: has {pieces} pieces, which make the module about {size} MB long; fewer rows give a smaller one",
            checked.loaded.path.display()
        )
    })
}
