//! Motions from a table `t,q1,…,qn`.

use super::LONGEST;
use super::Spline;
use crate::error::Diagnostics;
use crate::load::Named;

/// Most faults told of one file: a wrong column otherwise fills the screen.
const MOST_FAULTS: usize = 10;

/// Most rows: each becomes a piece of a spline in the module, some 80 bytes a joint.
const MOST_ROWS: usize = 20_000;

/// Reads a table of times, s, and positions, rad or m, one row an instant; a first line of words is skipped.
/// The end velocities are those of the parabolas through the first and last three points.
/// `None` after at least one fault was added.
pub(super) fn read(table: &Named, dof: usize, faults: &mut Diagnostics) -> Option<Spline> {
    let path = table.path.as_path();
    let text = match table.text() {
        Ok(text) => text,
        Err(error) => {
            faults.push(
                "motion.csv.file",
                format!("cannot read {}: {error}", path.display()),
                "name a readable CSV file, relative to the specification",
            );
            return None;
        }
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let (mut times, mut positions): (Vec<f64>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let mut wrong = 0;
    for (number, record) in reader.records().enumerate() {
        let Ok(record) = record else { continue };
        let line = record.position().map_or(number as u64 + 1, csv::Position::line);
        let header = number == 0 && record.iter().all(|cell| cell.parse::<f64>().is_err());
        if header {
            continue;
        }
        if times.len() == MOST_ROWS {
            let problem = format!("is row {} of numbers, and at most {MOST_ROWS} are read", MOST_ROWS + 1);
            let help = "keep every second row, or every tenth: a spline goes through the rows that are left";
            faults.push_at(path, Some(line as usize), "", problem, help);
            return None;
        }
        match row(&record, dof, times.last().copied()) {
            Ok((t, q)) => {
                times.push(t);
                positions.push(q);
            }
            Err((problem, help)) => {
                wrong += 1;
                if wrong <= MOST_FAULTS {
                    faults.push_at(path, Some(line as usize), "", problem, help);
                }
            }
        }
    }
    if wrong > 0 {
        return None;
    }
    if times.len() < 3 {
        let problem = format!("has {} rows of numbers", times.len());
        faults.push_in(path, "", problem, "give at least three rows t,q1,…,qn");
        return None;
    }
    let last = times.len() - 1;
    let first_slope = end_slope([0, 1, 2], &times, &positions);
    let last_slope = end_slope([last, last - 1, last - 2], &times, &positions);
    Some(Spline::through(&times, &positions, &first_slope, &last_slope))
}

type Wrong = (String, String);

fn row(record: &csv::StringRecord, dof: usize, before: Option<f64>) -> Result<(f64, Vec<f64>), Wrong> {
    if record.len() != dof + 1 {
        let problem = format!("has {} columns", record.len());
        return Err((problem, format!("write {} columns: t and {dof} positions", dof + 1)));
    }
    let mut numbers = Vec::with_capacity(record.len());
    for (column, cell) in (1..).zip(record) {
        match cell.parse::<f64>() {
            Ok(x) if x.is_finite() => numbers.push(x),
            _ => return Err((format!("column {column} is `{cell}`"), "write a finite number".to_string())),
        }
    }
    let q = numbers.split_off(1);
    let t = numbers.first().copied().unwrap_or_default();
    match before {
        Some(before) if t <= before => {
            Err((format!("time {t} is not later than {before}"), "write increasing times".to_string()))
        }
        _ if t > LONGEST => {
            Err((format!("time {t:e} is too late"), format!("write times up to {LONGEST:e}, in s")))
        }
        _ => Ok((t, q)),
    }
}

/// Slope at the first of three knots of the parabola through them, by joint.
fn end_slope(knots: [usize; 3], t: &[f64], q: &[Vec<f64>]) -> Vec<f64> {
    let [a, b, c] = knots;
    let (near, far) = (t[b] - t[a], t[c] - t[a]);
    let joints = q[a].iter().zip(&q[b]).zip(&q[c]);
    joints
        .map(|((qa, qb), qc)| {
            let (near_chord, far_chord) = ((qb - qa) / near, (qc - qa) / far);
            (near_chord * far - far_chord * near) / (far - near)
        })
        .collect()
}
