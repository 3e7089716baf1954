//! The page around the figures.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;

use super::code::Modules;
use super::figure::Figure;
use super::study::Study;
use crate::error::Error;
use crate::text::{escaped, escaped_json};

/// Of each figure, in order: its identifier, its heading and its name in the list of links.
pub(super) const SECTIONS: [(&str, &str, &str); 14] = [
    ("summary", "At a glance", "Glance"),
    ("sizes", "Model sizes", "Sizes"),
    ("arm", "The arm", "Arm"),
    ("motion", "The motion", "Motion"),
    ("domain", "Where the bounds hold", "Domain"),
    ("functions", "Which functions matter", "Functions"),
    ("bounds", "What the model leaves out", "Bounds"),
    ("operations", "What a step costs", "Cost"),
    ("funnel", "Error funnel", "Funnel"),
    ("tracking", "Tracking", "Tracking"),
    ("torques", "Torques", "Torques"),
    ("lyapunov", "Lyapunov function", "V"),
    ("gains", "Gains and period", "Gains"),
    ("uncertainty", "Uncertainty", "Uncertainty"),
];

const STYLE: &str = include_str!("page.css");
/// The parts of the script, in order.
const SCRIPT: [&str; 9] = [
    include_str!("script/elements.js"),
    include_str!("script/numbers.js"),
    include_str!("script/cursor.js"),
    include_str!("script/lines.js"),
    include_str!("script/bars.js"),
    include_str!("script/arm.js"),
    include_str!("script/figures.js"),
    include_str!("script/difference.js"),
    include_str!("script/slider.js"),
];

/// Forbids the page to load anything.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'";

/// All that a page is made of.
pub(super) struct Page<'a> {
    /// Name of the specification.
    pub name: &'a str,
    /// The sizes.
    pub studies: &'a [Study],
    /// The one that is shown first.
    pub own: usize,
    /// By size its figures, in the order of [`SECTIONS`].
    pub figures: &'a [Vec<Option<Figure>>],
}

/// What the script reads.
#[derive(Serialize)]
struct Data<'a> {
    name: &'a str,
    own: usize,
    sizes: Vec<SizeData<'a>>,
    #[serde(flatten)]
    code: Modules,
}

#[derive(Serialize)]
struct SizeData<'a> {
    label: &'a str,
    /// By section the number of its figure.
    figures: BTreeMap<&'static str, usize>,
}

impl Page<'_> {
    /// As HTML.
    ///
    /// # Errors
    /// [`Error::Internal`] where the numbers cannot be written as JSON.
    pub(super) fn html(&self) -> Result<String, Error> {
        let (data, first) = (self.data()?, self.figures.get(self.own).map_or(&[][..], Vec::as_slice));
        let mut out = String::new();
        self.head(&mut out);
        self.bar(&mut out, first);
        out += "<main id=\"main\">\n";
        for ((id, heading, _), figure) in SECTIONS.iter().zip(first) {
            if let Some(figure) = figure {
                section(&mut out, id, heading, &figure.caption);
            }
        }
        code(&mut out);
        out += "</main>\n<footer>\n<p>Made by Gramforge ";
        out += env!("CARGO_PKG_VERSION");
        out += ". This page holds all of its data and loads nothing.</p>\n";
        out += "<noscript><p>The pictures need scripts to be allowed. The words under them do not.</p></noscript>\n</footer>\n";
        out += "<div id=\"tip\" aria-hidden=\"true\" hidden></div>\n";
        let _ = writeln!(out, "<script type=\"application/json\" id=\"data\">{data}</script>");
        let script = SCRIPT.join("\n");
        let _ = write!(out, "<script>\n\"use strict\";\n(() => {{\n{script}}})();\n</script>\n");
        out += "</body>\n</html>\n";
        Ok(out)
    }

    fn head(&self, out: &mut String) {
        let name = html(self.name);
        let _ = write!(
            out,
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n\
             <title>{name}: Gramforge report</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n{STYLE}</style>\n</head>\n\
             <body>\n<a class=\"skip\" href=\"#main\">Skip to the figures</a>\n<header>\n\
             <svg class=\"mark\" viewBox=\"0 0 40 40\" aria-hidden=\"true\"><path d=\"M8 36h12M14 36V22L30 12l6 8\"></path>\
             <circle cx=\"14\" cy=\"22\" r=\"3\"></circle><circle cx=\"30\" cy=\"12\" r=\"3\"></circle></svg>\n\
             <div><h1>{name}</h1>\n<p>{}</p></div>\n</header>\n",
            html(&self.lead())
        );
    }

    /// What the page is about, in a sentence or two.
    fn lead(&self) -> String {
        let joints = self.studies.first().map_or(0, |study| study.generation.arm().dof());
        let sizes = match self.studies.len() {
            1 => String::new(),
            count => format!(" The slider shows {count} sizes of its model."),
        };
        format!(
            "What Gramforge has made of this specification of an arm with {joints} joints, and why.{sizes}"
        )
    }

    /// The links to the figures and the slider.
    fn bar(&self, out: &mut String, first: &[Option<Figure>]) {
        out.push_str("<div class=\"bar\">\n");
        let last = self.studies.len().saturating_sub(1);
        if last > 0 {
            let label = self.studies.get(self.own).map_or("", |study| study.label.as_str());
            let _ = write!(
                out,
                "<section class=\"size\" aria-label=\"Model size\">\n<label for=\"size\">Model size</label>\n\
                 <input type=\"range\" id=\"size\" min=\"0\" max=\"{last}\" step=\"1\" value=\"{}\">\n\
                 <output id=\"size-name\" for=\"size\">{}</output>\n</section>\n",
                self.own,
                html(label)
            );
        }
        out.push_str("<nav aria-label=\"Figures\">\n<ul>\n");
        let shown =
            SECTIONS.iter().zip(first).filter(|(_, figure)| figure.is_some()).map(|(section, _)| *section);
        for (id, _, name) in shown.chain([("code", "Code", "Code")]) {
            let _ = writeln!(out, "<li><a href=\"#{id}\">{name}</a></li>");
        }
        out.push_str("</ul>\n</nav>\n</div>\n");
    }

    /// The JSON that stands in the page.
    fn data(&self) -> Result<String, Error> {
        let defect = |error: serde_json::Error| Error::Internal(error.to_string());
        // Every different figure once.
        let mut pool: Vec<String> = Vec::new();
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        let mut sizes = Vec::new();
        for (study, figures) in self.studies.iter().zip(self.figures) {
            let mut numbers = BTreeMap::new();
            for ((id, ..), figure) in SECTIONS.iter().zip(figures) {
                let Some(figure) = figure else { continue };
                let text = serde_json::to_string(figure).map_err(defect)?;
                let number = match known.get(&text) {
                    Some(number) => *number,
                    None => {
                        pool.push(text.clone());
                        known.insert(text, pool.len() - 1);
                        pool.len() - 1
                    }
                };
                numbers.insert(*id, number);
            }
            sizes.push(SizeData { label: &study.label, figures: numbers });
        }
        let data = Data { name: self.name, own: self.own, sizes, code: Modules::new(self.studies) };
        let text = serde_json::to_string(&data).map_err(defect)?;
        let text =
            format!("{{\"figures\":[{}],{}", pool.join(","), text.strip_prefix('{').unwrap_or_default());
        // Nothing in a script may look like markup.
        Ok(escaped_json(&text).replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026"))
    }
}

fn section(out: &mut String, id: &str, heading: &str, caption: &str) {
    let _ = write!(
        out,
        "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n<h2 id=\"{id}-heading\">{heading}</h2>\n\
         <figure data-figure=\"{id}\">\n<div class=\"panels\"></div>\n<figcaption>{}</figcaption>\n</figure>\n</section>\n",
        html(caption)
    );
}

/// Where the script shows what differs between the modules of two sizes.
fn code(out: &mut String) {
    out.push_str(
        "<section id=\"code\" aria-labelledby=\"code-heading\">\n<h2 id=\"code-heading\">Code</h2>\n\
         <figure>\n<div id=\"difference\"></div>\n<figcaption>The module of this size, or what differs from that of another size. \
         Names stay the same from size to size, so what shows is what a size adds, leaves out or computes in another way.</figcaption>\n\
         </figure>\n</section>\n",
    );
}

/// `text` as HTML shows it, hidden characters escaped.
fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in escaped(text).to_string().chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\'' => out += "&#39;",
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::html;

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(html("<b a=\"'\">&\u{202e}\n"), "&lt;b a=&quot;&#39;&quot;&gt;&amp;\\u{202e}\\n");
    }
}
