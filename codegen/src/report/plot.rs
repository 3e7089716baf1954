//! One figure of a comparison: errors, torques and V over time.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::series::{curve, range, tick};
use super::{law_name, position_unit, torque_unit};
use crate::arm::{Joint, JointKind};
use crate::error::Error;
use crate::simulate::{Comparison, Run};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

// Blue and vermilion differ in lightness and to every kind of colour blindness (Okabe and Ito).
const EXACT: RGBColor = RGBColor(0, 68, 136);
const LAW: RGBColor = RGBColor(230, 120, 40);
const FRAME: RGBColor = RGBColor(90, 90, 90);
const GRID: RGBColor = RGBColor(222, 222, 222);
const FONT: &str = "sans-serif";

/// Size of the figure in its own units; SVG scales, so large numbers only make the curves smooth.
const WIDTH: u32 = 1600;
const HEADER: u32 = 165;
const ROW: u32 = 330;
/// Decades of V that are shown: below, it is the ripple of the held torque.
const DECADES: f64 = 10.0;

/// The comparison as an SVG file: a row of panels a joint, position error at the left and torque at the right, and V of
/// equation (12) below on a logarithmic axis.
///
/// # Errors
/// [`Error::Internal`] where the drawing library fails.
pub fn plot(comparison: &Comparison, joints: &[Joint]) -> Result<String, Error> {
    let mut svg = String::new();
    let rows = joints.len() as u32 + 1;
    draw(&mut svg, comparison, joints, rows)
        .map_err(|error| Error::Internal(format!("cannot draw the plot: {error}")))?;
    Ok(svg)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(svg: &mut String, comparison: &Comparison, joints: &[Joint], rows: u32) -> Drawn {
    let root = SVGBackend::with_string(svg, (WIDTH, HEADER + rows * ROW)).into_drawing_area();
    root.fill(&WHITE)?;
    let (header, body) = root.split_vertically(HEADER);
    legend(&header, comparison)?;
    let rows = body.split_evenly((rows as usize, 1));
    let last = |run: &Run| run.trace.time.last().copied().unwrap_or(0.0);
    let end = last(&comparison.exact).max(last(&comparison.law)).max(1e-6);
    let curves = |value: &dyn Fn(&Run, usize) -> f64| -> Curves {
        [&comparison.exact, &comparison.law].map(|run| {
            let time = &run.trace.time;
            curve(time, (0..time.len()).map(|k| value(run, k)))
        })
    };
    for (i, (joint, row)) in joints.iter().zip(&rows).enumerate() {
        let (left, right) = row.split_horizontally(WIDTH / 2);
        let error = curves(&|run, k| run.trace.position_error[k][i]);
        let label = format!("error ({})", position_unit(joint.kind));
        linear(&left, &Labels { title: &format!("{}: position error", joint.name), y: &label, end }, &error)?;
        let torque = curves(&|run, k| run.trace.torque[k][i]);
        let what = match joint.kind {
            JointKind::Revolute => "torque",
            JointKind::Prismatic => "force",
        };
        let unit = torque_unit(joint.kind);
        let label = format!("{what} ({unit})");
        linear(&right, &Labels { title: &format!("{}: {what}", joint.name), y: &label, end }, &torque)?;
    }
    if let Some(row) = rows.last() {
        // libm, so that the points do not depend on the platform's logarithm.
        let decades = curves(&|run, k| libm::log10(run.trace.lyapunov[k]));
        logarithmic(row, &Labels { title: "Lyapunov function V", y: "V (J)", end }, &decades)?;
    }
    root.present()?;
    Ok(())
}

/// What one panel says around its curves.
struct Labels<'a> {
    title: &'a str,
    y: &'a str,
    /// End of the time axis, s.
    end: f64,
}

/// The exact law's curve and the other's.
type Curves = [Vec<(f64, f64)>; 2];

fn linear(area: &Area, labels: &Labels, curves: &Curves) -> Drawn {
    let (low, high) = range(curves.iter().flatten());
    panel(area, labels, (low, high), (5, &|y| tick(*y, high - low)), curves)
}

fn logarithmic(area: &Area, labels: &Labels, curves: &Curves) -> Drawn {
    let heights = || curves.iter().flatten().map(|point| point.1);
    let top = libm::ceil(heights().fold(-DECADES, f64::max)) + 0.0;
    let bottom = libm::floor(heights().fold(top, f64::min)).clamp(top - DECADES, top - 1.0);
    let shown = curves.each_ref().map(|curve| curve.iter().map(|&(x, y)| (x, y.max(bottom))).collect());
    let whole =
        |y: &f64| if (y - y.round()).abs() < 1e-6 { format!("1e{}", y.round() + 0.0) } else { String::new() };
    panel(area, labels, (bottom, top), (8, &whole), &shown)
}

/// Draws both curves over the interval of heights, with about so many ticks, written so.
fn panel(
    area: &Area,
    labels: &Labels,
    (low, high): (f64, f64),
    (ticks, write_tick): (usize, &dyn Fn(&f64) -> String),
    [exact, law]: &Curves,
) -> Drawn {
    let text = |size: u32| (FONT, size).into_font().color(&BLACK);
    let mut chart = ChartBuilder::on(area)
        .caption(labels.title, text(30))
        .margin(12)
        .margin_right(30)
        .x_label_area_size(62)
        .y_label_area_size(112)
        .build_cartesian_2d(0.0..labels.end, low..high)?;
    chart
        .configure_mesh()
        .x_desc("time (s)")
        .y_desc(labels.y)
        .axis_desc_style(text(26))
        .label_style(text(24))
        .axis_style(FRAME)
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .x_labels(6)
        .y_labels(ticks)
        .x_label_formatter(&|x| tick(*x, labels.end))
        .y_label_formatter(&write_tick)
        .draw()?;
    chart.draw_series(LineSeries::new(law.iter().copied(), law_style()))?;
    // Above the other and dashed, so that both are seen where they coincide.
    chart.draw_series(DashedLineSeries::new(exact.iter().copied(), 14, 9, exact_style()))?;
    Ok(())
}

fn law_style() -> ShapeStyle {
    LAW.stroke_width(5)
}

fn exact_style() -> ShapeStyle {
    EXACT.stroke_width(3)
}

fn legend(area: &Area, comparison: &Comparison) -> Drawn {
    let title = TextStyle::from((FONT, 36).into_font()).color(&BLACK);
    area.draw_text("Closed-loop simulation of the exact arm", &title, (40, 14))?;
    let fate = |run: &Run| match run.metrics.diverged_at {
        Some(at) => format!(" (diverged at {at:.2} s)"),
        None => String::new(),
    };
    let name = law_name(comparison.law_kind, comparison.boundary_layer.is_some());
    let entry = TextStyle::from((FONT, 30).into_font()).color(&BLACK);
    // One below the other: a name with its fate may fill the line.
    let (exact, law) = (86, 130);
    let dashes = plotters::element::DashedPathElement::new([(40, exact), (130, exact)], 14, 9, exact_style());
    area.draw(&dashes)?;
    let text = format!("law (16), with the exact model{}", fate(&comparison.exact));
    area.draw_text(&text, &entry, (145, exact - 13))?;
    area.draw(&PathElement::new([(40, law), (130, law)], law_style()))?;
    let text = format!("{name}, with this model{}", fate(&comparison.law));
    area.draw_text(&text, &entry, (145, law - 13))?;
    Ok(())
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
