//! Gains on request: those with which the sampled loop is guaranteed.

use super::Means;
use super::certified::Certified;
use super::designed::{Designed, Judged, with_problem};
use crate::bounds::{Effort, printed_up};
use crate::check::{Control, GainRequest, GainSource, Tuning};
use crate::control::{proposals, two_digits};
use crate::error::Error;
use crate::guarantee::{Kind, Sampled};
use crate::progress::Silent;
use crate::spec::LawSpec;

/// Most halvings of a period that is too long.
const HALVINGS: u32 = 4;
/// Most periods of the motion after those, unless one halving takes more: each halving doubles the work.
const PERIODS: f64 = 12_000.0;

/// Whether the errors of the sampled loop can be followed.
pub(super) fn follows(certified: &Certified, control: &Control) -> bool {
    let checked = &certified.checked;
    control.law != LawSpec::Adaptive && checked.motion.is_some()
}

/// Whether what is promised is sought: without errors to follow that takes no time.
pub(super) fn judges(certified: &Certified, means: Means) -> bool {
    let control = certified.checked.control.as_ref();
    means.judges || !control.is_some_and(|control| follows(certified, control))
}

/// The controller with gains that `request` asks for and for which the sampled loop is guaranteed: those of a level of V, or else
/// others that are fast enough.
///
/// # Errors
/// [`Error::Input`] with what stands in the way, and with a shorter period where that is enough.
pub(super) fn requested(
    certified: &Certified,
    control: &Control,
    request: &GainRequest,
    means: Means,
) -> Result<Judged, Error> {
    let first = Designed::made(certified, control, means);
    let nearest = match attempt(certified, control, request, first, means) {
        Ok(judged) => return Ok(judged),
        Err(nearest) => *nearest,
    };
    let file = &certified.checked.loaded.path;
    let known = nearest.as_ref().ok().and_then(|judged| judged.statement.as_ref());
    let sampled = known.and_then(|statement| statement.sampled.as_ref());
    if let (Some(period), None) = (request.period, sampled) {
        let shorter = |k: u32| two_digits(period / f64::from(1 << k));
        // A level of V that no gains hold at one period is not sought again at each: that search takes longest.
        let unknown = || Err(Error::Internal("no level of V was sought".to_string()));
        let enough = |k: u32, level: bool| {
            let request = GainRequest { period: Some(shorter(k)), ..request.clone() };
            let control = Control { gains: GainSource::Requested(request.clone()), ..control.clone() };
            let first = if level { Designed::made(certified, &control, means) } else { unknown() };
            attempt(certified, &control, &request, first, means).is_ok()
        };
        let duration = certified.checked.motion.as_ref().map_or(0.0, |motion| motion.duration());
        let few = |k: &u32| duration / shorter(*k) <= PERIODS;
        let most = (1..=HALVINGS).take_while(few).last().unwrap_or(1);
        // What the shortest one does not help, none does.
        if enough(most, false) {
            let found = (1..most).find(|&k| enough(k, false)).unwrap_or(most);
            // A level may hold at a longer one.
            let shorter = shorter((1..found).find(|&k| enough(k, true)).unwrap_or(found));
            let problem = format!("{period} s is too long: there are gains at {shorter} s");
            let help = "shorten it, widen the tube, or allow more time to converge";
            return Err(Error::input(file, "control.design.period", problem, help));
        }
    }
    let mut reasons = known.map_or_else(Vec::new, |statement| statement.reasons.clone());
    if let Some(sampled) = sampled.filter(|sampled| !inside(request, sampled)) {
        let reach: Vec<String> = sampled.reach.iter().map(|reach| printed_up(*reach)).collect();
        reasons.push(format!("errors may reach ({}), outside the tube that is asked for", reach.join(", ")));
    }
    nearest?;
    let problem = format!("cannot be met: with the best gains found, {}", reasons.join("; "));
    let help = "take a slower motion, a smaller initial error or a wider tube, allow more time to converge, or raise the torque limits if the drives bear it";
    Err(Error::input(file, "control.design", problem, help))
}

/// The same for the periods of the request alone, from `first`, the controller of a level of V; where no gains are found, those
/// that come nearest or what the first search says.
fn attempt(
    certified: &Certified,
    control: &Control,
    request: &GainRequest,
    first: Result<Judged, Error>,
    means: Means,
) -> Result<Judged, Box<Result<Judged, Error>>> {
    let is_sampled = |judged: &Judged| {
        let statement = judged.statement.as_ref().filter(|statement| statement.kind == Kind::Sampled);
        let sampled = statement.and_then(|statement| statement.sampled.as_ref());
        sampled.is_some_and(|sampled| inside(request, sampled))
    };
    let mut nearest = match first {
        Ok(first) => {
            let first = first.stated(certified, means);
            if is_sampled(&first) {
                return Ok(first);
            }
            Ok(first)
        }
        Err(error) => Err(error),
    };
    let tunings = proposed(certified, control, request).map_err(|error| Box::new(Err(error)))?;
    for tuning in tunings {
        let control = Control { gains: GainSource::Given(tuning), ..control.clone() };
        let Ok(judged) = Designed::made(certified, &control, means) else { continue };
        let judged = judged.stated(certified, means);
        if is_sampled(&judged) {
            return Ok(judged);
        }
        let followed = judged.statement.as_ref().is_some_and(|statement| statement.sampled.is_some());
        if nearest.is_err() && followed {
            nearest = Ok(judged);
        }
    }
    Err(Box::new(nearest))
}

/// Whether errors stay in the tube that is asked for.
fn inside(request: &GainRequest, sampled: &Sampled) -> bool {
    let within = |tube: &Vec<f64>| sampled.reach.iter().zip(tube).all(|(reach, tube)| reach <= tube);
    request.tube.as_ref().is_none_or(within)
}

/// Gains that may meet `request`.
fn proposed(certified: &Certified, control: &Control, request: &GainRequest) -> Result<Vec<Tuning>, Error> {
    let means = Means { effort: &Effort::default(), progress: &Silent, cache: None, judges: true };
    with_problem(certified, control, means, None, |problem| proposals(problem, request))
}
