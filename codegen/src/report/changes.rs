//! What differs between two modules, in words.

use super::grid::Grid;
use crate::bounds::printed_up;
use crate::changes::{Changes, Group, Moved, Part};
use crate::number::{percent, scientific, short};

/// Numbers of a group that are shown.
const SHOWN: usize = 10;
/// Most characters of a number's name.
const NAME: usize = 34;

/// The differences: functions, costs and promises, the numbers that moved most, then the texts.
pub fn changes_text(changes: &Changes) -> String {
    if !changes.differ {
        return "The modules are the same, byte for byte.\n".to_string();
    }
    let mut out = functions(changes);
    out += &overview(changes);
    out += &by_joint("Certified torque error by joint (N·m or N)", &changes.torque_error);
    out += &by_joint("Largest switching gain by joint (N·m or N)", &changes.switching_gain);
    out.extend(changes.numbers.iter().map(numbers));
    out + "\n" + &changes.source
}

fn functions(changes: &Changes) -> String {
    let line = |sign: char, (name, share): &(String, f64)| {
        format!("{sign} ψ {name}, {} of the model's mean square\n", percent(100.0 * share))
    };
    let removed = changes.psi_removed.iter().map(|psi| line('-', psi));
    let lines: String = removed.chain(changes.psi_added.iter().map(|psi| line('+', psi))).collect();
    if lines.is_empty() { "The same functions ψ are kept.\n".to_string() } else { lines }
}

fn overview(changes: &Changes) -> String {
    let [before, after] = changes.operations;
    let mut grid = Grid::new(["", "before", "after"]);
    let mut row = |what: &str, cells: [String; 2]| grid.push([what.to_string()].into_iter().chain(cells));
    row("form", changes.forms.clone());
    row("operations of the step", changes.cost.map(|cost| cost.to_string()));
    let both = [before, after];
    row("multiplications", both.map(|count| (count.mul + count.fused).to_string()));
    row("additions", both.map(|count| count.add.to_string()));
    row("sine-cosine pairs", both.map(|count| count.trig_pairs.to_string()));
    row("guarantee", changes.guarantee.clone().map(|kind| kind.unwrap_or("-".to_string())));
    format!("\n{}", grid.render())
}

/// Two vectors side by side, where there is one; none where they are the same.
fn by_joint(title: &str, both: &[Option<Vec<f64>>; 2]) -> String {
    if both[0] == both[1] {
        return String::new();
    }
    let joints = both.iter().flatten().map(Vec::len).max().unwrap_or(0);
    let mut grid = Grid::new(["joint", "before", "after"]);
    for i in 0..joints {
        let cell = |values: &Option<Vec<f64>>| {
            values.as_ref().and_then(|x| x.get(i)).map_or("-".to_string(), |x| printed_up(*x))
        };
        grid.push([(i + 1).to_string(), cell(&both[0]), cell(&both[1])]);
    }
    format!("\n{title}\n\n{}", grid.render())
}

fn numbers(part: &Part) -> String {
    let what = match part.group {
        Group::Parameters => "Parameters of the model",
        Group::Bounds => "Bounds",
        Group::Control => "Gains, settings and motion",
        Group::Guarantee => "Guarantee",
    };
    let mut grid = Grid::new(["number", "before", "after"]);
    // As the module has them: a bound that is rounded to the wrong side is no bound.
    let shown = if matches!(part.group, Group::Bounds | Group::Guarantee) { scientific } else { short };
    let cell = |value: Option<f64>| value.map_or("-".to_string(), shown);
    for Moved { name, before, after } in part.moved.iter().take(SHOWN) {
        let name = match name.chars().count() <= NAME {
            true => name.clone(),
            false => name.chars().take(NAME - 1).chain(['…']).collect(),
        };
        grid.push([name, cell(*before), cell(*after)]);
    }
    let more = match part.moved.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("and {more} more with smaller changes\n"),
    };
    format!("\n{what}: {} moved, the largest change first\n\n{}{more}", part.moved.len(), grid.render())
}
