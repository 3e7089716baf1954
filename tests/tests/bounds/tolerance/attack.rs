//! A search for torque errors of emitted code that are larger than certified.

use gramforge::Generation;
use gramforge::internals::bounds::Rates;
use gramforge::internals::domain::Domain;
use gramforge::internals::graph::Graph;
use gramforge::internals::lagrangian::{Combination, evaluate};
use gramforge::internals::numerics::low_discrepancy::{LowDiscrepancy, in_box};
use gramforge::internals::torque::recursive;

/// What the torque error is looked for over: positions as a box of variables, and the corners of the rates.
struct Arena<'a> {
    generation: &'a Generation,
    rates: Rates,
    /// What no error may exceed, by joint, N·m or N.
    limit: Vec<f64>,
    /// The exact code, of uncertain arms at every vertex of what is uncertain.
    exact: Vec<Graph>,
    /// What is left of the coefficients that are simplified, with their bounds.
    left: Vec<(Combination, f64)>,
}

/// A state: variables in the unit cube, the last one the time of a motion; bits say which rates are negative.
#[derive(Clone)]
struct State {
    unit: Vec<f64>,
    signs: usize,
}

impl Arena<'_> {
    fn new(generation: &Generation, rates: Rates, limit: Vec<f64>) -> Arena<'_> {
        let (arm, uncertainty, exact_code) =
            (generation.arm(), generation.uncertainty(), generation.exact_code());
        let vertices = uncertainty.vertices().map(|u| recursive(&uncertainty.at(arm, &u)));
        let exact =
            if uncertainty.is_empty() { vec![exact_code.clone()] } else { vertices.collect::<Vec<_>>() };
        let left = |m: usize| {
            (generation.reduced().residual(generation.lagrangian(), m), generation.certificates()[m].bound)
        };
        let left =
            (0..generation.certificates().len()).filter(|&m| generation.reduced().simplified[m]).map(left);
        Arena { generation, rates, limit, exact, left: left.collect() }
    }

    fn position(&self, unit: &[f64]) -> Vec<f64> {
        let n = self.generation.arm().dof();
        match (self.generation.domain(), &self.generation.motion()) {
            (Domain::Workspace(limits), _) => in_box(limits, &unit[..n]),
            (Domain::Tube(_, errors), Some(motion)) => {
                let centre = motion.at(motion.duration() * unit[n]).q;
                centre.iter().zip(errors).zip(unit).map(|((q, e), u)| q + e * (2.0 * u - 1.0)).collect()
            }
            (_, Some(motion)) => motion.at(motion.duration() * unit[n]).q,
            (_, None) => unreachable!("a domain around no motion"),
        }
    }

    /// |emitted − exact| by joint, as parts of what is certified; no coefficient is further off than its bound.
    fn parts(&self, state: &State) -> Vec<f64> {
        let n = self.generation.arm().dof();
        let q = self.position(&state.unit);
        if !self.left.is_empty() {
            let psi = self.generation.lagrangian().evaluate_functions(&q);
            for (terms, bound) in &self.left {
                assert!(evaluate(terms, &psi).abs() <= *bound);
            }
        }
        let corner = |rate: &[f64], from: usize| -> Vec<f64> {
            let sign = |i: usize| if state.signs >> (from + i) & 1 == 1 { -1.0 } else { 1.0 };
            (0..n).map(|i| sign(i) * rate[i]).collect()
        };
        let (v, w) = (corner(&self.rates.speed, 0), corner(&self.rates.reference_speed, n));
        let a = corner(&self.rates.reference_acceleration, 2 * n);
        let model = self.generation.code().interpret(&q, &v, &w, &a);
        let exact: Vec<Vec<f64>> = self.exact.iter().map(|code| code.interpret(&q, &v, &w, &a)).collect();
        let torque = self.generation.torque().unwrap();
        let part = |i: usize| {
            let error = exact.iter().map(|exact| (model[i] - exact[i]).abs()).fold(0.0, f64::max);
            let (limit, rounding) = (self.limit[i], 1e-11 * torque.peak[i]);
            assert!(error <= limit + rounding, "joint {}: {error} > {limit}", i + 1);
            if limit > 0.0 { error / limit } else { 0.0 }
        };
        (0..n).map(part).collect()
    }

    /// Uphill for joint `i`, by steps along single variables and turns of single rates.
    fn climb(&self, i: usize, mut state: State) -> f64 {
        let n = self.generation.arm().dof();
        let mut height = self.parts(&state)[i];
        let mut step = 0.1;
        while step > 1e-3 {
            let before = height;
            for change in 0..2 * (n + 1) + 3 * n {
                let mut next = state.clone();
                match change.checked_sub(2 * (n + 1)) {
                    Some(bit) => next.signs ^= 1 << bit,
                    None => {
                        let turn = if change % 2 == 0 { step } else { -step };
                        next.unit[change / 2] = (next.unit[change / 2] + turn).clamp(0.0, 1.0);
                    }
                }
                let there = self.parts(&next)[i];
                if there > height {
                    (height, state) = (there, next);
                }
            }
            step *= if height > before { 1.0 } else { 0.5 };
        }
        height
    }
}

/// The emitted code against the exact code at states of the domain, sides among them, rates in corners of their box, and
/// climbs from the worst of them for each joint. Largest error found as a part of what is certified.
pub fn search(generation: &Generation, states: usize) -> f64 {
    let rates = match (generation.domain(), &generation.motion()) {
        (Domain::Workspace(_), _) | (_, None) => Rates::limits(generation.arm()).unwrap(),
        (_, Some(motion)) => Rates::of(motion),
    };
    let limit = generation.torque().unwrap().error.clone();
    search_within(generation, rates, limit, states)
}

/// The same for rates up to `rates`, against `limit` by joint, N·m or N.
pub fn search_within(generation: &Generation, rates: Rates, limit: Vec<f64>, states: usize) -> f64 {
    let arena = Arena::new(generation, rates, limit);
    let n = generation.arm().dof();
    let spread = LowDiscrepancy::new(n + 1);
    let state = |index: usize| {
        let side = |u: &f64| (0.5 + 1.4 * (u - 0.5)).clamp(0.0, 1.0);
        let signs = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 7;
        State { unit: spread.point(index).iter().map(side).collect(), signs }
    };
    let mut best = vec![(0.0, 0); n];
    for index in 0..states {
        for (best, part) in best.iter_mut().zip(arena.parts(&state(index))) {
            if part > best.0 {
                *best = (part, index);
            }
        }
    }
    (0..n).map(|i| arena.climb(i, state(best[i].1))).fold(0.0, f64::max)
}
