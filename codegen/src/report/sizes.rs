//! Tables, a figure and a CSV file of a sweep over model sizes.

use std::ops::RangeInclusive;

use super::grid::Grid;
use crate::bounds::{percent_up, printed_down, printed_up};
use crate::sizes::{Entry, Gain, Row};

/// Most characters of a line of a table.
const WIDTH: usize = 80;
/// Most characters of a name in the first column, as many as there is room for.
const NAMES: RangeInclusive<usize> = 8..=24;
/// A fraction of the peak torque below which only that is said.
const LEAST: f64 = 1e-5;

/// The rows of a sweep as tables of at most 80 columns: an overview, torque errors and switching gains by joint, then the sizes that
/// were refused with their reasons.
pub fn sizes_table(entries: &[&Entry], guarantee: bool) -> String {
    let several = entries.windows(2).any(|pair| pair[0].spec != pair[1].spec);
    let tables = |most: usize| tables(entries, several, most, guarantee);
    let fits = |text: &String| text.lines().all(|line| line.chars().count() <= WIDTH);
    // Names give way where the numbers need the room.
    let fitting = NAMES.rev().map(tables).find(fits);
    let mut parts = vec![fitting.unwrap_or_else(|| tables(*NAMES.start()))];
    let refused = entries.iter().filter_map(|entry| {
        let why = entry.refused.as_ref()?;
        Some(format!("{}: refused: {why}\n", whole_name(entry, several)))
    });
    parts.push(refused.collect());
    parts.retain(|part| !part.is_empty());
    parts.join("\n")
}

/// The tables, with names of `most` characters at most.
fn tables(entries: &[&Entry], several: bool, most: usize, guarantee: bool) -> String {
    let name = |entry: &Entry| shortened(whole_name(entry, several), most);
    let rows: Vec<(String, &Row)> =
        entries.iter().filter_map(|entry| Some((name(entry), entry.row.as_ref()?))).collect();
    if rows.is_empty() {
        return String::new();
    }
    let error = |row: &Row| row.torque_error.clone();
    let gain = |row: &Row| row.switching_gain.clone();
    let by_joint = [
        by_joint("Certified torque error by joint (N·m or N)", &rows, &error),
        by_joint("Largest switching gain by joint (N·m or N)", &rows, &gain),
    ];
    [Some(overview(&rows, guarantee))].into_iter().chain(by_joint).flatten().collect::<Vec<_>>().join("\n")
}

/// One row in a line, to be shown while others are still worked on.
pub fn size_line(entry: &Entry) -> String {
    let what = match (&entry.row, &entry.refused) {
        (Some(row), _) => {
            format!("{} operations, torque error {}", row.operations.total, worst(row))
        }
        (None, why) => format!("refused: {}", why.as_deref().unwrap_or_default()),
    };
    format!("{}, {}: {what}", entry.spec, entry.size)
}

/// What a row is called; the specification counts where there are several.
fn whole_name(entry: &Entry, several: bool) -> String {
    if several { format!("{} {}", entry.spec, entry.size) } else { entry.size.clone() }
}

/// The end of `name`, where it has more than `most` characters.
fn shortened(name: String, most: usize) -> String {
    match name.chars().count().checked_sub(most).filter(|more| *more > 0) {
        Some(more) => std::iter::once('…').chain(name.chars().skip(more + 1)).collect(),
        None => name,
    }
}

fn worst(row: &Row) -> String {
    row.worst_fraction().map_or("-".to_string(), |fraction| match fraction {
        // Where nothing is left out, rounding is all there is.
        fraction if fraction < LEAST => format!("< {} %", 100.0 * LEAST),
        fraction => percent_up(fraction),
    })
}

fn overview(rows: &[(String, &Row)], guarantee: bool) -> String {
    let mut header = vec!["size", "ops", "saved", "error", "gain", "T max (s)", "KB"];
    if guarantee {
        header.push("guarantee");
    }
    let mut grid = Grid::new(header);
    for (name, row) in rows {
        let saved = row.exact_operations.map(|exact| {
            let (ours, theirs) = (row.operations.total as f64, exact.total as f64);
            format!("{:.1} %", 100.0 * (theirs - ours) / theirs)
        });
        let gain = row.gain.map(|gain| match gain {
            Gain::State => "state",
            Gain::Constant => "constant",
        });
        let mut cells = vec![
            name.clone(),
            row.operations.total.to_string(),
            saved.unwrap_or("-".to_string()),
            worst(row),
            gain.unwrap_or("-").to_string(),
            row.period_max.map_or("-".to_string(), printed_down),
            format!("{:.1}", row.bytes as f64 / 1e3),
        ];
        if guarantee {
            cells.push(row.guarantee.as_ref().map_or("-".to_string(), |promise| promise.kind.clone()));
        }
        grid.push(cells);
    }
    grid.render()
}

/// A table of one number by joint, in parts where it is too wide; none where no row has such numbers.
fn by_joint(
    title: &str,
    rows: &[(String, &Row)],
    value: &dyn Fn(&Row) -> Option<Vec<f64>>,
) -> Option<String> {
    let values: Vec<(&String, Vec<f64>)> =
        rows.iter().filter_map(|(name, row)| Some((name, value(row)?))).collect();
    let joints = values.iter().map(|(_, values)| values.len()).max().filter(|joints| *joints > 0)?;
    // Two spaces and a number.
    let room = (WIDTH - rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0)) / 11;
    let mut out = format!("{title}\n\n");
    for first in (0..joints).step_by(room) {
        let shown = first..(first + room).min(joints);
        let heads = shown.clone().map(|i| format!("joint {}", i + 1));
        let mut grid = Grid::new(std::iter::once("size".to_string()).chain(heads));
        for (name, values) in &values {
            let cell = |i: usize| values.get(i).map_or(String::new(), |x| printed_up(*x));
            grid.push(std::iter::once(name.to_string()).chain(shown.clone().map(cell)));
        }
        out += if first > 0 { "\n" } else { "" };
        out += &grid.render();
    }
    Some(out)
}
