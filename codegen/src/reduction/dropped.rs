//! The exact model of a simpler arm in place of the arm's own.

use std::collections::BTreeMap;

use super::plus;
use crate::lagrangian::{Combination, Entry, Lagrangian};

/// Coefficients nearer to the exact ones than this part of the largest term, and than ten times this part of their own,
/// differ by rounding alone.
const SAME: f64 = 1e-13;
/// Terms below this part of the largest may be missing on one side: the expansion drops them.
const NOISE: f64 = 4e-12;

/// Entries that the exact model lacks may have terms below this part of the largest.
const STRAY: f64 = 1e-12;

/// What is left out where the exact model of another arm stands for that of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// What its recursion may be off by in f64, by coefficient: rounding, and terms that the expansion lacks.
    pub rounding: Vec<f64>,
    /// The parameters that it lacks, in words.
    pub parameters: Vec<String>,
}

impl Dropped {
    /// What is left out, as a list; where nothing is, parameters were made equal.
    pub fn lost(&self) -> String {
        if self.parameters.is_empty() {
            "differences between some of them".to_string()
        } else {
            self.parameters.join(", ")
        }
    }
}

/// A model over the functions and coefficients of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Expressed {
    /// α̂_m by index.
    pub combinations: Vec<Combination>,
    /// Whether that differs from α_m.
    pub simplified: Vec<bool>,
    /// What each combination lacks of the model, as a sum of magnitudes.
    pub lacking: Vec<f64>,
}

/// The model `own` of another arm over the functions and coefficients of `lagrangian`.
///
/// `None` where `own` has an entry or a function that `lagrangian` lacks, or where entries that are one coefficient there
/// differ.
pub fn expressed(lagrangian: &Lagrangian, own: &Lagrangian) -> Option<Expressed> {
    let terms = lagrangian.coefficients.iter().flat_map(|c| &c.terms);
    let largest = terms.fold(0.0_f64, |most, term| most.max(term.1.abs()));
    let noise = NOISE * largest;
    let mut entries: BTreeMap<Entry, (usize, f64)> = BTreeMap::new();
    let mut known: Vec<(Combination, f64)> = Vec::new();
    for (index, coefficient) in own.coefficients.iter().enumerate() {
        let mut terms = Combination::new();
        let mut lost = 0.0;
        for &(l, k) in &coefficient.terms {
            match lagrangian.functions.binary_search(&own.functions[l]) {
                Ok(place) => terms.push((place, k)),
                Err(_) if k.abs() <= noise => lost += k.abs(),
                Err(_) => return None,
            }
        }
        known.push((terms, lost));
        entries.extend(coefficient.places.iter().map(|place| (place.entry, (index, place.sign))));
    }
    let mut combinations = Vec::new();
    let mut simplified = Vec::new();
    let mut lacking = Vec::new();
    for coefficient in &lagrangian.coefficients {
        let mut chosen: Option<Combination> = None;
        let mut lost = own.truncation;
        for place in &coefficient.places {
            let here = match entries.remove(&place.entry) {
                Some((index, sign)) => {
                    let (terms, missing) = &known[index];
                    lost = lost.max(own.truncation + missing);
                    terms.iter().map(|&(l, k)| (l, place.sign * sign * k)).collect()
                }
                None => Combination::new(),
            };
            match &chosen {
                None => chosen = Some(here),
                Some(first) => {
                    let apart = plus(first, -1.0, &here);
                    if apart.iter().any(|term| term.1.abs() > noise) {
                        return None;
                    }
                    lost += apart.iter().map(|term| term.1.abs()).sum::<f64>();
                }
            }
        }
        let chosen = chosen.unwrap_or_default();
        let apart = plus(&coefficient.terms, -1.0, &chosen);
        let own = coefficient.terms.iter().fold(0.0_f64, |most, term| most.max(term.1.abs()));
        let same = SAME * largest.min(10.0 * own);
        let differs = apart.iter().any(|term| term.1.abs() > same);
        combinations.push(if differs { chosen } else { coefficient.terms.clone() });
        simplified.push(differs);
        lacking.push(lost);
    }
    let stray = |index: usize| known[index].0.iter().any(|term| term.1.abs() > STRAY * largest);
    let none_strays = !entries.values().any(|&(index, _)| stray(index));
    none_strays.then_some(Expressed { combinations, simplified, lacking })
}
