//! What accuracy costs: the sizes of a sweep as points, and the front of those that no other beats.

use plotters::prelude::*;

use super::series::range;
use crate::error::Error;
use crate::number::percent;
use crate::sizes::Entry;

const SIZE: (u32, u32) = (1200, 800);
const FONT: &str = "sans-serif";
const POINT: RGBColor = RGBColor(0, 68, 136);
const FRONT: RGBColor = RGBColor(230, 120, 40);
const GRID: RGBColor = RGBColor(222, 222, 222);
/// The torque error that stands for none on the logarithmic axis, as a fraction.
const LEAST: f64 = 1e-6;

/// A point: operations, decimal logarithm of the torque error in percent, its name.
type Point = (f64, f64, String);

/// Operations of the step against the certified torque error of the worst joint as an SVG file, with the front of the sizes that no
/// other beats in both. Sizes without a torque error are not drawn.
///
/// # Errors
/// [`Error::Internal`] where the drawing library fails.
pub fn pareto_plot(entries: &[&Entry]) -> Result<String, Error> {
    let several = entries.windows(2).any(|pair| pair[0].spec != pair[1].spec);
    let point = |entry: &&Entry| {
        let row = entry.row.as_ref()?;
        let height = libm::log10(100.0 * row.worst_fraction()?.max(LEAST));
        let name = if several { format!("{} {}", entry.spec, entry.size) } else { entry.size.clone() };
        Some((row.operations.total as f64, height, name))
    };
    let mut points: Vec<Point> = entries.iter().filter_map(point).collect();
    points.sort_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(std::cmp::Ordering::Equal));
    // Where points coincide, their names stand beside each other.
    points.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 = format!("{}, {}", kept.2, next.2);
        }
        same
    });
    let mut svg = String::new();
    draw(&points, &mut svg).map_err(|error| Error::Internal(format!("cannot draw the plot: {error}")))?;
    Ok(svg)
}

/// The torque error at a height of the axis.
fn tick(height: f64) -> String {
    let least = libm::log10(100.0 * LEAST);
    if height > least + 0.5 { percent(libm::pow(10.0, height)) } else { "none".to_string() }
}

/// The points that no other beats, as a staircase.
fn front(points: &[Point]) -> Vec<(f64, f64)> {
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for &(x, y, _) in points {
        match steps.last().copied() {
            Some((_, least)) if y >= least => {}
            Some((_, least)) => steps.extend([(x, least), (x, y)]),
            None => steps.push((x, y)),
        }
    }
    steps
}

fn draw(points: &[Point], svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let flat: Vec<(f64, f64)> = points.iter().map(|(x, y, _)| (*x, *y)).collect();
    let turned: Vec<(f64, f64)> = flat.iter().map(|(x, y)| (*y, *x)).collect();
    let ((bottom, top), (left, right)) = (range(flat.iter()), range(turned.iter()));
    // The names stand at the right of their points.
    let right = right + 0.15 * (right - left);
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let text = |size: u32| (FONT, size).into_font().color(&BLACK);
    let mut chart = ChartBuilder::on(&root)
        .caption("What accuracy costs: no size beats those on the line in both", text(30))
        .margin(16)
        .x_label_area_size(60)
        .y_label_area_size(120)
        .build_cartesian_2d(left..right, bottom..top)?;
    chart
        .configure_mesh()
        .x_desc("operations of a step (a sine-cosine pair counted as 12, a clamp as 2)")
        .y_desc("certified torque error of the worst joint, of its peak")
        .axis_desc_style(text(24))
        .label_style(text(22))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| tick(*y))
        .draw()?;
    chart.draw_series(LineSeries::new(front(points), FRONT.stroke_width(4)))?;
    for (x, y, name) in points {
        let dot = EmptyElement::at((*x, *y))
            + Circle::new((0, 0), 6, POINT.filled())
            + Text::new(name.clone(), (10, -22), text(20));
        chart.plotting_area().draw(&dot)?;
    }
    root.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn the_front_leaves_out_what_another_beats() {
        let point = |x: f64, y: f64| (x, y, String::new());
        let points = [point(1.0, 3.0), point(2.0, 4.0), point(3.0, 1.0), point(4.0, 1.0)];
        assert_eq!(front(&points), [(1.0, 3.0), (3.0, 3.0), (3.0, 1.0)]);
        assert!(front(&[]).is_empty());
    }
}
