//! What is counted beside another recursion, against the graph made anew.

use super::*;
use crate::arm::Inertial;
use crate::torque::tests::{arm, random_arm};

fn arms() -> impl Iterator<Item = Arm> {
    let files = ["puma560_workspace.json", "ur5.json", "stanford.json"].map(arm);
    files.into_iter().chain((0..12).map(random_arm))
}

/// The count of the graph as it is written out.
fn anew(arm: &Arm, plan: &Plan) -> usize {
    let graph = build(&based(&placed(arm, &plan.choices), &plan.choices), &plan.choices, &plan.units);
    let operations = graph.operations();
    let cost = operations.cost();
    if graph.is_finite() { cost } else { usize::MAX }
}

#[test]
fn a_plan_counted_beside_another_costs_what_its_own_graph_does() {
    for (number, arm) in arms().enumerate() {
        let builder = Builder::new();
        let plain = Plan { choices: vec![Choice::default(); arm.dof()], units: METRES };
        let mut search = Search::new(&builder, &arm, &plain);
        for j in (0..arm.dof()).rev() {
            for (index, choice) in neighbours(&search.plan.choices[j]).into_iter().enumerate() {
                if choice.sum && !may_sum(&arm, j) {
                    continue;
                }
                let mut plan = search.plan.clone();
                plan.choices[j] = choice;
                if index % 5 == 0 && lengths(&search.pass.arm).len() > 1 {
                    plan.units.force = lengths(&search.pass.arm)[index % 2];
                }
                let wanted = anew(&arm, &plan);
                // Whatever it costs it is taken, so that the next ones are counted beside it.
                search.cost = usize::MAX;
                assert!(search.take_cheaper(plan), "arm {number}");
                assert_eq!(search.cost, wanted, "arm {number}, joint {j}, choice {index}");
            }
        }
    }
}

#[test]
fn what_is_given_up_leaves_no_trace() {
    let arm = arm("puma560_workspace.json");
    let builder = Builder::new();
    let plain = Plan { choices: vec![Choice::default(); arm.dof()], units: METRES };
    let mut search = Search::new(&builder, &arm, &plain);
    let (len, cost) = (builder.len(), search.cost);
    search.cost = 0;
    for choice in neighbours(&Choice::default()) {
        let mut plan = plain.clone();
        plan.choices[3] = Choice { sum: false, ..choice };
        assert!(!search.take_cheaper(plan));
        assert_eq!(builder.len(), len);
    }
    assert_eq!(counted(&builder, &search.pass), cost);
}

#[test]
fn arms_counted_together_cost_what_each_costs_alone() {
    for (number, arm) in arms().enumerate() {
        let (_, plan) = planned(&arm, &[]);
        let regrouped = arm.regrouped();
        let without = |parameter: Inertial| {
            let mut other = arm.clone();
            other.set_inertial(parameter, arm.inertial(parameter) - regrouped.inertial(parameter));
            other
        };
        let others: Vec<Arm> = (0..arm.dof()).flat_map(Inertial::of).map(without).collect();
        let alone: Vec<usize> = others.iter().map(|other| anew(other, &plan)).collect();
        assert_eq!(costs(&arm, &others, &plan), alone, "arm {number}");
        assert!(alone.iter().any(|&cost| cost < anew(&arm, &plan)), "arm {number}");
    }
}
