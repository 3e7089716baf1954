//! One figure of a comparison: errors, torques and V over time.

use super::figure::{Curves, Figure, Panel};
use super::law_name;
use super::series::curve;
use crate::arm::{Joint, JointKind};
use crate::error::Error;
use crate::simulate::{Comparison, Run};

/// The comparison as an SVG file: a row of panels a joint, position error at the left and torque at the right, and V of
/// equation (12) below on a logarithmic axis.
///
/// # Errors
/// [`Error::Internal`] where the drawing library fails.
pub fn plot(comparison: &Comparison, joints: &[Joint]) -> Result<String, Error> {
    let runs = [&comparison.exact, &comparison.law];
    let mut rows: Vec<Vec<Panel>> = joints
        .iter()
        .enumerate()
        .map(|(i, joint)| vec![error_panel(runs, joint, i), torque_panel(runs, joint, i)])
        .collect();
    // libm, so that the points do not depend on the platform's logarithm.
    let curves = curves(runs, &|run, k| libm::log10(run.trace.lyapunov[k]));
    let (title, y) = ("Lyapunov function V".to_string(), "V (J)".to_string());
    rows.push(vec![Panel { title, y, curves, logarithmic: true }]);
    let fate = |run: &Run| match run.metrics.diverged_at {
        Some(at) => format!(" (diverged at {at:.2} s)"),
        None => String::new(),
    };
    let name = law_name(comparison.law_kind, comparison.boundary_layer.is_some());
    let figure = Figure {
        title: "Closed-loop simulation of the exact arm",
        legend: [
            format!("law (16), with the exact model{}", fate(&comparison.exact)),
            format!("{name}, with this model{}", fate(&comparison.law)),
        ],
        rows,
        end: end(runs),
    };
    figure.svg()
}

/// The last instant of two runs, s.
pub(super) fn end(runs: [&Run; 2]) -> f64 {
    let last = |run: &Run| run.trace.time.last().copied().unwrap_or(0.0);
    last(runs[0]).max(last(runs[1])).max(1e-6)
}

/// What two runs say of their instants.
pub(super) fn curves(runs: [&Run; 2], value: &dyn Fn(&Run, usize) -> f64) -> Curves {
    runs.map(|run| {
        let time = &run.trace.time;
        curve(time, (0..time.len()).map(|k| value(run, k)))
    })
}

/// The position error of joint number `i` in two runs.
pub(super) fn error_panel(runs: [&Run; 2], joint: &Joint, i: usize) -> Panel {
    Panel {
        title: format!("{}: position error", joint.name),
        y: format!("error ({})", joint.kind.position_unit()),
        curves: curves(runs, &|run, k| run.trace.position_error[k][i]),
        logarithmic: false,
    }
}

/// The torque of joint number `i` in two runs.
pub(super) fn torque_panel(runs: [&Run; 2], joint: &Joint, i: usize) -> Panel {
    let what = match joint.kind {
        JointKind::Revolute => "torque",
        JointKind::Prismatic => "force",
    };
    Panel {
        title: format!("{}: {what}", joint.name),
        y: format!("{what} ({})", joint.kind.torque_unit()),
        curves: curves(runs, &|run, k| run.trace.torque[k][i]),
        logarithmic: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::example::Example;

    #[test]
    fn all_panels_are_there_and_the_bytes_are_the_same() {
        let example = Example::three_link(Some(2), None);
        let draw = || plot(&example.simulate().unwrap(), &example.arm.joints).unwrap();
        let svg = draw();
        assert_eq!(svg, draw());
        for text in ["joint3: torque", "torque (N·m)", "error (rad)", "V (J)", "time (s)", "law (34)"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(!svg.contains("NaN") && svg.len() < 400_000, "{}", svg.len());
    }

    #[test]
    fn a_run_that_broke_off_can_be_drawn() {
        let example = Example::three_link(Some(2), None);
        let mut comparison = example.simulate().unwrap();
        let trace = &mut comparison.law.trace;
        trace.time.truncate(1);
        trace.lyapunov[0] = 0.0;
        comparison.law.metrics.diverged_at = Some(0.01);
        let svg = plot(&comparison, &example.arm.joints).unwrap();
        assert!(svg.contains("diverged at 0.01 s"));
        comparison.exact.trace.time.clear();
        comparison.law.trace.time.clear();
        assert!(plot(&comparison, &example.arm.joints).is_ok());
    }
}
