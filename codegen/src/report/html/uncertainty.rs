//! What is known only to intervals.

use super::figure::{Axis, Bar, Bars, Figure, Panel, Role, Table};
use super::study::Study;
use super::words::{counted, plain};

/// The intervals of uncertain numbers; `None` where every number counts as known.
pub(super) fn figure(study: &Study) -> Option<Figure> {
    let generation = &study.generation;
    let uncertainty = generation.uncertainty();
    let learnt = generation.design().and_then(|design| design.adaptation.as_ref());
    if uncertainty.is_empty() && learnt.is_none() {
        return None;
    }
    let head = ["number", "lowest", "in the specification", "highest"];
    let mut table = Table::new("Intervals", head);
    let mut rows = Vec::new();
    let mut push = |name: &str, low: f64, nominal: f64, high: f64| {
        table.rows.push(vec![name.to_string(), plain(low), plain(nominal), plain(high)]);
        let scale = nominal.abs().max(0.5 * (high - low));
        let values = vec![100.0 * (low - nominal) / scale, 100.0 * (high - nominal) / scale];
        rows.push(Bar::new(name, values));
    };
    for p in &uncertainty.parameters {
        push(&p.name, p.nominal + p.low, p.nominal, p.nominal + p.high);
    }
    let joints = generation.arm().joints.iter();
    for (joint, width) in joints.zip(&uncertainty.viscous).filter(|(_, width)| **width > 0.0) {
        let own = joint.viscous_friction;
        push(&format!("viscous friction, {}", joint.name), (own - width).max(0.0), own, own + width);
    }
    if uncertainty.parameters.is_empty() {
        for (k, name) in learnt.iter().flat_map(|learnt| learnt.names.iter().enumerate()) {
            let [low, own, high] = learnt.map_or([0.0; 3], |l| [l.low[k], l.initial[k], l.high[k]]);
            push(name, low, own, high);
        }
    }
    let count = rows.len();
    let bars = Bars {
        title: "Intervals about the value of the specification".to_string(),
        axis: Axis::linear("away from the value", "%"),
        parts: vec![("down to".to_string(), Role::Exact), ("up to".to_string(), Role::Found)],
        stacked: false,
        rows,
    };
    let how = if learnt.is_some() {
        "The law learns them while it runs; until it has, its robust term covers them."
    } else {
        "Bounds and guarantee hold for every arm of these intervals, so wide ones make the certified errors large: narrow those that you can \
         measure."
    };
    let caption = format!(
        "{} known to an interval only. {how}",
        if count == 1 { "1 number is".to_string() } else { format!("{} are", counted(count, "number")) }
    );
    Some(Figure { caption, panels: vec![Panel::Bars(bars), Panel::Table(table)] })
}
