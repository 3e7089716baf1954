//! Gains and periods.

use super::figure::{Axis, Bar, Bars, Figure, Panel, Role, Table};
use super::study::Study;
use super::words::{self, three};
use crate::arm::JointKind;
use crate::bounds::printed_down;
use crate::control::{Design, RobustGain};
use crate::report::law_name;

/// The gains of the law by joint, and its period beside the longest stable one.
pub(super) fn figure(study: &Study) -> Option<Figure> {
    let generation = &study.generation;
    let design = generation.design()?;
    let promised = &design.guarantee;
    let law = law_name(design.law, design.boundary_layer.is_some());
    let stable = match design.period < promised.period_max {
        true => "below the longest at which the loop is stable with each D of the domain kept constant",
        false => "above the longest at which the loop is stable with each D of the domain kept constant",
    };
    let mut caption = format!(
        "{law}. The period of {} is {stable}: {}. Initial errors up to those of the table would still stay in the domain, for the \
         continuous law.",
        words::time(design.period),
        words::time_down(promised.period_max),
    );
    if let Some(first) = caption.get(..1).map(str::to_uppercase) {
        caption.replace_range(..1, &first);
    }
    let longest = if promised.period_certified { "longest, certified" } else { "longest, found" };
    let bar = |label: &str, value: f64| Bar::new(label, vec![1e3 * value]);
    let bars = Bars {
        title: "Control period".to_string(),
        axis: Axis::linear("period", "ms"),
        parts: vec![("period".to_string(), Role::Found)],
        stacked: false,
        rows: vec![bar("used", design.period), bar(longest, promised.period_max)],
    };
    Some(Figure { caption, panels: vec![Panel::Table(table(study, design)), Panel::Bars(bars)] })
}

fn table(study: &Study, design: &Design) -> Table {
    let joints = &study.generation.arm().joints;
    let mut head = vec!["joint", "W", "Pqq", "Ω", "P12"];
    head.extend(design.boundary_layer.as_ref().map(|_| "layer φ"));
    let switches = design.law.is_robust();
    if switches {
        head.push("switching gain");
    }
    head.push("initial error up to");
    let mut table = Table::new("Gains by joint (diagonals)", head);
    for (i, joint) in joints.iter().enumerate() {
        let (torque, rate) =
            (joint.kind.torque_unit(), if joint.kind == JointKind::Revolute { "rad" } else { "m" });
        let mut row = vec![
            joint.name.clone(),
            format!("{} {torque}·s/{rate}", three(design.w[i][i], false)),
            format!("{} {torque}/{rate}", three(design.gains.pqq[i][i], false)),
            format!("{} {torque}/({rate}·s)", three(design.omega[i][i], false)),
            format!("{} 1/s", three(design.gains.p12[i][i], false)),
        ];
        row.extend(design.boundary_layer.as_ref().map(|phi| format!("{} {rate}/s", three(phi[i], false))));
        if switches {
            row.push(match &design.robust_gain {
                RobustGain::Constant(gain) => format!("{} {torque}", three(gain[i], true)),
                RobustGain::State => "by the state".to_string(),
            });
        }
        let most = design.guarantee.initial_error_max.get(i);
        row.push(most.map_or(String::new(), |most| format!("{} {rate}", printed_down(*most))));
        table.rows.push(row);
    }
    table
}
