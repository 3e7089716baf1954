//! What section 4 claims, held against the runs.

use super::{Cases, LoadedCases};
use crate::number::short;
use crate::report::{Claim, largest_difference};
use crate::simulate::{CONVERGED, Comparison, Run};

/// The time within which the report's arm converges, s.
const CONVERGENCE_TIME: f64 = 1.5;
/// A mean step of the torque from one period to the next that counts as small beside its peak.
const SMALL: f64 = 0.1;
/// The part of the chatter that must go for it to count as removed.
const REMOVED: f64 = 0.9;

/// The claims with measured values; first those on the nominal load, then those on loads of −20 % and +20 %.
pub fn claims(cases: &Cases) -> Vec<Claim> {
    let Cases { simplified, layered, printed, .. } = cases;
    let (exact, law) = (&simplified.exact, &simplified.law);
    let apart = largest_difference(exact, law);
    let (better, full) = (law.metrics.rms_error_total, exact.metrics.rms_error_total);
    let step = law.relative_step();
    let mut out = vec![
        claim(
            format!("Fig. 2: exact and simplified trajectories cannot be told apart (never {CONVERGED} rad)"),
            format!("at most {} rad apart", short(apart)),
            apart < CONVERGED,
        ),
        claim(
            format!(
                "Fig. 3: chatter of the simplified law is small (mean step ≤ {SMALL} of the peak torque)"
            ),
            short(step),
            step <= SMALL,
        ),
        claim(
            "Fig. 4: the simplified law tracks slightly better (rms)".to_string(),
            format!("{} against {} rad", short(better), short(full)),
            better < full,
        ),
        claim(
            format!("Figs. 2, 4: convergence to {CONVERGED} rad within {CONVERGENCE_TIME} s"),
            format!("{} (exact {})", time(law), time(exact)),
            in_time(law) && in_time(exact),
        ),
        claim(
            format!(
                "the same with the gains as printed, Pqq = 4I and P12 = 0.25I, within {CONVERGENCE_TIME} s"
            ),
            format!("{}; e-folding time {}", time(&printed.law), folding(&printed.law)),
            in_time(&printed.law),
        ),
        claim(
            format!("a boundary layer removes {:.0} % of the chatter", 100.0 * REMOVED),
            format!(
                "{} to {} N·m of torque variation",
                short(variation(law)),
                short(variation(&layered.law))
            ),
            excess(layered) <= (1.0 - REMOVED) * excess(simplified),
        ),
    ];
    cases.loaded.iter().for_each(|cases| out.extend(loaded(cases)));
    out
}

/// The claims of Figures 5 and 6.
fn loaded(cases: &LoadedCases) -> Vec<Claim> {
    let LoadedCases { period, robust, adaptive, mass, robust_layered, adaptive_layered } = cases;
    let mut out = Vec::new();
    for (load, i) in [("-20 %", 0), ("+20 %", 1)] {
        let (robust, robust_layered) = (&robust[i].law, &robust_layered[i].law);
        for (learnt, adaptive) in [("all parameters", &adaptive[i].law), ("the mass", &mass[i].law)] {
            let name = format!("{} ms, load {load}, adapting {learnt}", short(1e3 * period));
            let (fast, slow) = (robust.metrics.rms_error_total, adaptive.metrics.rms_error_total);
            let times = format!("{} against {}", time(robust), time(adaptive));
            out.push(claim(
                format!("Fig. 6, {name}: robust converges faster (rms)"),
                format!("{} against {} rad; {times}", short(fast), short(slow)),
                fast < slow,
            ));
            out.push(claim(
                format!("Fig. 5, {name}: robust chatters more"),
                format!("{} against {} N·m", short(variation(robust)), short(variation(adaptive))),
                variation(robust) > variation(adaptive),
            ));
        }
        let (adaptive, layered) = (&adaptive[i].law, &adaptive_layered[i].law);
        let quiet = |layered: &Run, sign: &Run| variation(layered) <= (1.0 - REMOVED) * variation(sign);
        out.push(claim(
            format!("{} ms, load {load}: a boundary layer quiets both", short(1e3 * period)),
            format!("{} and {} N·m", short(variation(robust_layered)), short(variation(layered))),
            quiet(robust_layered, robust) && quiet(layered, adaptive),
        ));
    }
    out
}

fn claim(claim: String, measured: String, holds: bool) -> Claim {
    Claim { claim, measured, holds }
}

/// Σ|Δτ| over all joints, N·m.
fn variation(run: &Run) -> f64 {
    run.metrics.torque_total_variation.iter().sum()
}

/// What the law's torque varies beyond that of the exact one.
fn excess(comparison: &Comparison) -> f64 {
    variation(&comparison.law) - variation(&comparison.exact)
}

fn in_time(run: &Run) -> bool {
    run.metrics.convergence_time.is_some_and(|time| time <= CONVERGENCE_TIME)
}

fn time(run: &Run) -> String {
    match (run.metrics.convergence_time, run.metrics.diverged_at) {
        (_, Some(at)) => format!("diverged at {at:.2} s"),
        (Some(time), None) => format!("{time:.2} s"),
        (None, None) => "never".to_string(),
    }
}

/// The time in which the length of the position error falls to 1/e.
fn folding(run: &Run) -> String {
    let length = |e: &Vec<f64>| libm::sqrt(e.iter().map(|e| e * e).sum());
    let errors = &run.trace.position_error;
    let start = errors.first().map_or(0.0, length);
    let at = errors.iter().position(|e| length(e) <= start / std::f64::consts::E);
    at.and_then(|k| run.trace.time.get(k)).map_or("longer than the run".to_string(), |t| format!("{t:.2} s"))
}
