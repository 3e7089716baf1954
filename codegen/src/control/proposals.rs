//! Gains that are fast enough, for a judge that knows more than a level of V: the firmest first.

use super::region::room;
use super::search::{Scene, Target};
use super::settling::settling;
use super::{DesignProblem, Stage, gain_synthesis};
use crate::bounds::Rates;
use crate::check::{GainRequest, Tuning};
use crate::error::Error;

/// Shares of the gain that the period bears.
const SHARES: [f64; 5] = [0.9, 0.6, 0.35, 0.2, 0.1];
/// Periods for which gains are proposed where none is asked for.
const MOST: usize = 3;
/// What ρ is expected to be more than for the motion's own rates.
const FED_BACK: f64 = 1.3;

/// Gains with which `request` may be met, for the periods that it allows, the longest and the firmest first.
///
/// # Errors
/// [`Error::Internal`] for defects.
pub fn proposals(problem: &DesignProblem, request: &GainRequest) -> Result<Vec<Tuning>, Error> {
    let stage = Stage::new(problem, false)?;
    let n = problem.arm.dof();
    let width = problem.domain.width().unwrap_or(vec![0.0; n]);
    let target = Target { time: request.convergence_time, room: width };
    let scene = Scene::new(&stage, &target);
    let own = room(problem.domain, problem.motion, problem.arm);
    let start = &problem.control.initial_error.position;
    let beyond = |tube: &Vec<f64>| start.iter().zip(tube).any(|(start, tube)| start > tube);
    // What no gains remove.
    if request.tube.as_ref().is_some_and(beyond)
        || !gain_synthesis::obstacles(&stage, &scene, &own).is_empty()
    {
        return Ok(Vec::new());
    }
    let periods = match request.period {
        Some(period) => vec![period],
        None => gain_synthesis::PERIODS.to_vec(),
    };
    let rho = expected_gain(problem, &stage.disturbance);
    let mut out = Vec::new();
    let mut served = 0;
    for period in periods {
        let before = out.len();
        for share in SHARES {
            let Some(tuning) = scene.tuning(period, share, super::mix::START, &rho) else { continue };
            let taken = settling(problem.arm, problem.motion, &tuning, start, 4.0 * request.convergence_time);
            if taken <= request.convergence_time {
                out.push(tuning);
            }
        }
        served += usize::from(out.len() > before);
        if served == MOST {
            break;
        }
    }
    Ok(out)
}

/// About what ρ will be, by joint, N·m or N.
fn expected_gain(problem: &DesignProblem, disturbance: &[f64]) -> Vec<f64> {
    let Some(motion) = problem.motion else { return disturbance.to_vec() };
    let rates = Rates::of(motion);
    let model = problem.bounds.torque(&rates);
    let of = |i: usize| FED_BACK * (model[i] + problem.bounds.b[i] * rates.speed[i]) + disturbance[i];
    (0..disturbance.len()).map(of).collect()
}
