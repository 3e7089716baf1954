//! The parameters θ that an adaptive law learns, and the model as an affine function of them, equation (50).

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

use super::Reduced;
use crate::lagrangian::{Combination, Lagrangian, MAX_JOINTS};
use crate::spec::ParametersSpec;

/// One parameter θ_k.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Learnt {
    /// The uncertain number's field, or coefficient and function.
    pub name: String,
    /// Lowest value.
    pub low: f64,
    /// Value at the arm's own parameters.
    pub initial: f64,
    /// Highest value.
    pub high: f64,
    /// ∂α̂_m/∂θ_k for each coefficient m on which it has an effect.
    pub effects: Vec<(usize, Combination)>,
}

/// The simplified model as α̂_m = base_m + Σ_k θ_k effects_k,m.
///
/// Holds: for every value of the uncertain parameters there is a θ in the box that gives the re-estimated model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regression {
    /// base_m by coefficient.
    pub base: Vec<Combination>,
    /// The parameters.
    pub parameters: Vec<Learnt>,
}

impl Regression {
    /// The parametrisation of a re-estimated model; `names` are those of the uncertain numbers.
    pub fn new(lagrangian: &Lagrangian, reduced: &Reduced, kind: ParametersSpec, names: &[String]) -> Self {
        match kind {
            ParametersSpec::Uncertain => Self::uncertain(lagrangian, reduced, names),
            ParametersSpec::All => Self::all(lagrangian, reduced),
        }
    }

    fn uncertain(lagrangian: &Lagrangian, reduced: &Reduced, names: &[String]) -> Self {
        let effects = |k: usize| -> Vec<(usize, Combination)> {
            let varies = reduced.variations.iter().enumerate().filter(|(_, v)| !v[k].is_empty());
            varies.map(|(m, v)| (m, v[k].clone())).collect()
        };
        let parameter = |(k, &[low, high]): (usize, &[f64; 2])| {
            let name = names.get(k).cloned().unwrap_or_default();
            Learnt { name, low, initial: 0.0, high, effects: effects(k) }
        };
        let parameters =
            lagrangian.ranges.iter().enumerate().filter(|(_, [low, high])| low < high).map(parameter);
        Self { base: reduced.combinations.clone(), parameters: parameters.collect() }
    }

    /// Every parameter of the model that the uncertain numbers move; the others keep their values.
    fn all(lagrangian: &Lagrangian, reduced: &Reduced) -> Self {
        let mut out = Self { base: Vec::new(), parameters: Vec::new() };
        for (m, own) in reduced.combinations.iter().enumerate() {
            let mut base = own.clone();
            let variations = &reduced.variations[m];
            let support: BTreeSet<usize> =
                [own].into_iter().chain(variations).flatten().map(|t| t.0).collect();
            for l in support {
                let at =
                    |terms: &Combination| terms.iter().find(|(other, _)| *other == l).map_or(0.0, |t| t.1);
                let initial = at(own);
                let (mut low, mut high) = (initial, initial);
                for (v, [down, up]) in variations.iter().zip(&lagrangian.ranges) {
                    let slope = at(v);
                    low += (slope * down).min(slope * up);
                    high += (slope * down).max(slope * up);
                }
                if low < high {
                    base.retain(|(other, _)| *other != l);
                    let name =
                        format!("{} of {}", lagrangian.functions[l], lagrangian.coefficients[m].name());
                    let effects = vec![(m, vec![(l, 1.0)])];
                    out.parameters.push(Learnt { name, low, initial, high, effects });
                }
            }
            out.base.push(base);
        }
        out
    }

    /// sup |∂α̂_m/∂θ_k| by parameter and coefficient where |q_j| ≤ `position_bound`, for coefficients with an effect.
    pub fn largest_effects(&self, lagrangian: &Lagrangian, position_bound: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let largest = |l: usize| -> f64 {
            let power: &[u8; MAX_JOINTS] = &lagrangian.functions[l].power;
            position_bound.iter().zip(power).fold(1.0, |p, (q, &e)| (0..e).fold(p, |p, _| p * q))
        };
        let size = |terms: &Combination| terms.iter().map(|&(l, k)| k.abs() * largest(l)).sum::<f64>();
        let of = |p: &Learnt| p.effects.iter().map(|(m, terms)| (*m, size(terms))).collect();
        self.parameters.iter().map(of).collect()
    }
}
