//! The report on one specification: a page of its own, with a figure for each question and a slider over model sizes.
//!
//! Words and numbers come from here. The page's script, `page.js`, only draws: it holds no knowledge of robots. The page
//! loads nothing.

mod arm;
mod bounds;
mod closed_loop;
mod code;
mod figure;
mod gains;
mod motion;
mod operations;
mod page;
mod selection;
mod sizes;
mod study;
mod summary;
mod thin;
mod uncertainty;
mod words;

pub use study::{ReportEffort, Study};

use figure::Figure;

use crate::error::Error;

/// The report on `studies`, sizes of one specification from the loosest to the exact one, opened at number `own`.
///
/// # Errors
/// [`Error::Internal`] where there is no study of that number.
pub fn html_report(studies: &[Study], own: usize) -> Result<String, Error> {
    let first = studies.get(own).ok_or_else(|| Error::Internal("a report of no size".to_string()))?;
    let overview = sizes::figure(studies);
    let figures: Vec<Vec<Option<Figure>>> = studies.iter().map(|study| all(study, &overview)).collect();
    page::Page { name: &first.generation.spec().name, studies, own, figures: &figures }.html()
}

/// The figures of one size, in the order of [`page::SECTIONS`].
fn all(study: &Study, overview: &Figure) -> Vec<Option<Figure>> {
    vec![
        Some(summary::figure(study)),
        Some(overview.clone()),
        Some(arm::figure(study)),
        motion::motion_figure(study),
        Some(motion::domain_figure(study)),
        Some(selection::figure(study)),
        Some(bounds::figure(study)),
        Some(operations::figure(study)),
        closed_loop::funnel_figure(study),
        closed_loop::tracking_figure(study),
        closed_loop::torque_figure(study),
        closed_loop::lyapunov_figure(study),
        gains::figure(study),
        uncertainty::figure(study),
    ]
}
