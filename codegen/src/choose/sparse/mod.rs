//! Mode `tolerance`: a family of ever cheaper and coarser sparse models.
//!
//! A few descents make the members of the family, one after the other. The members depend on the arm, the domain and its
//! rates. A looser tolerance only lets the descents go on for longer: it sees all members of a stricter one, and costs no
//! more.

mod cost;
mod descent;
mod exchange;
mod fitting;
mod moves;
mod polish;
mod room;
mod squares;
mod start;
mod ties;

use std::sync::Arc;

use crate::lagrangian::{Absolute, Combination, Lagrangian};
use crate::numerics::vector::add_scaled;
use crate::parallel::Parallelize;
use crate::reduction::{CandidateFunction, Sparse, products};
use cost::Costs;
use descent::Descent;
use fitting::Table;
use moves::Moves;

/// Where the descent begins: the torque error at the points as a fraction of the joint's torque.
pub const STRICTEST: f64 = 3.5e-3;
/// Ratio of the fractions of neighbouring steps.
const STEP: f64 = 1.06;
/// How much each descent prefers large steps. Which one ends at the least cost is not known before.
const KEEN: [f64; 2] = [0.7, 1.5];
/// Where it ends in any case.
const LAST: f64 = 0.5;

/// What the models must be good for.
#[derive(Clone, Copy, Debug)]
pub struct SparseProblem<'a> {
    /// The exact model, in the coordinates in which its coefficients are sought.
    pub lagrangian: &'a Lagrangian,
    /// These, where they are not the joints'; its model is `lagrangian`.
    pub absolute: Option<&'a Arc<Absolute>>,
    /// By joint and coefficient: Ū_m, the most that multiplies α_m in that row, over the joint's torque.
    pub shares: &'a [Vec<f64>],
    /// Points of the domain, rad or m.
    pub points: &'a [Vec<f64>],
}

/// A member of the family.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseCandidate {
    /// The model.
    pub model: Sparse,
    /// Largest Σ_m |r_m| Ū_m over the points and joints, as a fraction of the joint's torque; its maximum over the
    /// domain is larger.
    pub error: f64,
    /// What the search takes its operations for, before the graph has shared what it can; a sine-cosine pair as
    /// [`crate::graph::TRIG_PAIR`].
    pub cost: usize,
}

/// The members with errors up to `most`.
///
/// Where the exact model is too long for a search, the family is empty.
pub fn family(problem: &SparseProblem, most: f64) -> Vec<SparseCandidate> {
    let lagrangian = problem.lagrangian;
    if most < STRICTEST || problem.points.is_empty() {
        return Vec::new();
    }
    let mut candidates: Vec<CandidateFunction> =
        (0..lagrangian.functions.len()).map(CandidateFunction::harmonic).collect();
    candidates.extend(products(lagrangian, 3));
    let rows: Vec<Vec<f64>> = problem.points.par_iter().map(|q| lagrangian.evaluate_functions(q)).collect();
    let psi: Vec<Vec<f64>> =
        (0..lagrangian.functions.len()).map(|l| rows.iter().map(|row| row[l]).collect()).collect();
    // As `evaluate` adds them, at all points at once.
    let column = |terms: &Combination| {
        let mut out = vec![0.0; problem.points.len()];
        terms.iter().for_each(|&(l, k)| add_scaled(&mut out, k, &psi[l]));
        out
    };
    let functions = candidates.par_iter().map(|candidate| column(&candidate.expansion)).collect();
    let coefficients = lagrangian.coefficients.par_iter().map(|c| column(&c.terms)).collect();
    let table = Table::new(problem, functions, coefficients);
    let onto = problem.absolute.map(|absolute| absolute.coordinates.onto.as_slice());
    let costs = Costs::new(lagrangian, &candidates, onto);
    let moves = Moves::new(lagrangian, &candidates, &costs);
    let start = Descent::new(problem, &table, &costs, &moves);
    let one = |&keen: &f64| descent::members(problem, &candidates, &start, most.min(LAST), keen);
    KEEN.par_iter().flat_map_iter(one).collect()
}
