//! The report on one specification: a page of its own, with a figure for each question and a slider over model sizes.
//!
//! Words and numbers come from here. The page's script, in `script/`, only draws: it holds no knowledge of robots. The page
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
pub(crate) use words::{counted, worst};

use figure::Figure;

use crate::error::Error;
use crate::sizes::Size;
use crate::spec::ModelSpec;

/// The report on the size of a specification, `own`, and on other sizes of it. The slider goes from the size with the largest
/// certified error to the exact one. Gives the page and the number of sizes on it: those that come out the same count once.
///
/// # Errors
/// [`Error::Internal`] where numbers cannot be written as JSON.
pub fn html_report(mut own: Study, mut others: Vec<Study>) -> Result<(String, usize), Error> {
    let name = own.generation.spec().name.clone();
    let specified = Size::of(own.generation.spec().model.clone()).label();
    own.label = format!("{specified} (specified)");
    let label = own.label.clone();
    others.push(own);
    let before = others.len();
    let mut others = distinct(others, &label);
    let twins = before - others.len();
    let error = |study: &Study| study.row.worst_fraction().unwrap_or(0.0);
    let total = |study: &Study| study.row.operations.total;
    // Where errors are equal, as those of all sizes that have become the exact one, the cheaper one comes last.
    others.sort_by(|a, b| error(b).total_cmp(&error(a)).then(total(b).cmp(&total(a))));
    let shown = others.iter().position(|study| study.label == label).unwrap_or(0);
    let overview = (others.len() > 1).then(|| sizes::figure(&others, twins));
    let figures: Vec<Vec<Option<Figure>>> = others.iter().map(|study| all(study, &overview)).collect();
    let page = page::Page { name: &name, studies: &others, own: shown, figures: &figures }.html()?;
    Ok((page, others.len()))
}

/// The studies without those that come out as another one: the exact model for a tolerance within which nothing is cheaper, the
/// same functions where more are not independent. The one that is called `own` stays.
fn distinct(studies: Vec<Study>, own: &str) -> Vec<Study> {
    let same = |a: &Study, b: &Study| {
        let (a, b) = (&a.row, &b.row);
        (a.operations, &a.torque_error, a.gain) == (b.operations, &b.torque_error, b.gain)
    };
    // Of equal ones the specification's own stays, then the exact one, then the one with the fewest functions.
    let place = |study: &Study| {
        let exact = study.generation.spec().model == ModelSpec::Exact;
        (study.label != own, !exact, study.functions().unwrap_or(usize::MAX))
    };
    let mut sorted = studies;
    sorted.sort_by_key(|study| place(study));
    let mut out: Vec<Study> = Vec::with_capacity(sorted.len());
    for study in sorted {
        if !out.iter().any(|kept| same(kept, &study)) {
            out.push(study);
        }
    }
    out
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
