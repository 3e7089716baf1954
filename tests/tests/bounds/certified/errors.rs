//! What a reduced model leaves out, by the recursive exact model rather than the expansion from which it was reduced.

use gramforge::Generation;
use gramforge::internals::arm::JointKind;
use gramforge::internals::dynamics::{Position, passivity_torque};
use gramforge::internals::lagrangian::{Entry, Place};

/// The pass of the recursion that gives a column of the exact model.
#[derive(Clone, Copy, PartialEq)]
enum Pass {
    /// d_ij for all i.
    Inertia(usize),
    /// h_ijk for all i.
    Velocity(usize, usize),
    /// g_i for all i.
    Gravity,
}

/// The errors |α_m − α̂_m| of the simplified coefficients.
pub struct Errors<'a> {
    generation: &'a Generation,
    /// The simplified coefficients.
    pub simplified: Vec<usize>,
    passes: Vec<Pass>,
    /// The pass and the place where each coefficient stands, in the order of `simplified`.
    places: Vec<(usize, Place)>,
    /// The functions that the model keeps.
    kept: Vec<usize>,
}

impl<'a> Errors<'a> {
    /// Of all simplified coefficients of `generation`.
    pub fn new(generation: &'a Generation) -> Self {
        let coefficients = &generation.lagrangian().coefficients;
        let simplified: Vec<usize> =
            (0..coefficients.len()).filter(|&m| generation.reduced().simplified[m]).collect();
        let mut passes = Vec::new();
        let mut places = Vec::new();
        let mut kept = Vec::new();
        for &m in &simplified {
            let place = coefficients[m].places[0];
            let pass = match place.entry {
                Entry::D(_, j) => Pass::Inertia(j),
                Entry::H(_, j, k) => Pass::Velocity(j, k),
                Entry::G(_) => Pass::Gravity,
            };
            let index = passes.iter().position(|p| *p == pass).unwrap_or(passes.len());
            if index == passes.len() {
                passes.push(pass);
            }
            places.push((index, place));
            kept.extend(generation.reduced().combinations[m].iter().map(|&(l, _)| l));
        }
        kept.sort_unstable();
        kept.dedup();
        Self { generation, simplified, passes, places, kept }
    }

    /// The error of number `index` among the simplified coefficients at `q`.
    pub fn one(&self, index: usize, q: &[f64]) -> f64 {
        let (pass, place) = self.places[index];
        let column = self.column(self.passes[pass], &self.positions(q));
        let functions = &self.generation.lagrangian().functions;
        let terms = &self.generation.reduced().combinations[self.simplified[index]];
        let model: f64 = terms.iter().map(|&(l, k)| k * functions[l].evaluate(q)).sum();
        (place.sign * column[row(place.entry)] - model).abs()
    }

    /// All errors at `q`, in the order of `simplified`.
    pub fn all(&self, q: &[f64]) -> Vec<f64> {
        let positions = self.positions(q);
        let columns: Vec<Vec<f64>> = self.passes.iter().map(|&pass| self.column(pass, &positions)).collect();
        let functions = &self.generation.lagrangian().functions;
        let mut psi = vec![0.0; functions.len()];
        self.kept.iter().for_each(|&l| psi[l] = functions[l].evaluate(q));
        let error = |(&m, (pass, place)): (&usize, &(usize, Place))| {
            let terms = &self.generation.reduced().combinations[m];
            let model: f64 = terms.iter().map(|&(l, k)| k * psi[l]).sum();
            (place.sign * columns[*pass][row(place.entry)] - model).abs()
        };
        self.simplified.iter().zip(&self.places).map(error).collect()
    }

    fn positions(&self, q: &[f64]) -> Vec<Position<f64>> {
        let position = |(joint, &q): (&gramforge::internals::arm::Joint, &f64)| match joint.kind {
            JointKind::Revolute => Position::Revolute { sin: q.sin(), cos: q.cos() },
            JointKind::Prismatic => Position::Prismatic(q),
        };
        self.generation.arm().joints.iter().zip(q).map(position).collect()
    }

    fn column(&self, pass: Pass, q: &[Position<f64>]) -> Vec<f64> {
        let arm = self.generation.arm();
        let rest = [0.0; 8];
        let unit = |j: usize| -> [f64; 8] { std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 }) };
        let n = q.len();
        match pass {
            Pass::Inertia(j) => passivity_torque(arm, [0.0; 3], q, &rest[..n], &rest[..n], &unit(j)[..n]),
            Pass::Velocity(j, k) => {
                passivity_torque(arm, [0.0; 3], q, &unit(k)[..n], &unit(j)[..n], &rest[..n])
            }
            Pass::Gravity => passivity_torque(arm, arm.gravity, q, &rest[..n], &rest[..n], &rest[..n]),
        }
    }
}

fn row(entry: Entry) -> usize {
    match entry {
        Entry::D(i, _) | Entry::H(i, _, _) | Entry::G(i) => i,
    }
}
