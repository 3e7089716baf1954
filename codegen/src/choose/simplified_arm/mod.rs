//! The recursion of simpler arms: inertial parameters left out one after the other, the others refitted.
//!
//! D, h and G are linear in the inertial parameters, so the error at points of the domain is linear in what is left
//! out, and so is what the others make good again. The family is what two descents pass through, one that refits and one that
//! does not (equal and round numbers of the arm make its own recursion cheaper); levels and steps know nothing of the
//! tolerance asked for.

mod descent;
mod moves;
mod refit;
mod table;

use crate::arm::{Arm, Inertial, Quantity};
use crate::bounds::beside_expansion;
use crate::graph::Graph;
use crate::lagrangian::{Lagrangian, expand};
use crate::model::Model;
use crate::reduction::{Expressed, Kind, Reduced, SimplifiedArm, expressed};
use crate::torque::Form;
use table::Table;

/// Coefficients times parameters beyond which nothing is refitted: it would take minutes.
const REFITTED: usize = 30000;

/// What the models must be good for.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArmProblem<'a> {
    /// The arm.
    pub arm: &'a Arm,
    /// Its exact model.
    pub lagrangian: &'a Lagrangian,
    /// By joint and coefficient: the most that multiplies α_m in that row, over the joint's torque.
    pub shares: &'a [Vec<f64>],
    /// Points of the domain, rad or m.
    pub points: &'a [Vec<f64>],
}

/// An arm of the family.
#[derive(Clone, Debug)]
pub(super) struct ArmCandidate {
    /// The arm; its bodies are not those of matter.
    pub arm: Arm,
    /// What it lacks.
    lost: Vec<Inertial>,
    /// Its torque.
    pub code: Graph,
    /// Largest Σ_m |r_m| Ū_m over the points and joints, as a fraction of the joint's torque.
    pub error: f64,
    /// The same with each |r_m| at its own largest.
    pub separate: f64,
}

/// The members with errors up to `most` at the points that cost no less than `least`.
pub(super) fn family(problem: &ArmProblem, most: f64, least: usize) -> Vec<ArmCandidate> {
    // Where joints follow others the bodies stand in the chain, whose parameters are not judged one by one.
    if problem.points.is_empty() || problem.arm.linkage.is_some() {
        return Vec::new();
    }
    let regrouped = problem.arm.regrouped();
    let counts = |p: &Inertial| p.quantity == Quantity::Armature || regrouped.inertial(*p) != 0.0;
    let parameters: Vec<Inertial> = (0..regrouped.dof()).flat_map(Inertial::of).filter(counts).collect();
    let table = Table::new(problem, &regrouped, &parameters);
    let descent = |refits| descent::members(&table, problem.arm, &parameters, most, least, refits);
    let short = table.coefficients * parameters.len() <= REFITTED;
    let (refitted, plain) = rayon::join(|| if short { descent(true) } else { Vec::new() }, || descent(false));
    refitted.into_iter().chain(plain).collect()
}

impl ArmCandidate {
    /// What its code costs.
    pub fn cost(&self) -> usize {
        self.code.operations().cost()
    }

    /// The model, where |q_j| ≤ `position_bound`; `None` where it is not one over the functions of `lagrangian`.
    pub fn model(self, lagrangian: &Lagrangian, position_bound: &[f64]) -> Option<Model> {
        let Expressed { combinations, simplified, lacking } = expressed(lagrangian, &expand(&self.arm))?;
        let rounding = beside_expansion(lagrangian, &combinations, &lacking, &self.arm, position_bound);
        let parameters = self.lost.iter().map(|p| p.describe(&self.arm)).collect();
        let reduced = Reduced {
            selected: Vec::new(),
            combinations,
            simplified,
            variations: Vec::new(),
            kind: Kind::SimplifiedArm(SimplifiedArm { rounding, parameters }),
        };
        Some(Model { reduced, form: Form::Recursive, code: self.code })
    }
}
