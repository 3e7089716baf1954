//! The counterparts of the report's Figures 2 to 6.

use super::figure::{Figure, Panel};
use super::plot::{end, error_panel, torque_panel};
use super::series::curve;
use crate::arm::Joint;
use crate::error::Error;
use crate::motion::Motion;
use crate::simulate::Run;

/// The runs that the figures show.
#[derive(Clone, Copy, Debug)]
pub struct Figures<'a> {
    /// The joints.
    pub joints: &'a [Joint],
    /// The desired motion.
    pub motion: &'a Motion,
    /// Law (16) with the exact model.
    pub exact: &'a Run,
    /// Law (34) with the simplified one.
    pub simplified: &'a Run,
    /// Law (34) with robust bounds on an arm that carries another load.
    pub robust: &'a Run,
    /// Law (46) on the same arm.
    pub adaptive: &'a Run,
}

/// The figures as (file name, SVG).
///
/// # Errors
/// [`Error::Internal`] where the drawing library fails.
pub fn figures(runs: &Figures) -> Result<Vec<(String, String)>, Error> {
    let nominal = [runs.exact, runs.simplified];
    let loaded = [runs.robust, runs.adaptive];
    let models = ["law (16), exact model", "law (34), simplified model"];
    let laws = ["robust, law (34)", "adaptive, law (46)"];
    let each = |panel: fn([&Run; 2], &Joint, usize) -> Panel, pair: [&Run; 2]| {
        runs.joints.iter().enumerate().map(|(i, joint)| vec![panel(pair, joint, i)]).collect()
    };
    let draw = |number: u32, title: &str, legend: [&str; 2], rows: Vec<Vec<Panel>>, pair: [&Run; 2]| {
        let title = format!("Figure {number}: {title}");
        let figure = Figure { title: &title, legend: legend.map(str::to_string), rows, end: end(pair) };
        Ok((format!("figure{number}.svg"), figure.svg()?))
    };
    Ok(vec![
        draw(2, "Trajectories", ["desired", models[1]], trajectories(runs), nominal)?,
        draw(3, "Joint torques, nominal load", models, each(torque_panel, nominal), nominal)?,
        draw(4, "Tracking errors, nominal load", models, each(error_panel, nominal), nominal)?,
        draw(5, "Joint torques, load +20 %", laws, each(torque_panel, loaded), loaded)?,
        draw(6, "Tracking errors, load +20 %", laws, each(error_panel, loaded), loaded)?,
    ])
}

/// Desired and actual position by joint.
fn trajectories(runs: &Figures) -> Vec<Vec<Panel>> {
    let trace = &runs.simplified.trace;
    let desired: Vec<Vec<f64>> = trace.time.iter().map(|&t| runs.motion.at(t).q).collect();
    let panel = |(i, joint): (usize, &Joint)| {
        let actual = desired.iter().zip(&trace.position_error).map(|(q, e)| q[i] + e[i]);
        vec![Panel {
            title: format!("{}: position", joint.name),
            y: format!("position ({})", joint.kind.position_unit()),
            curves: [curve(&trace.time, desired.iter().map(|q| q[i])), curve(&trace.time, actual)],
            logarithmic: false,
        }]
    };
    runs.joints.iter().enumerate().map(panel).collect()
}
