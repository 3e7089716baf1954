//! The cheapest of the recursion's ways for one arm.

use super::super::coupled::coupled;
use super::build;
use super::choice::{Choice, neighbours};
use super::pass::Pass;
use super::wrench::Units;
use crate::arm::{Arm, JointKind, Origin};
use crate::graph::{Builder, Graph};

/// A way to compute the recursion, found for one arm and good for any other with the same joints.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plan {
    choices: Vec<Choice>,
    units: Units,
}

const METRES: Units = Units { acceleration: 1.0, force: 1.0 };

/// The recursion with the fewest operations that a descent finds: link by link, one choice at a time, until none pays.
pub fn recursive(arm: &Arm) -> Graph {
    match &arm.linkage {
        Some(linkage) => coupled(arm, linkage, &recursive(&linkage.chain)),
        None => planned(arm, &[]).0,
    }
}

/// What the recursions of `arms` cost by `plan`, in the measure of the search; [`usize::MAX`] where numbers overflow. What
/// they share with that of `whole`, which has the same joints, is made once.
pub(crate) fn costs(whole: &Arm, arms: &[Arm], plan: &Plan) -> Vec<usize> {
    let builder = Builder::new();
    let based = |arm: &Arm| based(&placed(arm, &plan.choices), &plan.choices);
    let whole = Pass::new(&builder, based(whole), &plan.choices, &plan.units, None);
    let len = builder.len();
    let one = |arm: &Arm| {
        let pass = Pass::new(&builder, based(arm), &plan.choices, &plan.units, Some(&whole));
        let cost = counted(&builder, &pass);
        builder.truncate(len);
        cost
    };
    arms.iter().map(one).collect()
}

/// As [`recursive`], where descents begin from other plans if there are any; also where the best one ends.
pub(crate) fn planned(arm: &Arm, plans: &[Plan]) -> (Graph, Plan) {
    let plain = [Plan { choices: vec![Choice::default(); arm.dof()], units: METRES }];
    let from = |plan: &Plan| {
        let builder = Builder::new();
        let mut search = Search::new(&builder, arm, plan);
        search.descend();
        (search.cost, search.plan)
    };
    let plans = if plans.is_empty() { plain.as_slice() } else { plans };
    let mut best = from(&plans[0]);
    for plan in &plans[1..] {
        let other = from(plan);
        if other.0 < best.0 {
            best = other;
        }
    }
    let (cost, plan) = best;
    let graph = if cost == usize::MAX {
        // Its numbers leave no room for moving parameters; they stay where they are.
        build(arm, &plan.choices, &METRES)
    } else {
        build(&based(&placed(arm, &plan.choices), &plan.choices), &plan.choices, &plan.units).factored()
    };
    (graph, plan)
}

const SWEEPS: usize = 6;

/// A descent: the best plan so far, and all that its recursion consists of. Others are counted in the same graph: they share
/// most of it.
struct Search<'a, 'g> {
    arm: &'a Arm,
    builder: &'g Builder,
    plan: Plan,
    /// With its frames placed.
    placed: Arm,
    pass: Pass<'g>,
    cost: usize,
}

impl<'a, 'g> Search<'a, 'g> {
    fn new(builder: &'g Builder, arm: &'a Arm, plan: &Plan) -> Self {
        let placed = placed(arm, &plan.choices);
        let based = based(&placed, &plan.choices);
        let pass = Pass::new(builder, based, &plan.choices, &plan.units, None);
        let cost = counted(builder, &pass);
        Self { arm, builder, plan: plan.clone(), placed, pass, cost }
    }

    /// Link by link, one choice at a time, until none pays.
    fn descend(&mut self) {
        // How often the plan had changed when the choices of each link were last tried.
        let mut changes = 0;
        let mut tried = vec![None; self.arm.dof()];
        for _ in 0..SWEEPS {
            let before = changes;
            for j in 0..self.arm.dof() {
                if tried[j] == Some(changes) {
                    continue;
                }
                let from = changes;
                for choice in neighbours(&self.plan.choices[j]) {
                    if choice.sum && !may_sum(self.arm, j) {
                        continue;
                    }
                    let mut choices = self.plan.choices.clone();
                    choices[j] = choice;
                    changes += usize::from(self.take_cheaper(Plan { choices, units: self.plan.units }));
                }
                tried[j] = Some(from);
            }
            for unit in lengths(&self.pass.arm) {
                let now = self.plan.units;
                for units in [
                    Units { acceleration: unit, ..now },
                    Units { force: unit, ..now },
                    Units { acceleration: unit, force: unit },
                ] {
                    let choices = self.plan.choices.clone();
                    changes += usize::from(self.take_cheaper(Plan { choices, units }));
                }
            }
            if changes == before {
                break;
            }
        }
    }

    /// Whether `plan` is cheaper, and so is taken.
    fn take_cheaper(&mut self, plan: Plan) -> bool {
        let len = self.builder.len();
        let origins = |plan: &Plan| plan.choices.iter().map(|choice| choice.origin).collect::<Vec<Origin>>();
        let moved = (origins(&plan) != origins(&self.plan)).then(|| placed(self.arm, &plan.choices));
        let based = based(moved.as_ref().unwrap_or(&self.placed), &plan.choices);
        let pass = Pass::new(self.builder, based, &plan.choices, &plan.units, Some(&self.pass));
        let cost = counted(self.builder, &pass);
        if cost >= self.cost {
            self.builder.truncate(len);
            return false;
        }
        if let Some(moved) = moved {
            self.placed = moved;
        }
        (self.plan, self.pass, self.cost) = (plan, pass, cost);
        true
    }
}

/// Operations of a run in the measure of the search.
fn counted(builder: &Builder, pass: &Pass) -> usize {
    let operations = builder.operations(pass.links.iter().map(|link| link.torque.id()));
    operations.map_or(usize::MAX, |count| count.cost())
}

/// The arm with its frames placed.
fn placed(arm: &Arm, choices: &[Choice]) -> Arm {
    arm.placed(&choices.iter().map(|choice| choice.origin).collect::<Vec<_>>())
}

/// A placed arm with its parameters regrouped.
fn based(placed: &Arm, choices: &[Choice]) -> Arm {
    placed.regrouped_keeping(&choices.iter().map(|choice| choice.kept).collect::<Vec<_>>())
}

/// A joint parallel to a revolute one before it.
fn may_sum(arm: &Arm, j: usize) -> bool {
    j > 0 && arm.joints[j].pose.is_along_z() && arm.joints[j - 1].kind == JointKind::Revolute
}

/// Lengths that make a constant of the placed and regrouped arm 1 where they are the unit; none where a prismatic joint moves
/// by metres.
fn lengths(based: &Arm) -> Vec<f64> {
    if based.joints.iter().any(|joint| joint.kind == JointKind::Prismatic) {
        return Vec::new();
    }
    let offsets = based.joints.iter().flat_map(|joint| joint.pose.translation);
    let moments = based.joints.iter().flat_map(|joint| joint.body.first_moment).map(|s| 1.0 / s);
    let all = offsets.chain(based.gravity).chain(moments).chain([1.0]);
    let mut all: Vec<f64> = all.map(f64::abs).filter(|x| *x != 0.0 && x.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

#[cfg(test)]
mod tests;
