//! What the report's figures claim, held against simulated runs.

use serde::Serialize;

use super::law_name;
use crate::number::short;
use crate::simulate::{CONVERGED, Comparison, Run};

/// The time within which the report's arm converges, s (its figure 4).
const CONVERGENCE_TIME: f64 = 1.5;
/// The part of the chatter that must go for it to count as removed.
const REMOVED: f64 = 0.9;

/// A statement, what was measured, and whether the measurement bears it out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Claim {
    /// The statement, with the threshold by which it is judged.
    pub claim: String,
    /// The measured numbers.
    pub measured: String,
    /// True where they bear it out.
    pub holds: bool,
}

/// Judges the claims of the report's section 4 from the same scenario without and with a boundary layer: three on
/// tracking for each, one on chatter from both.
pub fn claims(without: &Comparison, with: &Comparison) -> Vec<Claim> {
    let mut out = Vec::new();
    for comparison in [without, with] {
        out.extend(tracking(comparison));
    }
    out.push(chatter(without, with));
    out
}

fn tracking(comparison: &Comparison) -> [Claim; 3] {
    let Comparison { exact, law, .. } = comparison;
    let name = law_name(comparison.law_kind, comparison.boundary_layer.is_some());
    let finished = exact.metrics.diverged_at.is_none() && law.metrics.diverged_at.is_none();
    let (reduced, full) = (law.metrics.rms_error_total, exact.metrics.rms_error_total);
    let no_worse = Claim {
        claim: format!("{name}: tracks no worse than (16) with the exact model (rms)"),
        measured: format!("{} against {}", short(reduced), short(full)),
        holds: finished && reduced <= full,
    };
    let time = |run: &Run| match (run.metrics.convergence_time, run.metrics.diverged_at) {
        (_, Some(at)) => format!("diverged at {at:.2} s"),
        (Some(time), None) => format!("{time:.2} s"),
        (None, None) => "never".to_string(),
    };
    let in_time = |run: &Run| run.metrics.convergence_time.is_some_and(|time| time <= CONVERGENCE_TIME);
    let converge = Claim {
        claim: format!("{name}: it and (16) converge to {CONVERGED} in {CONVERGENCE_TIME} s"),
        measured: format!("{} against {}", time(law), time(exact)),
        holds: in_time(law) && in_time(exact),
    };
    let apart = largest_difference(exact, law);
    let indistinguishable = Claim {
        claim: format!("{name}: trajectory never {CONVERGED} from that of (16)"),
        measured: format!("at most {} apart", short(apart)),
        holds: finished && apart < CONVERGED,
    };
    [no_worse, converge, indistinguishable]
}

/// The largest difference between the positions of two runs along the same motion, rad or m, over the instants that
/// both have.
pub(crate) fn largest_difference(a: &Run, b: &Run) -> f64 {
    let instants = a.trace.position_error.iter().zip(&b.trace.position_error);
    instants.flat_map(|(a, b)| a.iter().zip(b)).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// The exact law switches nothing, so what a robust law's torque varies beyond that law's is chatter.
fn chatter(without: &Comparison, with: &Comparison) -> Claim {
    let variation = |run: &Run| run.metrics.torque_total_variation.iter().sum::<f64>();
    let excess = |comparison: &Comparison| variation(&comparison.law) - variation(&comparison.exact);
    let (sign, layer) = (variation(&without.law), variation(&with.law));
    let finished = without.law.metrics.diverged_at.is_none() && with.law.metrics.diverged_at.is_none();
    let measured = if sign > 0.0 {
        let exact = short(variation(&without.exact));
        let (ratio, sign, layer) = (short(layer / sign), short(sign), short(layer));
        format!("{sign} to {layer}: ratio {ratio}; exact {exact}")
    } else {
        "no torque at all".to_string()
    };
    Claim {
        claim: format!(
            "boundary layer removes {:.0} % of the chatter (torque variation beyond (16))",
            100.0 * REMOVED
        ),
        measured,
        // Where there is no chatter, there is none to remove.
        holds: finished && excess(without) > 0.0 && excess(with) <= (1.0 - REMOVED) * excess(without),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::example::Example;

    #[test]
    fn the_reports_claims_hold_on_its_arm() {
        let run = |layer| Example::three_link(Some(2), layer).simulate().unwrap();
        let judged = claims(&run(None), &run(Some(0.1)));
        assert_eq!(judged.len(), 7);
        assert!(judged.iter().all(|claim| claim.holds), "{judged:#?}");
    }

    #[test]
    fn a_false_claim_is_not_upheld() {
        let good = Example::three_link(Some(2), None).simulate().unwrap();
        let mut poor = good.clone();
        poor.law.metrics.rms_error_total = 2.0 * poor.exact.metrics.rms_error_total;
        poor.law.metrics.convergence_time = None;
        poor.law.trace.position_error[100][1] += 0.5;
        // Without a layer in either nothing is removed.
        assert!(claims(&poor, &poor).iter().all(|claim| !claim.holds));
        let mut diverged = good.clone();
        diverged.law.metrics.diverged_at = Some(1.0);
        diverged.law.metrics.convergence_time = None;
        assert!(claims(&diverged, &diverged).iter().all(|claim| !claim.holds));
    }
}
