//! Motions: as many numbers as joints, times that run forwards, positions within limits.

use super::shape::length;
use crate::arm::Arm;
use crate::error::Diagnostics;
use crate::load::Loaded;
use crate::motion::{LONGEST, Motion, check_limits};
use crate::number::scientific;
use crate::spec::MotionSpec;
use crate::text::has;

/// Most knots of a motion and most sinusoids of a joint: each is written into the module.
const MOST_KNOTS: usize = 20_000;
const MOST_SINUSOIDS: usize = 1_000;

/// The motion that `spec` describes, where nothing is wrong with its fields or its table; against the limits of the
/// arm where that is known.
pub(super) fn check(
    spec: &MotionSpec,
    loaded: &Loaded,
    arm: Option<&Arm>,
    joints: Option<usize>,
    faults: &mut Diagnostics,
) -> Option<Motion> {
    let before = faults.count();
    fields(spec, joints, faults);
    if faults.count() > before {
        return None;
    }
    let motion = Motion::from_spec(spec, joints?, loaded, faults)?;
    if let Some(arm) = arm {
        check_limits(&motion, arm, faults);
    }
    Some(motion)
}

/// Checks the fields; a CSV table is checked where it is read.
fn fields(motion: &MotionSpec, joints: Option<usize>, faults: &mut Diagnostics) {
    match motion {
        MotionSpec::Quintic { from, to, duration } => {
            length("motion.quintic.from", from.len(), joints, faults);
            length("motion.quintic.to", to.len(), joints, faults);
            seconds("motion.quintic.duration", *duration, faults);
        }
        MotionSpec::Waypoints { times, positions } => waypoints(times, positions, joints, faults),
        MotionSpec::Sinusoids { offset, terms, duration } => {
            length("motion.sinusoids.offset", offset.len(), joints, faults);
            length("motion.sinusoids.terms", terms.len(), joints, faults);
            for (i, terms) in terms.iter().enumerate() {
                at_most(&format!("motion.sinusoids.terms[{i}]"), terms.len(), MOST_SINUSOIDS, faults);
            }
            seconds("motion.sinusoids.duration", *duration, faults);
        }
        MotionSpec::Csv { file } if file.is_empty() => {
            faults.push(
                "motion.csv.file",
                "is empty",
                "write the path of a table, relative to the specification",
            );
        }
        MotionSpec::Csv { .. } => {}
    }
}

fn waypoints(times: &[f64], positions: &[Vec<f64>], joints: Option<usize>, faults: &mut Diagnostics) {
    let field = "motion.waypoints.times";
    at_most(field, times.len(), MOST_KNOTS, faults);
    if times.len() < 2 {
        faults.push(field, has(times.len()), "write at least 2 times");
    }
    if let Some(first) = times.first().filter(|t| **t != 0.0) {
        faults.push(format!("{field}[0]"), format!("is {}", scientific(*first)), "start at 0");
    }
    for (i, pair) in times.windows(2).enumerate() {
        if let [before, after] = pair
            && after <= before
        {
            let problem = format!("is {}, after {}", scientific(*after), scientific(*before));
            faults.push(format!("{field}[{}]", i + 1), problem, "write the times in increasing order");
        }
    }
    if let Some(last) = times.last().filter(|last| **last > LONGEST) {
        let field = format!("{field}[{}]", times.len() - 1);
        faults.push(field, format!("is {last:e}"), format!("write at most {LONGEST:e}, in s"));
    }
    if positions.len() != times.len() {
        let problem = has(positions.len());
        faults.push(
            "motion.waypoints.positions",
            problem,
            format!("write {}, one for each time", times.len()),
        );
    }
    for (i, position) in positions.iter().enumerate() {
        length(&format!("motion.waypoints.positions[{i}]"), position.len(), joints, faults);
    }
}

fn at_most(field: &str, found: usize, most: usize, faults: &mut Diagnostics) {
    if found > most {
        faults.push(field, has(found), format!("write at most {most}: each is written into the module"));
    }
}

fn seconds(field: &str, value: f64, faults: &mut Diagnostics) {
    if value <= 0.0 {
        faults.push(field, format!("is {}", scientific(value)), "write a number above 0, in s");
    } else if value > LONGEST {
        faults.push(field, format!("is {value:e}"), format!("write at most {LONGEST:e}, in s"));
    }
}
