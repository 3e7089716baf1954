//! Figures: panels of two curves over time under one legend.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::series::{range, tick};
use crate::error::Error;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

// Blue and vermilion differ in lightness and to every kind of colour blindness (Okabe and Ito).
const FIRST: RGBColor = RGBColor(0, 68, 136);
const SECOND: RGBColor = RGBColor(230, 120, 40);
const FRAME: RGBColor = RGBColor(90, 90, 90);
const GRID: RGBColor = RGBColor(222, 222, 222);
const FONT: &str = "sans-serif";

/// Size of the figure in its own units; SVG scales, so large numbers only make the curves smooth.
const WIDTH: u32 = 1600;
const HEADER: u32 = 165;
const ROW: u32 = 330;
/// Decades that a logarithmic panel shows.
const DECADES: f64 = 10.0;

/// The dashed curve and the solid one.
pub(super) type Curves = [Vec<(f64, f64)>; 2];

/// One panel.
pub(super) struct Panel {
    pub title: String,
    pub y: String,
    /// Over time; of a logarithmic panel the decimal logarithms.
    pub curves: Curves,
    pub logarithmic: bool,
}

/// A figure: its title, what the dashed and the solid curves are, and rows of panels.
pub(super) struct Figure<'a> {
    pub title: &'a str,
    pub legend: [String; 2],
    pub rows: Vec<Vec<Panel>>,
    /// End of the time axis, s.
    pub end: f64,
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

impl Figure<'_> {
    /// As an SVG file.
    ///
    /// # Errors
    /// [`Error::Internal`] where the drawing library fails.
    pub fn svg(&self) -> Result<String, Error> {
        let mut svg = String::new();
        self.draw(&mut svg).map_err(|error| Error::Internal(format!("cannot draw the plot: {error}")))?;
        Ok(svg)
    }

    fn draw(&self, svg: &mut String) -> Drawn {
        let count = self.rows.len() as u32;
        let root = SVGBackend::with_string(svg, (WIDTH, HEADER + count * ROW)).into_drawing_area();
        root.fill(&WHITE)?;
        let (header, body) = root.split_vertically(HEADER);
        self.heading(&header)?;
        for (panels, area) in self.rows.iter().zip(body.split_evenly((self.rows.len(), 1))) {
            for (panel, area) in panels.iter().zip(area.split_evenly((1, panels.len()))) {
                if panel.logarithmic { self.logarithmic(&area, panel)? } else { self.linear(&area, panel)? }
            }
        }
        root.present()?;
        Ok(())
    }

    fn linear(&self, area: &Area, panel: &Panel) -> Drawn {
        let (low, high) = range(panel.curves.iter().flatten());
        self.panel(area, panel, (low, high), (5, &|y| tick(*y, high - low)), &panel.curves)
    }

    fn logarithmic(&self, area: &Area, panel: &Panel) -> Drawn {
        let heights = || panel.curves.iter().flatten().map(|point| point.1);
        let top = libm::ceil(heights().fold(-DECADES, f64::max)) + 0.0;
        let bottom = libm::floor(heights().fold(top, f64::min)).clamp(top - DECADES, top - 1.0);
        let shown =
            panel.curves.each_ref().map(|curve| curve.iter().map(|&(x, y)| (x, y.max(bottom))).collect());
        let whole = |y: &f64| {
            if (y - y.round()).abs() < 1e-6 { format!("1e{}", y.round() + 0.0) } else { String::new() }
        };
        self.panel(area, panel, (bottom, top), (8, &whole), &shown)
    }

    /// Draws both curves over the interval of heights, with about so many ticks, written so.
    fn panel(
        &self,
        area: &Area,
        panel: &Panel,
        (low, high): (f64, f64),
        (ticks, write_tick): (usize, &dyn Fn(&f64) -> String),
        [dashed, solid]: &Curves,
    ) -> Drawn {
        let text = |size: u32| (FONT, size).into_font().color(&BLACK);
        let mut chart = ChartBuilder::on(area)
            .caption(&panel.title, text(30))
            .margin(12)
            .margin_right(30)
            .x_label_area_size(62)
            .y_label_area_size(112)
            .build_cartesian_2d(0.0..self.end, low..high)?;
        chart
            .configure_mesh()
            .x_desc("time (s)")
            .y_desc(&panel.y)
            .axis_desc_style(text(26))
            .label_style(text(24))
            .axis_style(FRAME)
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .x_labels(6)
            .y_labels(ticks)
            .x_label_formatter(&|x| tick(*x, self.end))
            .y_label_formatter(&write_tick)
            .draw()?;
        chart.draw_series(LineSeries::new(solid.iter().copied(), solid_style()))?;
        // Above the other and dashed, so that both are seen where they coincide.
        chart.draw_series(DashedLineSeries::new(dashed.iter().copied(), 14, 9, dashed_style()))?;
        Ok(())
    }

    fn heading(&self, area: &Area) -> Drawn {
        let title = TextStyle::from((FONT, 36).into_font()).color(&BLACK);
        area.draw_text(self.title, &title, (40, 14))?;
        let entry = TextStyle::from((FONT, 30).into_font()).color(&BLACK);
        let [first, second] = &self.legend;
        // One below the other: a name with its fate may fill the line.
        let (upper, lower) = (86, 130);
        let dashes =
            plotters::element::DashedPathElement::new([(40, upper), (130, upper)], 14, 9, dashed_style());
        area.draw(&dashes)?;
        area.draw_text(first, &entry, (145, upper - 13))?;
        area.draw(&PathElement::new([(40, lower), (130, lower)], solid_style()))?;
        area.draw_text(second, &entry, (145, lower - 13))?;
        Ok(())
    }
}

fn solid_style() -> ShapeStyle {
    SECOND.stroke_width(5)
}

fn dashed_style() -> ShapeStyle {
    FIRST.stroke_width(3)
}
