//! Runs inside the funnel: what is certified of the errors over time, and the largest that runs have found.

use super::figure::{Figure, Panel};
use super::series::curve;
use crate::arm::Joint;
use crate::error::Error;
use crate::guarantee::Sampled;
use crate::simulate::MonteCarlo;

/// Smallest error that is drawn, rad or m: below it rounding is all there is.
const LEAST: f64 = 1e-12;
/// Joints in a row.
const ACROSS: usize = 2;

/// The certified and the largest found |q − q_d| over time as an SVG file: a panel a joint, on logarithmic axes.
///
/// # Errors
/// [`Error::Internal`] where the drawing library fails.
pub fn funnel_plot(sampled: &Sampled, found: &MonteCarlo, joints: &[Joint]) -> Result<String, Error> {
    let height = |error: f64| libm::log10(error.max(LEAST));
    let certified: Vec<f64> = sampled.course.iter().map(|(time, _)| *time).collect();
    let panel = |(i, joint): (usize, &Joint)| {
        let own = sampled.course.iter().map(|(_, errors)| height(errors[i]));
        let seen = found.picture.largest.iter().map(|errors| height(errors[i]));
        Panel {
            title: format!("{}: position error", joint.name),
            y: format!("largest error ({})", joint.kind.position_unit()),
            curves: [curve(&certified, own), curve(&found.picture.time, seen)],
            logarithmic: true,
        }
    };
    let mut panels = joints.iter().enumerate().map(panel);
    let mut rows = Vec::new();
    loop {
        let row: Vec<Panel> = panels.by_ref().take(ACROSS).collect();
        if row.is_empty() {
            break;
        }
        rows.push(row);
    }
    let last = |times: &[f64]| times.last().copied().unwrap_or(0.0);
    let figure = Figure {
        title: "Errors of the sampled loop",
        legend: ["certified: no run exceeds it".to_string(), format!("largest of {} runs", found.runs)],
        rows,
        end: last(&certified).max(last(&found.picture.time)).max(1e-6),
    };
    figure.svg()
}
