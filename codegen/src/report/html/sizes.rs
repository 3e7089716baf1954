//! All sizes beside one another.

use super::figure::{Axis, Dot, Figure, Lines, Panel, Role, Series, Table, drawn_up};
use super::study::Study;
use super::words::{self, counted};

/// The smallest error that is drawn, % of the peak torque: what is below it is as good as exact.
pub(super) const LEAST: f64 = 1e-4;

/// Cost and error of every size, as dots and as a table; the same for all sizes. `twins` sizes are left out, since they came out the
/// same as one of these.
pub(super) fn figure(studies: &[Study], twins: usize) -> Figure {
    let mut panels = vec![Panel::Dots {
        title: "Torque error against cost".to_string(),
        x: Axis::linear("weighted operations of a step", ""),
        y: Axis::from(LEAST, "part of the peak torque", "%"),
        dots: studies.iter().map(dot).collect(),
    }];
    panels.extend(by_functions(studies).map(Panel::Lines));
    panels.push(Panel::Table(table(studies)));
    let twins = match twins {
        0 => String::new(),
        count => format!(
            " {} that came out the same as one of these {} left out.",
            counted(count, "size"),
            if count == 1 { "is" } else { "are" }
        ),
    };
    let caption = format!(
        "Each dot is a model size; left and low is good. A size with another one both to its left and below it is never worth taking. \
         {}{twins}",
        cheapest(studies)
    );
    Figure { caption, panels }
}

fn dot(study: &Study) -> Dot {
    let row = &study.row;
    Dot {
        label: study.label.clone(),
        x: row.operations.total as f64,
        certified: row.worst_fraction().map(|error| drawn_up(100.0 * error)),
        found: study.worst_found().map(|error| 100.0 * error),
    }
}

/// The certified and the largest found error of the sizes that keep so many functions, against their number.
fn by_functions(studies: &[Study]) -> Option<Lines> {
    let mut own: Vec<(f64, &Study)> =
        studies.iter().filter_map(|study| Some((study.functions()? as f64, study))).collect();
    own.sort_by(|a, b| a.0.total_cmp(&b.0));
    let points = |error: &dyn Fn(&Study) -> Option<f64>| -> Vec<(f64, f64)> {
        own.iter().filter_map(|(count, study)| Some((*count, 100.0 * error(study)?))).collect()
    };
    let certified = points(&|study| study.row.worst_fraction().map(drawn_up));
    let found = points(&|study| study.worst_found());
    (certified.len() > 1).then(|| Lines {
        title: "Torque error against the number of functions".to_string(),
        x: Axis::logarithmic("functions kept, ξ", ""),
        y: Axis::from(LEAST, "part of the peak torque", "%"),
        series: vec![
            Series::curve("certified bound", Role::Certified, certified),
            Series::curve("largest found by search", Role::Found, found),
        ],
    })
}

fn cheapest(studies: &[Study]) -> String {
    let total = |study: &&Study| study.row.operations.total;
    let exact = studies.iter().find(|study| study.row.exact).map(|study| total(&study));
    match (studies.iter().min_by_key(total), exact) {
        (Some(least), Some(exact)) if total(&least) < exact => format!(
            "The cheapest size here, {}, takes {} operations instead of the exact model's {exact}.",
            least.label,
            total(&least)
        ),
        (_, Some(_)) => "No size here is cheaper than the exact model: take the exact one.".to_string(),
        _ => String::new(),
    }
}

fn table(studies: &[Study]) -> Table {
    let head = ["size", "functions", "operations", "certified error", "found error", "guarantee", "module"];
    let mut table = Table::new("All sizes", head);
    for study in studies {
        let row = &study.row;
        let part = |x: Option<f64>, up: bool| x.map_or("–".to_string(), |x| words::percent(x, up));
        table.rows.push(vec![
            study.label.clone(),
            match row.functions {
                _ if row.exact => "all".to_string(),
                // A simpler arm in place of functions.
                0 => "–".to_string(),
                functions => functions.to_string(),
            },
            row.operations.total.to_string(),
            part(row.worst_fraction(), true),
            part(study.worst_found(), false),
            row.guarantee.as_ref().map_or("not sought", |promise| promise.kind.as_str()).to_string(),
            format!("{} kB", words::plain(row.bytes as f64 / 1e3)),
        ]);
    }
    table
}
