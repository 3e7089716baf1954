//! Models whose coefficients keep few functions each, products among them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Kind, Reduced, plus};
use crate::lagrangian::{Absolute, Combination, Function, Lagrangian};

/// A function that a model may keep: one ψ, or a product of two or three of them.
///
/// Holds: `expansion` is the same function as a combination of ψ of the exact model, so that residuals stay
/// combinations of these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CandidateFunction {
    /// The factors, as indices into [`Lagrangian::functions`]; the last two are multiplied first.
    pub factors: Vec<usize>,
    /// The product expanded.
    pub expansion: Combination,
}

impl CandidateFunction {
    /// The single function `l`.
    pub fn harmonic(l: usize) -> Self {
        Self { factors: vec![l], expansion: vec![(l, 1.0)] }
    }

    /// As a formula.
    pub fn formula(&self, lagrangian: &Lagrangian) -> String {
        let factor = |&l: &usize| lagrangian.functions[l].to_string();
        self.factors.iter().map(factor).collect::<Vec<_>>().join(" ")
    }
}

/// Coefficients that share one simplified form up to sign.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Indices into [`Lagrangian::coefficients`], each with the sign of the form there.
    pub members: Vec<(usize, f64)>,
    /// Pairs (index into [`Sparse::functions`], parameter).
    pub terms: Vec<(usize, f64)>,
}

/// How a sparse model is written down; coefficients in no group are zero.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sparse {
    /// The functions that occur.
    pub functions: Vec<CandidateFunction>,
    /// The forms, in the order of their first members.
    pub groups: Vec<Group>,
    /// The model whose coefficients these are, where it is written in absolute angles.
    pub absolute: Option<Arc<Absolute>>,
}

impl Sparse {
    /// The model whose coefficients the groups' members are; `lagrangian` is the one in joint angles.
    pub fn written_in<'a>(&'a self, lagrangian: &'a Lagrangian) -> &'a Lagrangian {
        self.absolute.as_ref().map_or(lagrangian, |absolute| &absolute.lagrangian)
    }

    /// The same model over the ψ of the exact one. A coefficient whose form keeps all its functions and no others is
    /// exact.
    pub fn reduced(mut self, lagrangian: &Lagrangian) -> Reduced {
        let (mut combinations, mut simplified) = self.combinations(lagrangian);
        if let Some(absolute) = &self.absolute {
            let sum = |parts: &Vec<(usize, f64)>| {
                parts.iter().fold(Combination::new(), |sum, &(s, k)| plus(&sum, k, &combinations[s]))
            };
            let changed: Vec<bool> =
                absolute.parts.iter().map(|parts| parts.iter().any(|&(s, _)| simplified[s])).collect();
            let exact = lagrangian.coefficients.iter().map(|coefficient| &coefficient.terms);
            let all = absolute.parts.iter().zip(&changed).zip(exact);
            combinations = all
                .map(|((parts, changed), exact)| if *changed { sum(parts) } else { exact.clone() })
                .collect();
            simplified = changed;
        }
        let mut selected: Vec<usize> = combinations.iter().flatten().map(|&(l, _)| l).collect();
        selected.sort_unstable();
        selected.dedup();
        Reduced { selected, combinations, simplified, variations: Vec::new(), kind: Kind::Sparse(self) }
    }

    /// α̂_m of the model as it is written, and whether it differs from α_m in form.
    fn combinations(&mut self, lagrangian: &Lagrangian) -> (Vec<Combination>, Vec<bool>) {
        let absolute = self.absolute.clone();
        let written = absolute.as_ref().map_or(lagrangian, |absolute| &absolute.lagrangian);
        let count = written.coefficients.len();
        let mut combinations = vec![Combination::new(); count];
        let mut simplified = vec![true; count];
        for group in &mut self.groups {
            let harmonic = group.terms.iter().all(|&(f, _)| self.functions[f].factors.len() == 1);
            if let ([(m, sign)], true) = (group.members.as_slice(), harmonic) {
                let exact = &written.coefficients[*m].terms;
                let of = |l: usize| exact.iter().find(|term| term.0 == l).map(|term| term.1 * sign);
                let same: Vec<_> = group
                    .terms
                    .iter()
                    .filter_map(|&(f, _)| Some((f, of(self.functions[f].factors[0])?)))
                    .collect();
                if same.len() == exact.len() && same.len() == group.terms.len() {
                    group.terms = same;
                    simplified[*m] = false;
                    combinations[*m].clone_from(exact);
                    continue;
                }
            }
            let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
            for &(f, k) in &group.terms {
                for &(l, c) in &self.functions[f].expansion {
                    *sum.entry(l).or_insert(0.0) += k * c;
                }
            }
            for &(m, sign) in &group.members {
                combinations[m] = sum.iter().map(|(&l, &k)| (l, sign * k)).filter(|t| t.1 != 0.0).collect();
            }
        }
        (combinations, simplified)
    }

    /// The place of ψ_l among the functions, which it joins if it is new.
    pub(super) fn index_of_harmonic(&mut self, l: usize) -> usize {
        let known = self.functions.iter().position(|c| c.factors == [l]);
        known.unwrap_or_else(|| {
            self.functions.push(CandidateFunction::harmonic(l));
            self.functions.len() - 1
        })
    }

    /// The same model without functions that no form keeps.
    pub(super) fn compacted(mut self) -> Self {
        let mut used: Vec<usize> =
            self.groups.iter().flat_map(|group| group.terms.iter().map(|term| term.0)).collect();
        used.sort_unstable();
        used.dedup();
        for group in &mut self.groups {
            group.terms.iter_mut().for_each(|term| term.0 = used.binary_search(&term.0).unwrap_or(0));
            group.terms.sort_by_key(|term| term.0);
        }
        self.functions = used.iter().filter_map(|&f| self.functions.get(f).cloned()).collect();
        self
    }

    /// What coefficient `m` of the model in joint angles is the sum of: terms with the parameters that they have there.
    pub fn terms(&self, m: usize) -> Vec<(usize, f64)> {
        let own = [(m, 1.0)];
        let parts = self.absolute.as_ref().map_or(own.as_slice(), |absolute| &absolute.parts[m]);
        let of = |&(s, factor): &(usize, f64)| {
            let group = self.groups.iter().find(|group| group.members.iter().any(|&(other, _)| other == s));
            let terms = group.map_or([].as_slice(), |group| group.terms.as_slice());
            terms.iter().map(move |&(f, k)| (f, factor * k)).collect::<Vec<_>>()
        };
        parts.iter().flat_map(of).collect()
    }

    /// Σ|k| over the terms of coefficient `m` and their number: what its evaluation can round by.
    pub fn magnitude(&self, m: usize) -> (f64, usize) {
        let terms = self.terms(m);
        (terms.iter().map(|t| t.1.abs()).sum(), terms.len())
    }
}

/// Most functions of a model whose products of three factors are looked at.
const MANY: usize = 1000;

/// Products of two functions of first degree and, where `most` is 3, of three that move disjoint sets of joints, as far
/// as their expansions stay within the functions of the exact model.
pub fn products(lagrangian: &Lagrangian, most: usize) -> Vec<CandidateFunction> {
    let index: BTreeMap<Function, usize> =
        lagrangian.functions.iter().enumerate().map(|(l, &psi)| (psi, l)).collect();
    let within = |terms: &BTreeMap<Function, f64>| -> Option<Combination> {
        let mut out: Combination = Vec::new();
        for (psi, &k) in terms.iter().filter(|(_, k)| **k != 0.0) {
            out.push((*index.get(psi)?, k));
        }
        out.sort_by_key(|&(l, _)| l);
        (!out.is_empty()).then_some(out)
    };
    let functions = &lagrangian.functions;
    let first: Vec<usize> = (0..functions.len()).filter(|&l| functions[l].is_first_degree()).collect();
    let mut out = Vec::new();
    for (place, &i) in first.iter().enumerate() {
        for &j in &first[place..] {
            let pair = functions[i].times(&functions[j]);
            if let Some(expansion) = within(&pair) {
                out.push(CandidateFunction { factors: vec![i, j], expansion });
            }
            if most < 3 || functions.len() > MANY || !functions[i].is_disjoint(&functions[j]) {
                continue;
            }
            for &l in first.iter().filter(|&&l| l > j) {
                if !functions[l].is_disjoint(&functions[i]) || !functions[l].is_disjoint(&functions[j]) {
                    continue;
                }
                let mut triple: BTreeMap<Function, f64> = BTreeMap::new();
                for (psi, k) in &pair {
                    for (product, c) in psi.times(&functions[l]) {
                        *triple.entry(product).or_insert(0.0) += k * c;
                    }
                }
                if let Some(expansion) = within(&triple) {
                    let mut factors = vec![i, j, l];
                    // The far joints' product first: more products of three share it.
                    factors.sort_by_key(|&l| (functions[l].leading_joint(), l));
                    out.push(CandidateFunction { factors, expansion });
                }
            }
        }
    }
    out
}
