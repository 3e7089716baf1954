//! The loop over time: error funnel, tracking, torques and V, each with what is certified of it.

use super::figure::{Axis, Figure, Lines, Panel, Role, Series, drawn_up};
use super::study::Study;
use super::thin::{steps, thinned};
use super::words::{self, counted, worst};
use crate::arm::{Joint, JointKind};
use crate::guarantee::Sampled;
use crate::report::law_name;
use crate::simulate::{Comparison, Run};

/// Smallest error that is drawn on a logarithmic axis, rad or m: below it rounding is all there is.
const LEAST: f64 = 1e-12;

/// Names of the curves of the exact law and of the specification's own.
fn names(comparison: &Comparison) -> [String; 2] {
    let own = law_name(comparison.law_kind, comparison.boundary_layer.is_some());
    let fate =
        |run: &Run| run.metrics.diverged_at.map_or(String::new(), |at| format!(", diverged at {at:.2} s"));
    [
        format!("exact model, law (16){}", fate(&comparison.exact)),
        format!("this size, {own}{}", fate(&comparison.law)),
    ]
}

/// What both runs say over time.
fn both(comparison: &Comparison, value: &dyn Fn(&Run, usize) -> f64) -> Vec<Series> {
    let runs = [(&comparison.exact, Role::Exact), (&comparison.law, Role::Found)];
    let of = |((run, role), name): ((&Run, Role), String)| {
        let time = &run.trace.time;
        Series::curve(name, role, thinned(time, (0..time.len()).map(|k| value(run, k))))
    };
    runs.into_iter().zip(names(comparison)).map(of).collect()
}

/// A panel for each joint.
fn panels(joints: &[Joint], panel: impl Fn(usize, &Joint) -> Lines) -> Vec<Panel> {
    joints.iter().enumerate().map(|(i, joint)| Panel::Lines(panel(i, joint))).collect()
}

/// The certified |q_e| of joint `i` over time, rad or m, up to `end`, s: where the claim goes on when the errors are no longer
/// followed one by one, the settled ones hold.
fn course(sampled: &Sampled, i: usize, end: f64) -> Vec<(f64, f64)> {
    let followed = sampled.course.iter().filter(|(time, _)| *time <= end);
    let mut out = steps(followed.map(|(time, errors)| (*time, drawn_up(errors[i]))));
    let until = sampled.valid_until.unwrap_or(end).min(end);
    let last = out.last().map_or(0.0, |point| point.0);
    if let Some(settled) = sampled.settled_error.as_ref().filter(|_| sampled.settle <= last && last < until) {
        out.extend([last, until].map(|time| (time, drawn_up(settled[i]))));
    }
    out
}

/// Certified and found |q − q_d| over time.
pub(super) fn funnel_figure(study: &Study) -> Option<Figure> {
    let generation = &study.generation;
    let statement = generation.statement()?;
    generation.motion()?;
    let joints = &generation.arm().joints;
    let promised = study.promised();
    let tube = generation.domain().width();
    let end = study.found.as_ref().and_then(|found| found.picture.time.last().copied());
    let end = end.or(generation.motion().map(|motion| motion.duration())).unwrap_or(1.0);
    let panel = |i: usize, joint: &Joint| {
        let mut series = Vec::new();
        if let Some(width) = tube.as_ref().map(|tube| tube[i]).filter(|width| *width > 0.0) {
            series.push(Series::level("tube of the bounds", Role::Limit, [0.0, end], width));
        }
        if let Some(sampled) = promised {
            let course = course(sampled, i, end).into_iter().map(|(time, error)| (time, error.max(LEAST)));
            let course = course.collect();
            series.push(Series::curve("certified: no run exceeds it", Role::Certified, course));
        }
        if let Some(found) = &study.found {
            let largest = found.picture.largest.iter().map(|errors| errors[i].max(LEAST));
            let name = format!("largest of {}", counted(found.runs, "run"));
            series.push(Series::curve(name, Role::Found, thinned(&found.picture.time, largest)));
        }
        let y = Axis::logarithmic("position error", joint.kind.position_unit());
        Lines { title: joint.name.clone(), x: Axis::TIME, y, series }
    };
    let panels = panels(joints, panel);
    let caption = match promised {
        Some(sampled) => sampled_in_words(sampled, joints),
        None => format!(
            "Nothing is certified of the sampled loop at this size: {}. The runs show what was found and prove nothing.",
            match statement.reasons.is_empty() {
                true => "there is no proof".to_string(),
                false => statement.reasons.join("; "),
            }
        ),
    };
    Some(Figure { caption, panels })
}

fn sampled_in_words(sampled: &Sampled, joints: &[Joint]) -> String {
    let until = match sampled.valid_until {
        None => "for ever".to_string(),
        Some(end) => format!("until {}", words::time_down(end)),
    };
    let settled = sampled.settled_error.as_ref().map_or(String::new(), |error| {
        format!(", and below {} from {} on", worst(joints, error), words::time_up(sampled.settle))
    });
    format!(
        "Certified {until}, for every initial error of the specification and every arm of its intervals: the loop that runs \
         stays below the upper line. The worst joint stays below {} at any time{settled}. The gap to the runs is what the proof gives \
         away, and what the search has missed.",
        worst(joints, &sampled.reach)
    )
}

/// Position errors of both laws inside what is certified.
pub(super) fn tracking_figure(study: &Study) -> Option<Figure> {
    let comparison = study.comparison.as_ref()?;
    let joints = &study.generation.arm().joints;
    let (promised, design) = (study.promised(), study.generation.design()?);
    let end = comparison.law.trace.time.last().copied().unwrap_or(0.0);
    let panel = |i: usize, joint: &Joint| {
        let mut series = Vec::new();
        if let Some(sampled) = promised {
            let (x, y): (Vec<f64>, Vec<f64>) = course(sampled, i, end).into_iter().unzip();
            let low = y.iter().map(|y| -y).collect();
            let name = "certified: every run of this size stays inside".to_string();
            series.push(Series { name, role: Role::Certified, x, y, low });
        } else if design.guarantee.holds {
            let most = drawn_up(design.envelope.position_error[i]);
            let name = "certified for the continuous law";
            series.push(Series::between(name, Role::Certified, [0.0, end], [-most, most]));
        }
        series.extend(both(comparison, &|run, k| run.trace.position_error[k][i]));
        let y = Axis::linear("position error", joint.kind.position_unit());
        Lines { title: joint.name.clone(), x: Axis::TIME, y, series }
    };
    let panels = panels(joints, panel);
    let [exact, own] = [&comparison.exact, &comparison.law].map(|run| run.metrics.rms_error_total);
    let caption = format!(
        "One simulated run from the initial error of the specification, on the exact arm, of this size and of the exact model with no \
         robust term. The band holds for this size alone. Root mean square of the length of the error, all joints together: {} with \
         this size, {} with the other. {}",
        words::position(own, JointKind::Revolute, false),
        words::position(exact, JointKind::Revolute, false),
        verdict(comparison, study.generation.reduced().is_exact())
    );
    Some(Figure { caption, panels })
}

/// Which of both tracks better, in a sentence; `exact_model` where both have the exact one.
fn verdict(comparison: &Comparison, exact_model: bool) -> &'static str {
    let [exact, own] = [&comparison.exact, &comparison.law].map(|run| &run.metrics);
    match (own.diverged_at, exact.diverged_at) {
        (Some(_), _) => "This size diverges: do not use it.",
        (None, Some(_)) => "The exact law diverges: check its gains.",
        _ if exact_model => "Both have the exact model: what differs is the robust term.",
        _ if own.rms_error_total <= 1.05 * exact.rms_error_total => {
            "The smaller model costs no accuracy here."
        }
        _ => "The smaller model tracks worse here: compare with the sizes above.",
    }
}

/// Torques of both laws with their certified range and their limits.
pub(super) fn torque_figure(study: &Study) -> Option<Figure> {
    let comparison = study.comparison.as_ref()?;
    let generation = &study.generation;
    let (joints, design) = (&generation.arm().joints, generation.design()?);
    let end = comparison.law.trace.time.last().copied().unwrap_or(0.0);
    let sampled = generation.statement().and_then(|statement| statement.sampled.as_ref());
    let range = sampled.map(Sampled::torque_range);
    let panel = |i: usize, joint: &Joint| {
        let mut series = Vec::new();
        if let Some([low, high]) = &range {
            let name = "certified range of what the law asks for";
            series.push(Series::between(name, Role::Certified, [0.0, end], [low[i], high[i]]));
        }
        let limit = design.torque_limit.get(i).copied().flatten();
        for (name, level) in limit.iter().flat_map(|limit| [("limit", *limit), ("limit", -limit)]) {
            series.push(Series::level(name, Role::Limit, [0.0, end], level));
        }
        series.extend(both(comparison, &|run, k| run.trace.torque[k][i]));
        let name = if joint.kind == JointKind::Revolute { "torque" } else { "force" };
        let y = Axis::linear(name, joint.kind.torque_unit());
        Lines { title: joint.name.clone(), x: Axis::TIME, y, series }
    };
    let panels = panels(joints, panel);
    let used = joints.iter().enumerate().filter_map(|(i, joint)| {
        let limit = design.torque_limit.get(i).copied().flatten()?;
        let [low, high] = range.as_ref()?;
        Some((high[i].max(-low[i]) / limit, joint.name.as_str()))
    });
    let most = used.fold(None, |most: Option<(f64, &str)>, one| match most {
        Some(most) if most.0 >= one.0 => Some(most),
        _ => Some(one),
    });
    let certified = match (&range, most) {
        (None, _) => "Nothing is certified of the torque at this size.".to_string(),
        (Some(_), None) => "No joint has a torque limit, so nothing can cut in. The shaded range holds every torque that the law \
                            asks for."
            .to_string(),
        (Some(_), Some((part, name))) if part <= 1.0 => format!(
            "The law asks for {} of a joint's limit at most ({name}), so no limit cuts in and the guarantee stands.",
            words::percent(part, true)
        ),
        (Some(_), Some((part, name))) => format!(
            "The law may ask for {} of the limit of {name}: a limit may cut in, and nothing is promised. Lower the gains, the initial \
             error or the speed.",
            words::percent(part, true)
        ),
    };
    let steps = comparison.law.metrics.saturated_steps;
    let caption =
        format!("{certified} In the run shown, a limit cut the torque in {}.", counted(steps, "period"));
    Some(Figure { caption, panels })
}

/// V of both laws under the level that holds it.
pub(super) fn lyapunov_figure(study: &Study) -> Option<Figure> {
    let comparison = study.comparison.as_ref()?;
    let design = study.generation.design()?;
    let end = comparison.law.trace.time.last().copied().unwrap_or(0.0);
    let mut series = Vec::new();
    let holds = design.guarantee.holds;
    if holds {
        let level = drawn_up(design.envelope.level);
        series.push(Series::level("certified level, continuous law", Role::Certified, [0.0, end], level));
    }
    series.extend(both(comparison, &|run, k| {
        let v = run.trace.lyapunov[k];
        if v > 0.0 { v } else { f64::NAN }
    }));
    let lines = Lines {
        title: "Lyapunov function V".to_string(),
        x: Axis::TIME,
        y: Axis::logarithmic("V", "J"),
        series,
    };
    let level = words::three(design.envelope.level, true);
    let caption = match holds {
        true => format!(
            "V measures all errors together, as an energy. It never exceeds {level} J under the continuous law. It falls until the boundary \
             layer, the period and rounding stop it: that floor is the error that remains."
        ),
        false => format!(
            "V measures all errors together, as an energy. No level is certified at this size: {}",
            match design.guarantee.reasons.is_empty() {
                true => "no reason was found".to_string(),
                false => design.guarantee.reasons.join("; "),
            }
        ),
    };
    Some(Figure { caption, panels: vec![Panel::Lines(lines)] })
}
