//! What the step of a controller rounds by, and a law that allows for it.

use super::Means;
use super::certified::Certified;
use super::designed::{design_with, given};
use crate::bounds::{Rates, six_digits_up};
use crate::check::Control;
use crate::control::{
    Design, SingleRounding, StepGraph, StepRounding, StepStates, Surroundings, step_rounding,
};
use crate::error::{Diagnostics, Error};
use crate::motion::Ticks;
use crate::spec::ScalarSpec;

/// What is allowed for more than what the step was found to round by: with the allowance the step changes a little.
const ALLOWED: f64 = 1.25;
/// Designs until the allowance is enough.
const ROUNDS: usize = 5;

/// A controller with its step, and what that rounds by. In f32 the law allows for the rounding.
pub(super) fn rounded_design(
    certified: &Certified,
    control: &Control,
    means: Means,
    constant: bool,
) -> Result<(Design, StepGraph, StepRounding), Error> {
    let (design, step) = design_with(certified, control, means, constant, None)?;
    let rounding = of(certified, &design, &step)?;
    if certified.checked.loaded.spec.emit.scalar == ScalarSpec::F64 {
        return Ok((design, step, rounding));
    }
    // Gains that were searched for are judged again; another search is needed only where they do not stand the rounding.
    let same = given(control, &design);
    let mut found = rounding;
    for _ in 0..ROUNDS {
        let n = found.torque.len();
        let reference =
            found.reference.as_ref().map_or_else(|| [(); 3].map(|()| vec![0.0; n]), |r| r.1.clone());
        let single = SingleRounding {
            step: found.torque.iter().map(|torque| ALLOWED * torque).collect(),
            sign: ALLOWED * found.sign,
            reference,
        };
        let (design, step) = design_with(certified, &same, means, constant, Some(&single))
            .or_else(|_| design_with(certified, control, means, constant, Some(&single)))?;
        found = of(certified, &design, &step)?;
        let enough = found.sign <= single.sign
            && found.torque.iter().zip(&single.step).all(|(torque, allowed)| torque <= allowed);
        if enough && found.reference.as_ref().is_none_or(|(_, error)| *error == single.reference) {
            return Ok((design, step, found));
        }
    }
    let mut faults = Diagnostics::of(&certified.checked.loaded.path);
    let help = "write smaller gains, or \"f64\"";
    faults.push("emit.scalar", "is `f32`, and no bound on what the control step rounds by was found", help);
    Err(faults.into_error())
}

fn of(certified: &Certified, design: &Design, step: &StepGraph) -> Result<StepRounding, Error> {
    let checked = &certified.checked;
    let scalar = checked.loaded.spec.emit.scalar;
    let motion = checked.motion.as_deref();
    let known = motion.map(Rates::of).or_else(|| Rates::limits(&checked.built.arm));
    let speed = &design.envelope.speed;
    let rates = known.unwrap_or_else(|| Rates {
        speed: speed.clone(),
        reference_speed: speed.clone(),
        reference_acceleration: vec![1.0; speed.len()],
    });
    let around = Surroundings {
        domain: &checked.domain,
        envelope: &design.envelope,
        rates: &rates,
        adaptation: design.adaptation.as_ref(),
    };
    let states = StepStates::new(&around);
    let (torque, sign) = step_rounding(step, &states, &around, scalar.format());
    let torque: Vec<f64> = torque.into_iter().map(six_digits_up).collect();
    if !torque.iter().chain([&sign]).all(|bound| bound.is_finite()) {
        let mut faults = Diagnostics::of(&checked.loaded.path);
        let problem = format!("asks for torques that may overflow in {}", scalar.name());
        faults.push("control", problem, "write gains, boundary layer and initial errors in SI units");
        return Err(faults.into_error());
    }
    let reference = match motion.filter(|_| scalar == ScalarSpec::F32) {
        None => None,
        Some(motion) => {
            let ticks = Ticks::new(motion, design.period).ok_or_else(|| too_long(certified, design))?;
            let error = ticks.error();
            Some((ticks, error))
        }
    };
    Ok(StepRounding { torque, sign, states, reference })
}

/// What is said of a motion of more periods than f32 can count.
fn too_long(certified: &Certified, design: &Design) -> Error {
    let mut faults = Diagnostics::of(&certified.checked.loaded.path);
    let problem =
        format!("is `f32`, which counts 16777216 periods of {} s, and the motion takes more", design.period);
    faults.push("emit.scalar", problem, "write \"f64\", or a shorter motion");
    faults.into_error()
}
