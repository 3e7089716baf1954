//! Tables for the terminal.

use super::grid::Grid;
use super::{Claim, law_name};
use crate::arm::{Joint, JointKind};
use crate::bounds::Bounds;
use crate::graph::Operations;
use crate::number::short;
use crate::simulate::{CONVERGED, Chatter, Comparison, Metrics, Run};
use crate::spec::RobustGainSpec;

/// The metrics of both laws, joint by joint, then those of the whole arm.
pub fn metrics_table(comparison: &Comparison, joints: &[Joint]) -> String {
    let (exact, law) = (&comparison.exact.metrics, &comparison.law.metrics);
    let name = law_name(comparison.law_kind, comparison.boundary_layer.is_some());
    let mut grid = Grid::new(["", "law (16), exact model", &format!("{name}, this model")]);
    let quantities: [(&str, Unit, PerJoint); 4] = [
        ("rms error", JointKind::position_unit, |m| &m.rms_error),
        ("final error", JointKind::position_unit, |m| &m.final_error),
        ("peak torque", JointKind::torque_unit, |m| &m.peak_torque),
        ("torque variation", JointKind::torque_unit, |m| &m.torque_total_variation),
    ];
    for (quantity, unit, values) in quantities {
        for (joint, (&exact, &law)) in joints.iter().zip(values(exact).iter().zip(values(law))) {
            grid.push([
                format!("{quantity}, {} ({})", joint.name, unit(joint.kind)),
                short(exact),
                short(law),
            ]);
        }
    }
    let both = |value: &dyn Fn(&Run) -> String| [value(&comparison.exact), value(&comparison.law)];
    let mut whole = |label: String, values: [String; 2]| {
        let [exact, law] = values;
        grid.push([label, exact, law]);
    };
    whole("rms error, all joints together".to_string(), both(&|run| short(run.metrics.rms_error_total)));
    let time = |time: Option<f64>, none: &str| time.map_or(none.to_string(), |t| format!("{t:.3}"));
    whole(
        format!("within {CONVERGED} for good after (s)"),
        both(&|run| time(run.metrics.convergence_time, "never")),
    );
    whole("steps at a torque limit".to_string(), both(&|run| run.metrics.saturated_steps.to_string()));
    whole("steps with a fault".to_string(), both(&|run| run.metrics.faulted_steps.to_string()));
    whole("diverged at (s)".to_string(), both(&|run| time(run.metrics.diverged_at, "no")));
    grid.render()
}

/// The chatter measured with each robust gain, beside the exact law, which switches nothing.
pub fn chatter_table(measured: &[Chatter], exact: f64) -> String {
    let heading = "measured chatter: mean torque step over peak torque, worst joint";
    let mut grid = Grid::new(["robust gain", heading]);
    for chatter in measured {
        let name = match chatter.robust_gain {
            RobustGainSpec::Constant => "constant",
            RobustGainSpec::State | RobustGainSpec::Auto => "state",
        };
        let used = if chatter.used { " (this law's)" } else { "" };
        let value = match (chatter.relative_step, &chatter.diverged_at, &chatter.refused) {
            (Some(step), None, _) => short(step),
            (Some(step), Some(at), _) => format!("{}, diverged at {at:.3} s", short(step)),
            (None, _, why) => format!("refused: {}", why.as_deref().unwrap_or_default()),
        };
        grid.push([format!("{name}{used}"), value]);
    }
    grid.push(["none: law (16), exact model".to_string(), short(exact)]);
    grid.render()
}

type Unit = fn(JointKind) -> &'static str;
type PerJoint = fn(&Metrics) -> &[f64];

/// The bounds (26)–(28) that are not zero, one a line; h_ijk with j ≤ k stands for h_ikj too.
pub fn bounds_table(bounds: &Bounds) -> String {
    let mut grid = Grid::new(["entry", "bound on what the model leaves out"]);
    let mut any = false;
    let mut push = |entry: String, bound: f64| {
        if bound != 0.0 {
            any = true;
            grid.push([entry, short(bound)]);
        }
    };
    for (i, row) in bounds.d.iter().enumerate() {
        for (j, &bound) in row.iter().enumerate().skip(i) {
            push(format!("d{}{}", i + 1, j + 1), bound);
        }
    }
    for (i, layer) in bounds.h.iter().enumerate() {
        for (j, row) in layer.iter().enumerate() {
            for (k, &bound) in row.iter().enumerate().skip(j) {
                push(format!("h{}{}{}", i + 1, j + 1, k + 1), bound);
            }
        }
    }
    for (i, &bound) in bounds.g.iter().enumerate() {
        push(format!("g{}", i + 1), bound);
    }
    if any { grid.render() } else { "The model leaves nothing out: all bounds are zero.\n".to_string() }
}

/// What one evaluation of each model costs.
pub fn operations_table(models: &[(&str, Operations)]) -> String {
    let mut grid = Grid::new(["model", "mul", "add", "mul + add", "sin/cos pairs"]);
    for (name, operations) in models {
        let counts = [operations.mul, operations.add, operations.arithmetic(), operations.trig_pairs];
        grid.push([(*name).to_string()].into_iter().chain(counts.map(|count| count.to_string())));
    }
    grid.render()
}

/// The claims with what was measured and the verdict.
pub fn claims_table(claims: &[Claim]) -> String {
    let mut grid = Grid::new(["claim", "measured", "verdict"]);
    for claim in claims {
        let verdict = if claim.holds { "holds" } else { "does not hold" };
        grid.push([claim.claim.as_str(), &claim.measured, verdict]);
    }
    grid.render()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::claims;
    use crate::simulate::example::Example;

    #[test]
    fn every_joint_and_metric_has_a_line() {
        let example = Example::three_link(Some(2), Some(0.1));
        let text = metrics_table(&example.simulate().unwrap(), &example.arm.joints);
        assert_eq!(text.lines().count(), 2 + 4 * 3 + 5, "{text}");
        assert!(text.contains("peak torque, joint2 (N·m)"), "{text}");
        let width = |line: &str| line.chars().count();
        let first = text.lines().next().map_or(0, width);
        assert!(text.lines().all(|line| width(line) <= first), "{text}");
    }

    #[test]
    fn bounds_that_are_zero_are_left_out() {
        let zero = Bounds {
            d: vec![vec![0.0; 2]; 2],
            h: vec![vec![vec![0.0; 2]; 2]; 2],
            b: vec![0.0; 2],
            g: vec![0.0; 2],
        };
        assert!(bounds_table(&zero).contains("all bounds are zero"));
        let mut some = zero;
        some.d[0][1] = 0.25;
        some.d[1][0] = 0.25;
        some.h[1][0][1] = 0.5;
        some.g[1] = 1.0;
        let text = bounds_table(&some);
        let entries: Vec<&str> = text.lines().skip(2).filter_map(|l| l.split_whitespace().next()).collect();
        assert_eq!(entries, ["d12", "h212", "g2"]);
    }

    #[test]
    fn operations_are_summed() {
        let text = operations_table(&[(
            "exact",
            Operations { mul: 60, add: 40, trig_pairs: 3, ..Operations::default() },
        )]);
        assert!(
            text.lines().nth(2).is_some_and(|l| l.split_whitespace().eq(["exact", "60", "40", "100", "3"]))
        );
    }

    #[test]
    fn verdicts_are_the_computed_ones() {
        let run = |layer| Example::three_link(Some(2), layer).simulate().unwrap();
        let (without, with) = (run(None), run(Some(0.1)));
        let count = |claims: &[Claim]| claims_table(claims).matches("does not hold").count();
        assert_eq!(count(&claims(&without, &with)), 0);
        assert_eq!(count(&claims(&without, &without)), 1);
    }
}
