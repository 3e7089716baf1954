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
pub(crate) use words::counted;

use figure::Figure;

use crate::error::Error;
use crate::sizes::Size;
use crate::spec::ModelSpec;

/// The report on the size of a specification, `own`, and on other sizes of it. The slider goes from the size with the largest
/// certified error to the exact one.
///
/// # Errors
/// [`Error::Internal`] where numbers cannot be written as JSON.
pub fn html_report(mut own: Study, mut others: Vec<Study>) -> Result<String, Error> {
    let name = own.generation.spec().name.clone();
    let specified = Size::of(own.generation.spec().model.clone()).label();
    own.label = format!("{specified} (specified)");
    let label = own.label.clone();
    // A tolerance within which nothing is cheaper than the exact model is the exact model.
    let twin = |study: &Study| study.row.exact && study.generation.spec().model != ModelSpec::Exact;
    let before = others.len();
    others.retain(|study| !twin(study));
    let twins = before - others.len();
    others.push(own);
    let error = |study: &Study| study.row.worst_fraction().unwrap_or(0.0);
    let total = |study: &Study| study.row.operations.total;
    // Where errors are equal, as those of all sizes that have become the exact one, the cheaper one comes last.
    others.sort_by(|a, b| error(b).total_cmp(&error(a)).then(total(b).cmp(&total(a))));
    let shown = others.iter().position(|study| study.label == label).unwrap_or(0);
    let overview = (others.len() > 1).then(|| sizes::figure(&others, twins));
    let figures: Vec<Vec<Option<Figure>>> = others.iter().map(|study| all(study, &overview)).collect();
    page::Page { name: &name, studies: &others, own: shown, figures: &figures }.html()
}

/// The figures of one size, in the order of [`page::SECTIONS`].
fn all(study: &Study, overview: &Option<Figure>) -> Vec<Option<Figure>> {
    vec![
        Some(summary::figure(study)),
        overview.clone(),
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
