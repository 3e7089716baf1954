//! What a figure of the report holds: words and numbers that the script of the page draws.

use serde::{Serialize, Serializer};

use crate::bounds::six_digits_up;

/// Digits of a curve's numbers: those to which bounds are rounded up.
const DIGITS: usize = 6;

/// One figure for one size of the model.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Figure {
    /// What to conclude, in words; plain text.
    pub caption: String,
    /// What is drawn, in order.
    pub panels: Vec<Panel>,
}

/// One drawing, or a table.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub(super) enum Panel {
    /// Numbers with a name each.
    Tiles {
        /// The numbers.
        tiles: Vec<Tile>,
    },
    /// Curves over one axis.
    Lines(Lines),
    /// Horizontal bars.
    Bars(Bars),
    /// The arm at some instants.
    Arm(Poses),
    /// The sizes, each a dot.
    Dots {
        /// Heading of the panel.
        title: String,
        /// The axis across.
        x: Axis,
        /// The axis up.
        y: Axis,
        /// One for each size, in order.
        dots: Vec<Dot>,
    },
    /// A table.
    Table(Table),
}

/// A number with its name.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tile {
    /// What it is.
    pub name: &'static str,
    /// The number with its unit.
    pub value: String,
    /// What it is compared with; may be empty.
    pub note: String,
}

/// An axis.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Axis {
    /// What it counts.
    pub name: &'static str,
    /// In which unit; empty for plain numbers.
    pub unit: &'static str,
    /// Whether it is logarithmic.
    pub logarithmic: bool,
    /// What smaller numbers are drawn as, on a logarithmic axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least: Option<f64>,
}

impl Axis {
    /// Time in seconds.
    pub(super) const TIME: Self = Self { name: "time", unit: "s", logarithmic: false, least: None };

    /// A linear axis.
    pub(super) fn linear(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit, logarithmic: false, least: None }
    }

    /// A logarithmic axis.
    pub(super) fn logarithmic(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit, logarithmic: true, least: None }
    }
}

impl Axis {
    /// A logarithmic axis on which a number below `least` is drawn as that.
    pub(super) fn from(least: f64, name: &'static str, unit: &'static str) -> Self {
        Self { least: Some(least), ..Self::logarithmic(name, unit) }
    }
}

/// Curves over one axis.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Lines {
    /// Heading of the panel.
    pub title: String,
    /// The axis across.
    pub x: Axis,
    /// The axis up.
    pub y: Axis,
    /// The curves; the first is drawn first.
    pub series: Vec<Series>,
}

/// How a curve or bar is drawn; the style sheet gives each a colour and a dash of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Role {
    /// A certified bound.
    Certified,
    /// What runs or samples have found, or what the law of the specification does.
    Found,
    /// The exact model.
    Exact,
    /// The desired motion.
    Desired,
    /// A limit of a joint or a domain.
    Limit,
    /// The joint of this number, from 0.
    #[serde(untagged)]
    Joint(usize),
}

/// One curve, or the band between two.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Series {
    /// What it shows.
    pub name: String,
    /// How it is drawn.
    pub role: Role,
    /// Places across.
    #[serde(serialize_with = "short_numbers")]
    pub x: Vec<f64>,
    /// Heights.
    #[serde(serialize_with = "short_numbers")]
    pub y: Vec<f64>,
    /// Heights of the lower edge of a band; empty for a curve.
    #[serde(serialize_with = "short_numbers", skip_serializing_if = "Vec::is_empty")]
    pub low: Vec<f64>,
}

impl Series {
    /// A curve.
    pub(super) fn curve(name: impl Into<String>, role: Role, points: Vec<(f64, f64)>) -> Self {
        let (x, y) = points.into_iter().unzip();
        Self { name: name.into(), role, x, y, low: Vec::new() }
    }

    /// A level from `x[0]` to `x[1]`.
    pub(super) fn level(name: impl Into<String>, role: Role, x: [f64; 2], y: f64) -> Self {
        Self::curve(name, role, x.iter().map(|&x| (x, y)).collect())
    }

    /// The band between two levels.
    pub(super) fn between(name: impl Into<String>, role: Role, x: [f64; 2], [low, high]: [f64; 2]) -> Self {
        Self { name: name.into(), role, x: x.to_vec(), y: vec![high; 2], low: vec![low; 2] }
    }
}

/// Horizontal bars.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Bars {
    /// Heading of the panel.
    pub title: String,
    /// What the bars count.
    pub axis: Axis,
    /// What the parts of each bar are, with how they are drawn.
    pub parts: Vec<(String, Role)>,
    /// Whether the parts of a bar stand behind one another; otherwise one below the other.
    pub stacked: bool,
    /// The bars: label, and one number for each part.
    pub rows: Vec<Bar>,
}

/// One bar.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Bar {
    /// Its name.
    pub label: String,
    /// A number for each part.
    #[serde(serialize_with = "short_numbers")]
    pub values: Vec<f64>,
    /// Words at its end, in place of the numbers.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// False for what this size of the model leaves out: drawn as an outline.
    pub kept: bool,
}

/// One size among all.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Dot {
    /// Name of the size.
    pub label: String,
    /// Its cost.
    pub x: f64,
    /// Its certified error; `None` where it is not known.
    pub certified: Option<f64>,
    /// Its largest error that was found.
    pub found: Option<f64>,
}

impl Bar {
    pub(super) fn new(label: impl Into<String>, values: Vec<f64>) -> Self {
        Self { label: label.into(), values, note: String::new(), kept: true }
    }
}

/// The arm at some instants.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Poses {
    /// Heading of the panel.
    pub title: String,
    /// Instants, s; without a motion numbers of positions.
    #[serde(serialize_with = "short_numbers")]
    pub time: Vec<f64>,
    /// By instant the corners of the line from base to tip, m, in the base frame: x, y, z, x, ….
    pub corners: Vec<Coordinates>,
    /// Which of the corners are joints, by index.
    pub joints: Vec<usize>,
    /// Which instants are drawn all the time, by index.
    pub key: Vec<usize>,
    /// Direction that hangs up, against gravity: index of the axis of the base frame.
    pub up: usize,
}

/// A list of coordinates, m.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub(super) struct Coordinates(#[serde(serialize_with = "short_numbers")] pub Vec<f64>);

/// A table.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Table {
    /// Heading.
    pub title: String,
    /// Headings of the columns.
    pub head: Vec<String>,
    /// Rows; their first cells are headings.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new<S: Into<String>>(title: &str, head: impl IntoIterator<Item = S>) -> Self {
        Self { title: title.to_string(), head: head.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }
}

/// Writes numbers with [`DIGITS`] digits, and `null` for what is none.
fn short_numbers<S: Serializer>(numbers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let short = |x: &f64| format!("{x:.*e}", DIGITS - 1).parse::<f64>().ok().filter(|x| x.is_finite());
    serializer.collect_seq(numbers.iter().map(short))
}

/// A bound as it is drawn: never below.
pub(super) fn drawn_up(x: f64) -> f64 {
    six_digits_up(x)
}
