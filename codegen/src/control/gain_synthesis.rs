//! What a specification asks of the gains: gains that achieve it, or what stands in the way.

use super::Stage;
use super::region::{outside, room};
use super::search::{FAR, GainCandidate, Scene, Target};
use crate::arm::Arm;
use crate::check::{GainRequest, Tuning};
use crate::error::{Diagnostics, Error};
use crate::number::short;
use crate::progress;

/// Periods that are tried, longest first, where none is asked for, s.
pub(super) const PERIODS: [f64; 7] = [0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001];
/// Halvings of the asked period, and then of the interval in which the longest sufficient one lies.
const HALVINGS: usize = 4;
const NEARER: usize = 4;
/// Errors under half the period that are more than this share of those before show that the period is not at fault.
const STALLED: f64 = 0.97;

/// The gains that `request` asks for.
///
/// # Errors
/// [`Error::Input`] with what cannot be met, and by how much.
pub(super) fn tune(stage: &Stage, request: &GainRequest) -> Result<Tuning, Error> {
    let super::DesignProblem { file, arm, domain, motion, progress, .. } = *stage.problem;
    let n = arm.dof();
    let own = room(domain, motion, arm);
    let asked = &request.tube;
    let room =
        asked.as_ref().map_or(own.clone(), |asked| asked.iter().zip(&own).map(|(a, b)| a.min(*b)).collect());
    let target = Target { time: request.convergence_time, room };
    let mut faults = Diagnostics::of(file);
    let periods = request.period.map_or(PERIODS.to_vec(), |period| vec![period]);
    let told = progress::Stage::new(progress, "search for gains", periods.len());
    let scene = Scene::new(stage, &target);
    let obstacles = obstacles(stage, &scene, &own);
    if !obstacles.is_empty() {
        let mut help: Vec<&str> = Vec::new();
        if !scene.certified {
            help.extend(without_armature(arm));
            help.push("narrow `measure.tube.position_error` or the intervals of uncertainty");
        }
        if scene.certified || obstacles.len() > 1 {
            help.push("change the motion, the measure or the torque limits");
        }
        let help = format!("no gains remove this obstacle: {}", help.join(", or "));
        faults.push("control.design", format!("cannot be met: {}", obstacles.join("; ")), help);
        return Err(faults.into_error());
    }
    let start = &stage.problem.control.initial_error.position;
    if let Some(i) = (0..n).find(|&i| start[i] > target.room[i]) {
        faults.push(
            if asked.is_some() { "control.design.tube" } else { "control.initial_error.position" },
            format!(
                "cannot be met: joint {} starts with an error of {}, but only {} is allowed",
                i + 1,
                start[i],
                target.room[i]
            ),
            "take a smaller initial error or a wider tube",
        );
        return Err(faults.into_error());
    }
    let give_up = request.period.is_none().then_some(FAR);
    let mut nearest: Option<GainCandidate> = None;
    for &period in &periods {
        let _part = told.part();
        let Some(candidate) = scene.find(period, give_up)? else { continue };
        if candidate.holds {
            return Ok(candidate.tuning);
        }
        // Where the drives are too weak for gains that would do, the gains of a shorter period only ask more.
        let weak = short_of_torque(&candidate);
        if nearest.as_ref().is_none_or(|other| candidate.position_bound < other.position_bound) {
            nearest = Some(candidate);
        }
        if weak {
            break;
        }
    }
    if let Some(nearest) = nearest.as_ref().filter(|nearest| short_of_torque(nearest)) {
        too_weak(nearest, &mut faults);
        return Err(faults.into_error());
    }
    let shorter = match request.period {
        Some(period) => {
            let _told = progress::Stage::new(progress, "longest period", 1);
            longest(&scene, period)?
        }
        None => None,
    };
    if let (Some(period), Some(longest)) = (request.period, shorter) {
        let within = if asked.is_some() { "this tube" } else { "the measure's tube" };
        faults.push(
            "control.design.period",
            format!(
                "{period} s is too long: with {within}, initial error and convergence time there are gains up to {longest} s"
            ),
            "shorten it, widen the tube, or allow more time to converge",
        );
        return Err(faults.into_error());
    }
    let Some(nearest) = nearest else {
        too_fast(&scene, request, periods.last().copied().unwrap_or(f64::NAN), &mut faults);
        return Err(faults.into_error());
    };
    let own_width = domain.width();
    too_narrow(stage, &nearest, asked.as_deref(), own_width.as_deref(), &mut faults)?;
    Err(faults.into_error())
}

/// What to do about drives without inertia, where there are any.
fn without_armature(arm: &Arm) -> Option<&'static str> {
    let bare = arm.joints.iter().any(|joint| joint.armature == 0.0);
    bare.then_some("write the armature of the drives, without which wrists look too light")
}

/// What no gains remove.
pub(super) fn obstacles(stage: &Stage, scene: &Scene, room: &[f64]) -> Vec<String> {
    let super::DesignProblem { arm, domain, motion, .. } = *stage.problem;
    let mut obstacles = outside(domain, motion, arm, &vec![0.0; arm.dof()]);
    let taken = stage.feedforward.as_ref();
    obstacles.extend(taken.map_or(Vec::new(), |taken| taken.beyond_limits(arm, &stage.coulomb)));
    let closed = (1..).zip(room).filter(|(_, room)| **room <= 0.0);
    obstacles.extend(closed.map(|(number, _)| format!("joint {number} has no room for errors")));
    if !scene.certified {
        obstacles.push("the bounds on D over the domain cannot be certified".to_string());
    }
    obstacles
}

/// Whether it is the torque of the first step alone that a candidate fails by.
fn short_of_torque(candidate: &GainCandidate) -> bool {
    candidate.position_bound <= 1.0 && candidate.judged.first_step >= 1.0
}

/// The fault of drives that are too weak for the first step of the gains that come nearest.
fn too_weak(nearest: &GainCandidate, faults: &mut Diagnostics) {
    let asks = |reason: &&String| reason.starts_with("the initial errors");
    let reasons: Vec<&str> =
        nearest.judged.guarantee.reasons.iter().filter(asks).map(String::as_str).collect();
    faults.push(
        "control.design",
        format!("cannot be met: with the best gains found, {}", reasons.join("; ")),
        "take a smaller initial error, allow more time to converge, or raise the torque limits if the drives bear it",
    );
}

/// The fault of a convergence time that no gains reach with `period`, s.
fn too_fast(scene: &Scene, request: &GainRequest, period: f64, faults: &mut Diagnostics) {
    let least = scene.shortest_time(period);
    let least = least.map_or("far more".to_string(), |time| format!("at least {time:.3} s"));
    let asked = request.convergence_time;
    faults.push(
        "control.design.convergence_time",
        format!("{asked} s is too short: with a period of {period} s it takes {least}"),
        "allow more time, or shorten the period; both are in s, 1 ms is 0.001",
    );
}

/// The fault of a tube that errors leave under the best gains.
fn too_narrow(
    stage: &Stage,
    nearest: &GainCandidate,
    asked: Option<&[f64]>,
    own: Option<&[f64]>,
    faults: &mut Diagnostics,
) -> Result<(), Error> {
    let up = |e: &f64| format!("{:.4}", e + 5e-5);
    let list = |x: &[f64]| match x.split_first() {
        Some((first, rest)) if rest.iter().all(|e| up(e) == up(first)) => up(first),
        _ => format!("({})", x.iter().map(up).collect::<Vec<_>>().join(", ")),
    };
    let errors = &nearest.judged.envelope.position_error;
    if !nearest.position_bound.is_finite() {
        let help = "keep more functions in `model`, shorten the period, or compensate Coulomb friction";
        let problem = "cannot be met: what the model leaves out, and friction, raise the level of V without limit, whatever the gains";
        faults.push("control.design", problem, help);
        return Ok(());
    }
    let shown = |asked: &[f64]| match asked.split_first() {
        Some((first, rest)) if rest.iter().all(|e| e == first) => first.to_string(),
        _ => format!("{asked:?}"),
    };
    let enough = own.is_none_or(|own| errors.iter().zip(own).all(|(e, w)| e <= w));
    match asked {
        Some(asked) if enough => faults.push(
            "control.design.tube",
            format!("{} is too narrow: errors may reach {}", shown(asked), list(errors)),
            format!("write at least {}, or take a smaller initial error", list(errors)),
        ),
        Some(asked) => faults.push(
            "control.design.tube",
            format!("{} is too narrow: errors may reach {}", shown(asked), list(errors)),
            "take a smaller initial error, or widen it together with `measure.tube.position_error`",
        ),
        None => {
            let (_, judged) = stage.judge(&nearest.tuning)?;
            let most = &judged.guarantee.initial_error_max;
            let less = most.iter().map(|e| short(e * 0.9995)).collect::<Vec<_>>().join(", ");
            let wider = "widen `measure.tube.position_error`";
            let help = match most.iter().all(|e| *e > 0.0) {
                true => format!("{wider}, or take an initial position error of at most ({less})"),
                false => {
                    let ways = without_armature(stage.problem.arm).into_iter();
                    ways.chain(["shorten the period", wider]).collect::<Vec<_>>().join(", or ")
                }
            };
            faults.push(
                "control.design",
                format!("cannot be met: errors may reach {}, beyond the measure", list(errors)),
                help,
            );
        }
    }
    Ok(())
}

/// The longest period below `period`, to two digits, for which there are gains, s.
fn longest(scene: &Scene, period: f64) -> Result<Option<f64>, Error> {
    let (mut good, mut found, mut before) = (period, false, f64::INFINITY);
    for _ in 0..HALVINGS {
        good = two_digits(0.5 * good);
        let Some((_, candidate)) = scene.firmest(good, Some(FAR))? else { continue };
        found = candidate.holds;
        // Where more gain no longer helps, none will.
        if found || (before.is_finite() && candidate.position_bound > STALLED * before) {
            break;
        }
        before = candidate.position_bound;
    }
    let holds = |trial: f64| -> Result<bool, Error> {
        Ok(scene.firmest(trial, Some(FAR))?.is_some_and(|(_, candidate)| candidate.holds))
    };
    let mut bad = (2.0 * good).min(period);
    for _ in 0..NEARER {
        let middle = two_digits(0.5 * (good + bad));
        if !found || middle <= good || middle >= bad {
            break;
        }
        if holds(middle)? { good = middle } else { bad = middle }
    }
    Ok(found.then_some(good))
}

/// Cut to two significant digits: what is told is what was tried.
pub fn two_digits(x: f64) -> f64 {
    format!("{:.1e}", x * 0.995).parse().unwrap_or(x)
}
