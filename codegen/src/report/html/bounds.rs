//! What the model leaves out in torque: certified, and found.

use super::figure::{Axis, Bar, Bars, Figure, Panel, Role, Table, drawn_up};
use super::study::Study;
use super::words;
use crate::bounds::Torque;

/// The torque error by joint as a part of the peak torque, certified and found.
pub(super) fn figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let Some(torque) = generation.torque() else {
        let caption = "A joint lacks a limit of speed or acceleration, so the error cannot be told in torque. Give every joint its \
                       limits in the specification."
            .to_string();
        return Figure { caption, panels: Vec::new() };
    };
    let joints = &generation.arm().joints;
    let found = study.torque_found.as_deref();
    let part =
        |error: f64, i: usize| if torque.is_still(i) { f64::NAN } else { 100.0 * error / torque.peak[i] };
    let mut parts = vec![("certified bound".to_string(), Role::Certified)];
    parts.extend(found.map(|_| ("largest found by search".to_string(), Role::Found)));
    let row = |i: usize| {
        let mut values = vec![drawn_up(part(torque.error[i], i))];
        values.extend(found.map(|found| part(found[i], i)));
        Bar::new(&joints[i].name, values)
    };
    let bars = Bars {
        title: "Torque error of the model".to_string(),
        axis: Axis::linear("part of the peak torque", "%"),
        parts,
        stacked: false,
        rows: (0..joints.len()).map(row).collect(),
    };
    let panels = vec![Panel::Bars(bars), Panel::Table(table(study, torque))];
    Figure { caption: caption(study, torque), panels }
}

fn table(study: &Study, torque: &Torque) -> Table {
    let joints = &study.generation.arm().joints;
    let head = ["joint", "certified", "found", "at the law's rates", "peak torque"];
    let mut table = Table::new("Torque error by joint", head);
    let met = study.generation.met();
    for (i, joint) in joints.iter().enumerate() {
        let unit = joint.kind.torque_unit();
        let cell = |x: Option<f64>, up: bool| {
            x.map_or("not available".to_string(), |x| format!("{} {unit}", words::three(x, up)))
        };
        table.rows.push(vec![
            joint.name.clone(),
            cell(Some(torque.error[i]), true),
            cell(study.torque_found.as_ref().map(|found| found[i]), false),
            cell(met.map(|met| met.error[i]), true),
            cell(Some(torque.peak[i]), false),
        ]);
    }
    table
}

fn caption(study: &Study, torque: &Torque) -> String {
    let generation = &study.generation;
    let exact = generation.reduced().is_exact();
    let worst = match torque.fraction() {
        fraction if fraction.is_finite() => {
            format!("at most {} of the peak torque in the worst joint", words::percent(fraction, true))
        }
        _ => "not told as a percentage, since a joint takes no torque".to_string(),
    };
    let ratios = study.torque_found.iter().flatten().zip(&torque.error).map(|(found, error)| error / found);
    let sharp = ratios.fold(0.0, f64::max);
    let sharp = match sharp.is_finite() && !exact {
        true => format!(" The bound is at most {} times what was found.", words::three(sharp, true)),
        false => String::new(),
    };
    let uncertain = !generation.uncertainty().is_empty();
    let how = match exact {
        true if uncertain => {
            "This is the exact model of the arm as specified: the error is that of the uncertain numbers."
                .to_string()
        }
        true => "This is the exact model: what is left is rounding, and what was rounded off the rotations."
            .to_string(),
        false => format!(
            "No state inside the domain exceeds the certified bound. The search shows how close to it real states come.{sharp}"
        ),
    };
    format!("The model's error is {worst}. {how}")
}
