//! What many runs have found, beside what is certified.

use super::grid::Grid;
use crate::arm::Joint;
use crate::bounds::printed_up;
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
    let columns: [Column; 4] = [
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
            vec![format!("{} ({}, {})", joint.name, joint.kind.position_unit(), joint.kind.torque_unit())];
        let cell = |values: &[f64], shown: fn(f64) -> String| {
            values.get(i).map_or(String::new(), |value| shown(*value))
        };
        for (_, values, bound) in &columns {
            row.push(cell(values, short));
            // A bound that is rounded down is no bound.
            row.extend(bound.map(|bound| cell(bound, printed_up)));
        }
        grid.push(row);
    }
    grid.render() + &notes(found)
}

/// A heading, what was found and what is certified.
type Column<'a> = (&'a str, &'a [f64], Option<&'a [f64]>);

/// What the columns mean, and what happened in some of the runs.
fn notes(found: &MonteCarlo) -> String {
    let [settle, end, last] = found.times.map(|time| format!("{time:.3}"));
    let runs = |count: usize| if count == 1 { "1 run".to_string() } else { format!("{count} runs") };
    let mut out = format!(
        "{} of {last} s, found and not proved. Reach: any time. Settled: from {settle} s on. End: at {end} s, the first sample from the motion's end on.\n",
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Picture;
    use crate::simulate::example::three_link;

    #[test]
    fn what_is_certified_stands_beside_what_is_found() {
        let found = MonteCarlo {
            runs: 7,
            reach: vec![0.01, 0.02, 0.03],
            settled_error: vec![0.001, 0.002, 0.003],
            end_error: vec![0.0011, 0.0021, 0.0031],
            torque_max: vec![10.0, 20.0, 30.0],
            lost: 0,
            cut: 1,
            beyond: 2,
            times: [2.0, 3.0, 4.0],
            picture: Picture::default(),
        };
        let certified = CertifiedErrors {
            reach: &[0.05, 0.06, 0.0700016],
            settled_error: &[0.5, 0.6, 0.7],
            end_error: &[5.0, 6.0, 7.0],
            torque_max: &[50.0, 60.0, 70.0],
        };
        let joints = three_link().joints;
        let cells = |text: &str, row: usize| -> Vec<String> {
            let line = text.lines().nth(row).unwrap_or_default();
            line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_string).collect()
        };
        let alone = monte_carlo_table(&found, None, &joints);
        assert_eq!(cells(&alone, 0), ["largest found", "reach", "settled", "end", "torque"]);
        assert_eq!(cells(&alone, 3)[1..], ["0.02000", "0.002000", "0.002100", "20.00"]);
        let beside = monte_carlo_table(&found, Some(&certified), &joints);
        let (header, row) = (cells(&beside, 0), cells(&beside, 4));
        assert_eq!(header[1..5], ["reach", "certified", "settled", "certified"]);
        // 0.0700016 is nearest to 0.07000, which is no bound.
        let expected = ["0.03000", "0.07001", "0.003000", "0.7000", "0.003100", "7.000", "30.00", "70.00"];
        assert_eq!(row[1..], expected);
        assert!(beside.contains("In 1 run a torque limit") && beside.contains("In 2 runs the model's error"));
        assert!(!beside.contains("diverged"), "{beside}");
    }
}
