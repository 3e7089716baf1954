//! Whether the numbers of a specification make sense together with its arm.

mod c_api;
mod check_reference;
mod checked;
mod control;
mod domain;
mod gain_request;
mod motion;
mod name;
mod shape;
mod tuning;

use std::path::Path;
use std::sync::Arc;

use crate::arm::{Arm, Built, MOST_JOINTS};
use crate::error::{Diagnostic, Diagnostics, Error};
use crate::load::{Draft, Loaded, draft};
use crate::motion::Motion;
use crate::number::scientific;
use crate::spec::{DictionarySpec, LawCodeSpec, LawSpec, ModelSpec, ScalarSpec, Spec, TrigSpec};
use crate::trig::{COARSEST, FINEST};

pub use checked::{Checked, Control, GainRequest, GainSource, InitialError};
pub(crate) use name::is_module_name;
pub use tuning::Tuning;

/// How much of a specification is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All of it.
    Whole,
    /// All of it, but nothing is proved of the sampled loop: that takes seconds.
    Unjudged,
    /// All but the controller.
    Model,
}

/// Reads and checks the specification at `path`.
///
/// # Errors
/// Those of [`read`] and [`checked()`].
pub fn prepare(path: &Path) -> Result<Checked, Error> {
    checked(read(path)?, Extent::Whole)
}

/// Reads the specification at `path`; where its shape is at fault, the faults of all values that can be read are told with
/// those of the shape.
///
/// # Errors
/// [`Error::Input`] where the file cannot be read, else with every fault.
pub fn read(path: &Path) -> Result<Loaded, Error> {
    let Draft { loaded, mut faults, lost, text } = draft(path)?;
    let Some(loaded) = loaded else { return Err(faults.into_error().pointing_into(path, &text)) };
    if faults.is_empty() {
        return Ok(loaded);
    }
    let mut values = Diagnostics::of(&loaded.path);
    examine(&loaded, Extent::Whole, &mut values);
    // Do not report faults of a placeholder or of a missing section: the user did not write it.
    let gone = |section: &str| lost.contains(section);
    let together = ["dictionary", "emit.trig", "control.law"];
    let known = |fault: &&Diagnostic| {
        let section = fault.field.split(['.', '[']).next().unwrap_or_default();
        !(gone(section) || gone("model") && together.contains(&fault.field.as_str()))
    };
    faults.extend(values.list().iter().filter(known).cloned());
    Err(faults.into_error().pointing_into_files(&loaded))
}

/// Checks a specification that is read already.
///
/// # Errors
/// [`Error::Input`] with every value of the specification and its files that cannot be.
pub fn checked(loaded: Loaded, extent: Extent) -> Result<Checked, Error> {
    let mut faults = Diagnostics::of(&loaded.path);
    let (built, motion) = examine(&loaded, extent, &mut faults);
    faults.finish(()).map_err(|error| error.pointing_into_files(&loaded))?;
    let defect = |what: &str| Error::Internal(format!("{what} was lost in its check"));
    let built = built.ok_or_else(|| defect("the arm"))?;
    let spec = &loaded.spec;
    let control = spec.control.as_ref().filter(|_| extent != Extent::Model);
    let along = motion.is_some();
    let dense = |control| Control::new(control, built.arm.dof(), along).ok_or_else(|| defect("`control`"));
    let control = control.map(dense).transpose()?;
    let motion = motion.map(Arc::new);
    let domain = checked::domain(spec, &built.arm, motion.as_ref()).ok_or_else(|| defect("`measure`"))?;
    Ok(Checked { loaded, built, motion, domain, control })
}

/// Builds arm and motion of a specification and checks all values that need no dynamics.
///
/// Every fault goes to `faults`; `None` stands for an arm or a motion that is at fault, or for no motion.
fn examine(loaded: &Loaded, extent: Extent, faults: &mut Diagnostics) -> (Option<Built>, Option<Motion>) {
    let built = Arm::from_spec(loaded, faults);
    let arm = built.as_ref().map(|b| &b.arm);
    let motion = check(loaded, arm, faults);
    if let Some(control) = loaded.spec.control.as_ref().filter(|_| extent != Extent::Model) {
        let joints = joints(&loaded.spec, arm);
        control::check(control, joints, faults);
        gain_request::check(control, &loaded.spec, joints, faults);
    }
    (built, motion)
}

/// The number of joints; without an arm (because it is at fault) that of the DH table.
fn joints(spec: &Spec, arm: Option<&Arm>) -> Option<usize> {
    let table = || spec.arm.dh.as_ref().map(|table| table.links.len());
    // A table with too many links says nothing about the lengths that are meant.
    arm.map(Arm::dof).or_else(table).filter(|n| (1..=MOST_JOINTS).contains(n))
}

/// Checks every field that is neither the arm's own nor the control law's, and gives the motion.
///
/// Without an arm (because it is at fault) the number of joints is taken from the DH table, and what needs to know
/// more is passed over.
fn check(loaded: &Loaded, arm: Option<&Arm>, faults: &mut Diagnostics) -> Option<Motion> {
    let spec = &loaded.spec;
    let joints = joints(spec, arm);
    name::check(&spec.name, faults);
    match &spec.model {
        ModelSpec::Shared { functions: 0 } => {
            faults.push("model.shared.functions", "is 0", "write a whole number of at least 1");
        }
        ModelSpec::Separate { functions: 0 } => {
            faults.push("model.separate.functions", "is 0", "write a whole number of at least 1");
        }
        ModelSpec::Tolerance { torque } if !(*torque > 0.0 && *torque < 1.0) => {
            let help = "write a fraction of the peak torque above 0 and below 1, such as 0.01";
            faults.push("model.tolerance.torque", format!("is {}", scientific(*torque)), help);
        }
        ModelSpec::Shared { .. }
        | ModelSpec::Separate { .. }
        | ModelSpec::Tolerance { .. }
        | ModelSpec::Auto
        | ModelSpec::Exact => {}
    }
    let motion = spec.motion.as_ref().and_then(|motion| motion::check(motion, loaded, arm, joints, faults));
    domain::check(spec, arm, joints, faults);
    if let TrigSpec::Table { error } = spec.emit.sines()
        && !(FINEST..=COARSEST).contains(&error)
    {
        let help =
            format!("write a number from {FINEST:e} to {COARSEST}, or \"polynomial\" in place of the table");
        faults.push("emit.trig.table.error", format!("is {}", scientific(error)), help);
    }
    going_together(spec, faults);
    if spec.emit.scalar == ScalarSpec::F32 && spec.emit.law == LawCodeSpec::Runtime && spec.control.is_some()
    {
        faults.push(
            "emit.law",
            "is `runtime`, but `emit.scalar` is `f32`: what f32 rounds by is proved of the step that is written out",
            "leave it out, or write `emit.scalar` as \"f64\"",
        );
    }
    c_api::check(spec, faults);
    check_reference::check(spec, arm, faults);
    if let Some(duration) = spec.simulation.duration.filter(|v| *v <= 0.0) {
        faults.push(
            "simulation.duration",
            format!("is {}", scientific(duration)),
            "write a number above 0, in s",
        );
    }
    if spec.simulation.substeps == Some(0) {
        faults.push("simulation.substeps", "is 0", "write a whole number of at least 1");
    }
    motion
}

/// The help for a model that does not go with the rest.
const MODEL: &str = "write `model` as {\"shared\": {\"functions\": N}} or \"exact\"";
const HARMONIC: &str = "leave out `dictionary`";

/// What goes with certain models alone.
fn going_together(spec: &Spec, faults: &mut Diagnostics) {
    let chosen = spec.model.tolerance().is_some();
    let products = spec.dictionary != DictionarySpec::Harmonic && !chosen && spec.model != ModelSpec::Exact;
    let apart = matches!(spec.model, ModelSpec::Separate { .. });
    let asked = match spec.model {
        ModelSpec::Auto => "`model` is `auto`, which is the default",
        ModelSpec::Tolerance { .. } => "`model` is `tolerance`",
        ModelSpec::Exact => "`model` is `exact`",
        _ if spec.dictionary == DictionarySpec::Product => "`dictionary` is `product`",
        _ if spec.dictionary == DictionarySpec::Union => "`dictionary` is `union`",
        ModelSpec::Separate { .. } => "`model` is `separate`",
        ModelSpec::Shared { .. } => "`model` is `shared`",
    };
    if matches!(spec.emit.sines(), TrigSpec::Table { .. }) && (chosen || products) {
        let problem = format!(
            "asks for a table, which needs a `shared`, `separate` or `exact` model of the harmonic dictionary, but {asked}"
        );
        let other = if products { HARMONIC } else { MODEL };
        faults.push("emit.trig", problem, format!("write \"polynomial\" or \"libm\", or {other}"));
    }
    if spec.dictionary != DictionarySpec::Harmonic && (chosen || spec.model == ModelSpec::Exact) {
        faults.push(
            "dictionary",
            format!("applies only to `shared` and `separate` models, but {asked}"),
            "leave it out, or write `model` as {\"shared\": {\"functions\": N}}",
        );
    }
    let adaptive = spec.control.as_ref().is_some_and(|control| control.law == LawSpec::Adaptive);
    if adaptive && (chosen || products || apart) {
        let problem = format!(
            "is `adaptive`, which needs a `shared` or `exact` model of the harmonic dictionary, but {asked}"
        );
        let other = match (products, apart) {
            (true, true) => format!("{HARMONIC} and {MODEL}"),
            (true, false) => HARMONIC.to_string(),
            (false, _) => MODEL.to_string(),
        };
        faults.push("control.law", problem, format!("{other}, or take law `report` or `tight`"));
    }
}

#[cfg(test)]
mod tests;
