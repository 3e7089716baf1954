//! The exact model of a simpler arm in place of the arm's own.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::plus;
use crate::lagrangian::{Combination, Entry, Lagrangian};

/// What two expansions of the same coefficient may differ by, in units of what their terms can be told from: how much of a
/// simpler arm's parameters cancels is not what cancels in the arm itself.
const SAME: f64 = 16.0;

/// What is left out where the exact model of another arm stands for that of the arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimplifiedArm {
    /// What its recursion may be off by in f64, by coefficient: rounding, and terms that the expansion lacks.
    pub rounding: Vec<f64>,
    /// The parameters that it lacks, in words.
    pub parameters: Vec<String>,
}

impl SimplifiedArm {
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
    let mut entries: BTreeMap<Entry, (usize, f64)> = BTreeMap::new();
    for (index, coefficient) in own.coefficients.iter().enumerate() {
        entries.extend(coefficient.places.iter().map(|place| (place.entry, (index, place.sign))));
    }
    let mut out = Expressed { combinations: Vec::new(), simplified: Vec::new(), lacking: Vec::new() };
    for coefficient in &lagrangian.coefficients {
        let resolution = coefficient.accuracy().resolution;
        let mut chosen: Option<(Combination, f64)> = None;
        for place in &coefficient.places {
            let (here, noise, error) = match entries.remove(&place.entry) {
                Some((index, sign)) => {
                    let known = &own.coefficients[index];
                    let noise = SAME * (resolution + known.accuracy().resolution);
                    let (terms, lost) = renumbered(lagrangian, own, &known.terms, place.sign * sign, noise)?;
                    (terms, noise, known.accuracy().error + lost)
                }
                None => (Combination::new(), SAME * resolution, coefficient.accuracy().error),
            };
            match &mut chosen {
                None => chosen = Some((here, error)),
                Some((first, lost)) => {
                    let apart = plus(first, -1.0, &here);
                    if apart.iter().any(|term| term.1.abs() > noise) {
                        return None;
                    }
                    *lost = lost.max(error) + apart.iter().map(|term| term.1.abs()).sum::<f64>();
                }
            }
        }
        let (chosen, lost) = chosen.unwrap_or_default();
        let apart = plus(&coefficient.terms, -1.0, &chosen);
        let differs = apart.iter().any(|term| term.1.abs() > SAME * resolution);
        // Where it does not differ, what it seems to differ by is still there.
        let hidden: f64 = if differs { 0.0 } else { apart.iter().map(|term| term.1.abs()).sum() };
        out.combinations.push(if differs { chosen } else { coefficient.terms.clone() });
        out.simplified.push(differs);
        out.lacking.push(lost + hidden);
    }
    // Entries that the exact model lacks.
    let stray = |index: usize| {
        let coefficient = &own.coefficients[index];
        coefficient.terms.iter().any(|term| term.1.abs() > SAME * coefficient.accuracy().resolution)
    };
    let none_strays = !entries.values().any(|&(index, _)| stray(index));
    none_strays.then_some(out)
}

/// Terms over the functions of `own`, times `sign`, over those of `lagrangian`, and the sum of the magnitudes that have no
/// place there; `None` where one of these is no `noise`.
fn renumbered(
    lagrangian: &Lagrangian,
    own: &Lagrangian,
    terms: &Combination,
    sign: f64,
    noise: f64,
) -> Option<(Combination, f64)> {
    let mut out = Combination::new();
    let mut lost = 0.0;
    for &(l, k) in terms {
        match lagrangian.functions.binary_search(&own.functions[l]) {
            Ok(place) => out.push((place, sign * k)),
            Err(_) if k.abs() <= noise => lost += k.abs(),
            Err(_) => return None,
        }
    }
    Some((out, lost))
}
