//! Numbers that differ, in groups, the largest change first.

use serde::Serialize;

use super::numbers::Numbers;

/// What numbers belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// Parameters of the model.
    Parameters,
    /// What the model leaves out.
    Bounds,
    /// Gains, settings and the motion.
    Control,
    /// What is promised, and what the step rounds by.
    Guarantee,
}

/// The numbers of a group that differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The group.
    pub group: Group,
    /// Its numbers, the largest absolute change first.
    pub moved: Vec<Moved>,
}

/// A number that differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Moved {
    /// Its name.
    pub name: String,
    /// Its value in the first module; `None` where that lacks it.
    pub before: Option<f64>,
    /// Its value in the second module; `None` where that lacks it.
    pub after: Option<f64>,
}

impl Moved {
    /// How far it moved, absolute; from or to 0 where a module lacks it.
    pub fn distance(&self) -> f64 {
        (self.after.unwrap_or(0.0) - self.before.unwrap_or(0.0)).abs()
    }
}

/// The numbers that differ, group by group; groups without any are left out.
pub(super) fn parts(before: &Numbers, after: &Numbers) -> Vec<Part> {
    let mut names: Vec<&String> = before.keys().chain(after.keys()).collect();
    names.sort_unstable();
    names.dedup();
    names.retain(|name| !is_mirrored(name));
    let value = |name: &String| Moved {
        name: name.clone(),
        before: before.get(name).copied(),
        after: after.get(name).copied(),
    };
    let all: Vec<Moved> = names.into_iter().map(value).filter(|moved| moved.before != moved.after).collect();
    let groups = [Group::Parameters, Group::Bounds, Group::Control, Group::Guarantee];
    let part = |group: Group| {
        let mut moved: Vec<Moved> = all.iter().filter(|moved| of(&moved.name) == group).cloned().collect();
        // Equal distances stay in the order of their names.
        moved.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
        Part { group, moved }
    };
    groups.into_iter().map(part).filter(|part| !part.moved.is_empty()).collect()
}

/// Whether the number called `name` stands in the bounds a second time: d_ij for j < i, and h_ijk for k < j.
fn is_mirrored(name: &str) -> bool {
    let Some(entry) = name.strip_prefix("BOUNDS.") else { return false };
    let index: Vec<usize> = entry.split(['[', ']']).skip(1).filter_map(|index| index.parse().ok()).collect();
    match *index.as_slice() {
        [i, j] => entry.starts_with('d') && j < i,
        [_, j, k] => k < j,
        _ => false,
    }
}

/// The group of the number called `name`.
fn of(name: &str) -> Group {
    let constant = name.split(['.', '[', ':']).next().unwrap_or_default();
    match constant {
        _ if name.contains(": ") => Group::Parameters,
        "BOUNDS" => Group::Bounds,
        "GUARANTEE" | "PERIOD_MAX" => Group::Guarantee,
        _ if constant.starts_with("ROUNDING") => Group::Guarantee,
        _ => Group::Control,
    }
}
