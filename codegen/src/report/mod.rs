//! What a person looks at: tables for the terminal and plots, as text; nothing here writes a file.

mod changes;
mod claims;
mod figure;
mod funnel;
mod grid;
mod html;
mod monte_carlo;
mod pareto;
mod plot;
mod reproduction;
mod series;
mod sizes;
mod sizes_csv;
mod table;

pub use changes::changes_text;
pub(crate) use claims::largest_difference;
pub use claims::{Claim, claims};
pub use funnel::funnel_plot;
pub use html::{ReportEffort, Study, html_report};
pub(crate) use html::{counted, worst};
pub use monte_carlo::{CertifiedErrors, monte_carlo_table};
pub use pareto::pareto_plot;
pub use plot::plot;
pub use reproduction::{Figures, figures};
pub use sizes::{size_line, sizes_table};
pub use sizes_csv::sizes_csv;
pub use table::{bounds_table, chatter_table, claims_table, metrics_table, operations_table};

use crate::spec::LawSpec;

/// A law in words.
fn law_name(law: LawSpec, boundary_layer: bool) -> &'static str {
    match (law, boundary_layer) {
        (LawSpec::Exact, _) => "law (16)",
        (LawSpec::Report, false) => "law (34), sign function",
        (LawSpec::Report, true) => "law (34), boundary layer",
        (LawSpec::Tight, false) => "tight law, sign function",
        (LawSpec::Tight, true) => "tight law, boundary layer",
        (LawSpec::Adaptive, false) => "adaptive law (46), sign function",
        (LawSpec::Adaptive, true) => "adaptive law (46), boundary layer",
    }
}
