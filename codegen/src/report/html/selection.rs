//! Which functions the reduction takes, and what they carry.

use std::collections::BTreeSet;

use super::figure::{Axis, Bar, Bars, Figure, Panel, Role};
use super::study::Study;
use super::words::{self, counted};
use crate::domain::Measure;
use crate::emit::functions;
use crate::reduction::{Ranked, ranked};

/// Functions whose shares are shown.
const SHOWN: usize = 16;
/// The smallest share that is drawn, %.
const LEAST: f64 = 1e-4;
/// Values of functions at points that are held at once, at most.
const MOST_VALUES: usize = 20_000_000;
/// Points that are too few to rank functions by.
const FEWEST_POINTS: usize = 200;

/// The order of selection with the share of each function; outlines for what this size leaves out.
pub(super) fn figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let (lagrangian, reduced) = (generation.lagrangian(), generation.reduced());
    let mut measure = Measure::new(generation.domain(), generation.arm());
    let count = lagrangian.functions.len();
    // Shares are parts of a whole: some of the points tell them as well.
    let every = (count * measure.points.len()).div_ceil(MOST_VALUES).max(1);
    measure.points = measure.points.into_iter().step_by(every).collect();
    measure.weights = measure.weights.into_iter().step_by(every).collect();
    if measure.points.len() < FEWEST_POINTS {
        let caption = format!(
            "The exact model has {count} functions: too many to rank here. This size keeps {}.",
            kept_in_words(study)
        );
        return Figure { caption, panels: Vec::new() };
    }
    let order = ranked(lagrangian, &measure, SHOWN.min(count));
    let kept: BTreeSet<usize> = reduced.selected.iter().copied().collect();
    let all = reduced.is_exact() || reduced.simplified_arm().is_some();
    let mut sum = 0.0;
    let rows = order.iter().map(|&Ranked { function, share }| {
        sum += share;
        Bar {
            label: lagrangian.functions[function].to_string(),
            values: vec![100.0 * share],
            note: format!(
                "adds {}, together {}",
                words::percent(share, false),
                words::percent(sum.min(1.0), false)
            ),
            kept: all || kept.contains(&function),
        }
    });
    let bars = Bars {
        title: "What each function adds to those above it, in the order of selection".to_string(),
        axis: Axis::from(LEAST, "part of the mean square", "%"),
        parts: vec![("adds".to_string(), Role::Certified)],
        stacked: false,
        rows: rows.collect(),
    };
    let caption = caption(study, &order);
    Figure { caption, panels: vec![Panel::Bars(bars)] }
}

fn caption(study: &Study, order: &[Ranked]) -> String {
    let count = study.generation.lagrangian().functions.len();
    let mut sum = 0.0;
    let enough = order.iter().position(|chosen| {
        sum += chosen.share;
        sum >= 0.99
    });
    let ranked = match enough {
        Some(0) => format!("the first of {count} functions alone gives 99 % of the mean square"),
        Some(last) => format!("the first {} of {count} functions give 99 % of the mean square", last + 1),
        None => format!(
            "the first {} of {count} functions give {} of the mean square",
            order.len(),
            words::percent(sum, false)
        ),
    };
    format!(
        "Weighted by the squares of what multiplies them along the motion or within the limits, {ranked}. A function that goes along \
         with one above it adds little, also where a model uses both. The mean square says nothing of the largest error: see the bounds. \
         Bars that are only outlined are left out at this size, which keeps {}.",
        kept_in_words(study)
    )
}

/// What this size keeps.
fn kept_in_words(study: &Study) -> String {
    let generation = &study.generation;
    let (lagrangian, reduced) = (generation.lagrangian(), generation.reduced());
    let count = lagrangian.functions.len();
    if reduced.is_exact() {
        return format!("all {count}");
    }
    if let Some(simplified_arm) = reduced.simplified_arm() {
        return format!("the exact functions of a simpler arm, without {}", simplified_arm.lost());
    }
    let names = functions(lagrangian, reduced);
    let all = counted(names.len(), "function");
    if names.len() <= 6 { format!("{all}: {}", names.join(", ")) } else { all }
}
