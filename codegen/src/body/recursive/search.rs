//! The cheapest of the recursion's ways for one arm.

use super::build;
use super::choice::{Choice, neighbours};
use crate::arm::{Arm, JointKind};
use crate::graph::Graph;

/// What a sine and cosine count beside one multiplication or addition.
const TRIG: usize = 30;

/// The recursion with the fewest operations that a descent finds: link by link, one choice at a time, until none pays.
pub fn recursive(arm: &Arm) -> Graph {
    let mut best = Candidate::new(arm, vec![Choice::default(); arm.dof()], 1.0);
    for _ in 0..SWEEPS {
        let before = best.cost;
        for j in 0..arm.dof() {
            for choice in neighbours(&best.choices[j]) {
                if choice.sum && !may_sum(arm, j) {
                    continue;
                }
                let mut choices = best.choices.clone();
                choices[j] = choice;
                let next = Candidate::new(arm, choices, best.unit);
                if next.cost < best.cost {
                    best = next;
                }
            }
        }
        for unit in units(arm, &best) {
            let next = Candidate::new(arm, best.choices.clone(), unit);
            if next.cost < best.cost {
                best = next;
            }
        }
        if best.cost == before {
            break;
        }
    }
    best.graph
}

const SWEEPS: usize = 6;

struct Candidate {
    choices: Vec<Choice>,
    unit: f64,
    graph: Graph,
    cost: usize,
}

impl Candidate {
    fn new(arm: &Arm, choices: Vec<Choice>, unit: f64) -> Self {
        let origins: Vec<_> = choices.iter().map(|choice| choice.origin).collect();
        let kept: Vec<_> = choices.iter().map(|choice| (choice.mass, choice.along)).collect();
        let arm = arm.placed(&origins).regrouped_keeping(&kept);
        let arm = if unit == 1.0 { arm } else { arm.in_units_of(unit) };
        let graph = build(&arm, &choices, unit);
        let operations = graph.operations();
        let cost = operations.arithmetic() + TRIG * operations.trig_pairs;
        Self { choices, unit, graph, cost }
    }
}

/// A joint parallel to a revolute one before it.
fn may_sum(arm: &Arm, j: usize) -> bool {
    j > 0 && arm.joints[j].pose.rotation[2][2].abs() == 1.0 && arm.joints[j - 1].kind == JointKind::Revolute
}

/// Lengths and the gravity of the arm, each of which becomes 1 where it is the unit.
fn units(arm: &Arm, best: &Candidate) -> Vec<f64> {
    if arm.joints.iter().any(|joint| joint.kind == JointKind::Prismatic) {
        return Vec::new();
    }
    let origins: Vec<_> = best.choices.iter().map(|choice| choice.origin).collect();
    let placed = arm.placed(&origins);
    let lengths = placed.joints.iter().flat_map(|joint| joint.pose.translation).chain(arm.gravity);
    let mut units: Vec<f64> = lengths.map(f64::abs).filter(|&x| x != 0.0).collect();
    units.push(1.0);
    units.sort_by(f64::total_cmp);
    units.dedup();
    units
}
