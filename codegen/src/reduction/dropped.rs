//! The exact model of a simpler arm in place of the arm's own.

use std::collections::BTreeMap;

use super::{Reduced, plus};
use crate::arm::Arm;
use crate::lagrangian::{Combination, Entry, Lagrangian};

/// Coefficients nearer to the exact ones than this part of the largest term differ by rounding alone.
const SAME: f64 = 1e-13;
/// Terms below this part of the largest may be missing on one side: the expansion drops them.
const NOISE: f64 = 4e-12;

/// An arm with other inertial parameters, many of them zero, whose exact model stands for the arm's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// It.
    pub arm: Arm,
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

/// The model of `arm`, expanded as `own`, over the functions and coefficients of `lagrangian`, and what each
/// combination lacks of it.
///
/// `None` where `own` has an entry or a function that `lagrangian` lacks, or where entries that are one coefficient there
/// differ.
pub fn without(lagrangian: &Lagrangian, own: &Lagrangian, arm: &Arm) -> Option<(Reduced, Vec<f64>)> {
    let terms = lagrangian.coefficients.iter().flat_map(|c| &c.terms);
    let largest = terms.fold(0.0_f64, |most, term| most.max(term.1.abs()));
    let noise = NOISE * largest;
    let mut entries: BTreeMap<Entry, (usize, f64)> = BTreeMap::new();
    let mut expressed: Vec<(Combination, f64)> = Vec::new();
    for (index, coefficient) in own.coefficients.iter().enumerate() {
        let mut known = Combination::new();
        let mut lost = 0.0;
        for &(l, k) in &coefficient.terms {
            match lagrangian.functions.binary_search(&own.functions[l]) {
                Ok(place) => known.push((place, k)),
                Err(_) if k.abs() <= noise => lost += k.abs(),
                Err(_) => return None,
            }
        }
        expressed.push((known, lost));
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
                    let (known, missing) = &expressed[index];
                    lost = lost.max(own.truncation + missing);
                    known.iter().map(|&(l, k)| (l, place.sign * sign * k)).collect()
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
        let differs = apart.iter().any(|term| term.1.abs() > SAME * largest);
        combinations.push(if differs { chosen } else { coefficient.terms.clone() });
        simplified.push(differs);
        lacking.push(lost);
    }
    let stray = |index: usize| expressed[index].0.iter().any(|term| term.1.abs() > noise);
    if entries.values().any(|&(index, _)| stray(index)) {
        return None;
    }
    let dropped = Dropped { arm: arm.clone(), rounding: vec![0.0; lacking.len()], parameters: Vec::new() };
    let reduced = Reduced {
        selected: Vec::new(),
        combinations,
        simplified,
        sparse: None,
        variations: Vec::new(),
        dropped: Some(dropped),
    };
    Some((reduced, lacking))
}
