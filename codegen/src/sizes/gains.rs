//! The same gains at every size: sizes are compared, not designs.

use crate::bounds::Effort;
use crate::error::Error;
use crate::load::Loaded;
use crate::pipeline::Generation;
use crate::progress::Progress;
use crate::spec::{MatrixSpec, VectorSpec};

/// The specification of `generation` with its gains in place of `control.design`.
pub fn with_gains_of(generation: &Generation) -> Loaded {
    let mut loaded = generation.loaded().clone();
    if let (Some(control), Some(design)) = (&mut loaded.spec.control, generation.design())
        && control.design.take().is_some()
    {
        control.period = Some(design.period);
        control.w = Some(MatrixSpec::of(&design.w));
        control.pqq = Some(MatrixSpec::of(&design.gains.pqq));
        control.omega = Some(MatrixSpec::of(&design.omega));
        control.boundary_layer = design.boundary_layer.clone().map(VectorSpec::List);
    }
    loaded
}

/// `loaded` with the gains that its `control.design` asks for, found for the model that it asks for; the same where it gives
/// its gains.
///
/// # Errors
/// [`Error::Input`] where there are no such gains.
pub fn with_gains(loaded: &Loaded, progress: &dyn Progress) -> Result<Loaded, Error> {
    match &loaded.spec.control {
        Some(control) if control.design.is_some() => {
            let generation = Generation::with_progress(loaded.clone(), &Effort::default(), progress)?;
            Ok(with_gains_of(&generation))
        }
        _ => Ok(loaded.clone()),
    }
}
