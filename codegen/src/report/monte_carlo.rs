//! What many runs have found, beside what is certified.

use super::grid::Grid;
use super::{position_unit, torque_unit};
use crate::arm::Joint;
use crate::number::short;
use crate::simulate::MonteCarlo;

/// Certified bounds on what runs can show, by joint.
#[derive(Clone, Copy, Debug)]
pub struct CertifiedErrors<'a> {
    /// On |q_e| at any time, rad or m.
    pub reach: &'a [f64],
    /// On |q_e| from settling on, rad or m.
    pub settled_error: &'a [f64],
    /// On |q_e| where the motion ends, rad or m.
    pub end_error: &'a [f64],
    /// On |τ|, N·m or N.
    pub torque_max: &'a [f64],
}

/// The largest errors and torques found, joint by joint, each beside its `certified` bound where there is one.
pub fn monte_carlo_table(
    found: &MonteCarlo,
    certified: Option<&CertifiedErrors>,
    joints: &[Joint],
) -> String {
    let columns: [(&str, &[f64], Option<&[f64]>); 4] = [
        ("reach", &found.reach, certified.map(|c| c.reach)),
        ("settled", &found.settled_error, certified.map(|c| c.settled_error)),
        ("end", &found.end_error, certified.map(|c| c.end_error)),
        ("torque", &found.torque_max, certified.map(|c| c.torque_max)),
    ];
    let mut header = vec!["largest found".to_string()];
    for (name, _, bound) in &columns {
        header.push((*name).to_string());
        header.extend(bound.map(|_| "certified".to_string()));
    }
    let mut grid = Grid::new(header);
    for (i, joint) in joints.iter().enumerate() {
        let mut row =
            vec![format!("{} ({}, {})", joint.name, position_unit(joint.kind), torque_unit(joint.kind))];
        let cell = |values: &[f64]| values.get(i).map_or(String::new(), |value| short(*value));
        for (_, values, bound) in &columns {
            row.push(cell(values));
            row.extend(bound.map(cell));
        }
        grid.push(row);
    }
    grid.render() + &notes(found)
}

/// What the columns mean, and what happened in some of the runs.
fn notes(found: &MonteCarlo) -> String {
    let [settle, end, last] = found.times.map(|time| format!("{time:.3}"));
    let runs = |count: usize| if count == 1 { "1 run".to_string() } else { format!("{count} runs") };
    let mut out = format!(
        "{} of {last} s, found and not proved. Reach: any time. Settled: from {settle} s on. End: at {end} s, the motion's end.\n",
        runs(found.runs)
    );
    let mut say = |count: usize, what: &str| {
        if count > 0 {
            out += &format!("In {} {what}\n", runs(count));
        }
    };
    say(found.lost, "the loop diverged.");
    say(found.cut, "a torque limit cut a command.");
    say(
        found.beyond,
        "the model's error was above its published bound at some instant: there the arm was outside the domain or faster than the law expects.",
    );
    out
}
