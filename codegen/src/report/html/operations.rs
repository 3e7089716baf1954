//! What a control step costs, with this model and with the exact one.

use super::figure::{Axis, Bar, Bars, Figure, Panel, Role, Table};
use super::study::Study;
use crate::control::StepGraph;
use crate::graph::{Operations, TRIG_PAIR};

/// Kinds of operation, what each counts for, and how many there are.
type Kind = (&'static str, usize, fn(&Operations) -> usize);

const KINDS: [Kind; 6] = [
    ("multiplications", 1, |o| o.mul),
    ("additions", 1, |o| o.add),
    ("fused multiply-adds", 1, |o| o.fused),
    ("sine-cosine pairs", TRIG_PAIR, |o| o.trig_pairs),
    ("clamps", 2, |o| o.other),
    ("divisions", 5, |o| o.div),
];

/// Operations of the step, this model's and the exact one's, with the verdict.
pub(super) fn figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let step = generation.step().map(StepGraph::operations);
    let (what, own) = match step {
        Some(own) => ("control step", own),
        None => ("model", generation.code().operations()),
    };
    let exact = match step {
        Some(_) => generation.exact_step().map(StepGraph::operations),
        None => Some(generation.exact_code().operations()),
    };
    let exact = exact.filter(|_| !generation.reduced().is_exact());
    let used: Vec<&Kind> = KINDS
        .iter()
        .filter(|kind| kind.2(&own) + exact.as_ref().map_or(0, |exact| kind.2(exact)) > 0)
        .collect();
    let mut models = vec![("this size", own)];
    models.extend(exact.map(|exact| ("exact model", exact)));
    let parts = used.iter().enumerate().map(|(k, kind)| (kind.0.to_string(), Role::Joint(k))).collect();
    let row = |(name, operations): &(&str, Operations)| {
        let values = used.iter().map(|kind| (kind.1 * kind.2(operations)) as f64).collect();
        Bar::new(*name, values)
    };
    let bars = Bars {
        title: format!("Cost of one {what}"),
        axis: Axis::linear("operations, weighted", ""),
        parts,
        stacked: true,
        rows: models.iter().map(row).collect(),
    };
    let mut table = Table::new("Operations", ["operation", "counts for"]);
    table.head.extend(models.iter().map(|(name, _)| (*name).to_string()));
    for kind in &used {
        let mut row = vec![kind.0.to_string(), kind.1.to_string()];
        row.extend(models.iter().map(|(_, operations)| kind.2(operations).to_string()));
        table.rows.push(row);
    }
    let mut sum = vec!["weighted sum".to_string(), String::new()];
    sum.extend(models.iter().map(|(_, operations)| operations.cost().to_string()));
    table.rows.push(sum);
    Figure { caption: generation.verdict(), panels: vec![Panel::Bars(bars), Panel::Table(table)] }
}
