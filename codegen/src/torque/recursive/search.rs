//! The cheapest of the recursion's ways for one arm.

use super::super::coupled::coupled;
use super::build;
use super::choice::{Choice, neighbours};
use super::wrench::Units;
use crate::arm::{Arm, JointKind};
use crate::graph::Graph;

/// What a sine and cosine count beside one multiplication or addition.
const TRIG: usize = 30;

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

/// What the recursion of `arm` costs by `plan`, in the measure of the search; [`usize::MAX`] where its numbers overflow.
pub(crate) fn cost(arm: &Arm, plan: &Plan) -> usize {
    RecursionCandidate::new(arm, plan.choices.clone(), plan.units).cost
}

/// As [`recursive`], where descents begin from other plans if there are any; also where the best one ends.
pub(crate) fn planned(arm: &Arm, plans: &[Plan]) -> (Graph, Plan) {
    let plain = [Plan { choices: vec![Choice::default(); arm.dof()], units: METRES }];
    let from = |plan: &Plan| descended(arm, RecursionCandidate::new(arm, plan.choices.clone(), plan.units));
    let plans = if plans.is_empty() { plain.as_slice() } else { plans };
    let mut best = from(&plans[0]);
    plans[1..].iter().for_each(|plan| best.take_cheaper(from(plan)));
    let graph = if best.cost == usize::MAX {
        // Its numbers leave no room for moving parameters; they stay where they are.
        build(arm, &best.choices, &METRES, true)
    } else {
        build(&based(arm, &best.choices), &best.choices, &best.units, true).factored()
    };
    (graph, Plan { choices: std::mem::take(&mut best.choices), units: best.units })
}

/// The end of the descent from `best`.
fn descended(arm: &Arm, mut best: RecursionCandidate) -> RecursionCandidate {
    for _ in 0..SWEEPS {
        let before = best.cost;
        for j in 0..arm.dof() {
            for choice in neighbours(&best.choices[j]) {
                if choice.sum && !may_sum(arm, j) {
                    continue;
                }
                let mut choices = best.choices.clone();
                choices[j] = choice;
                best.take_cheaper(RecursionCandidate::new(arm, choices, best.units));
            }
        }
        for unit in lengths(arm, &best) {
            for units in [
                Units { acceleration: unit, ..best.units },
                Units { force: unit, ..best.units },
                Units { acceleration: unit, force: unit },
            ] {
                best.take_cheaper(RecursionCandidate::new(arm, best.choices.clone(), units));
            }
        }
        if best.cost == before {
            break;
        }
    }
    best
}

const SWEEPS: usize = 6;

struct RecursionCandidate {
    choices: Vec<Choice>,
    units: Units,
    cost: usize,
}

impl RecursionCandidate {
    fn new(arm: &Arm, choices: Vec<Choice>, units: Units) -> Self {
        let graph = build(&based(arm, &choices), &choices, &units, false);
        let operations = graph.operations();
        let cost = operations.arithmetic() + TRIG * operations.trig_pairs;
        let cost = if graph.is_finite() { cost } else { usize::MAX };
        Self { choices, units, cost }
    }

    fn take_cheaper(&mut self, other: Self) {
        if other.cost < self.cost {
            *self = other;
        }
    }
}

/// The arm with its frames placed and its parameters regrouped.
fn based(arm: &Arm, choices: &[Choice]) -> Arm {
    let origins: Vec<_> = choices.iter().map(|choice| choice.origin).collect();
    let kept: Vec<_> = choices.iter().map(|choice| choice.kept).collect();
    arm.placed(&origins).regrouped_keeping(&kept)
}

/// A joint parallel to a revolute one before it.
fn may_sum(arm: &Arm, j: usize) -> bool {
    j > 0 && arm.joints[j].pose.is_along_z() && arm.joints[j - 1].kind == JointKind::Revolute
}

/// Lengths that make a constant 1 where they are the unit; none where a prismatic joint moves by metres.
fn lengths(arm: &Arm, best: &RecursionCandidate) -> Vec<f64> {
    if arm.joints.iter().any(|joint| joint.kind == JointKind::Prismatic) {
        return Vec::new();
    }
    let based = based(arm, &best.choices);
    let offsets = based.joints.iter().flat_map(|joint| joint.pose.translation);
    let moments = based.joints.iter().flat_map(|joint| joint.body.first_moment).map(|s| 1.0 / s);
    let all = offsets.chain(arm.gravity).chain(moments).chain([1.0]);
    let mut all: Vec<f64> = all.map(f64::abs).filter(|x| *x != 0.0 && x.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
