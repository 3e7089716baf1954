//! The set of distinct coefficients, up to sign.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::expand::Expansion;
use super::{Combination, Function, Lagrangian};

/// An entry of the model (1); indices from 0, printed from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Entry {
    /// d_ij with i ≤ j; it stands for d_ji too.
    D(usize, usize),
    /// h_ijk with j ≤ k; it stands for h_ikj too.
    H(usize, usize, usize),
    /// g_i.
    G(usize),
}

/// A place where a coefficient stands, and the sign it has there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The entry.
    pub entry: Entry,
    /// +1 or −1.
    pub sign: f64,
}

/// One distinct coefficient α_m of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficient {
    /// Its terms.
    pub terms: Combination,
    /// Where it stands.
    pub places: Vec<Place>,
}

impl Coefficient {
    /// The first place with sign +1, after which the coefficient is named: `d12`, `h112`, `g3`; `minus_h112`
    /// where it stands with sign −1 only. The same for every reduced model of an arm.
    pub fn name(&self) -> String {
        let positive = self.places.iter().find(|place| place.sign > 0.0);
        match (positive, self.places.first()) {
            (Some(place), _) => place.entry.to_string(),
            (None, Some(place)) => format!("minus_{}", place.entry),
            (None, None) => String::new(),
        }
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Entry::D(i, j) => write!(f, "d{}{}", i + 1, j + 1),
            Entry::H(i, j, k) => write!(f, "h{}{}{}", i + 1, j + 1, k + 1),
            Entry::G(i) => write!(f, "g{}", i + 1),
        }
    }
}

/// Gathers the entries into distinct coefficients and numbers the functions that remain. `truncation` is what the
/// entries lack already; what twins differ by is added to it.
pub(super) fn distinct(dof: usize, entries: Vec<(Entry, Expansion)>, truncation: f64) -> Lagrangian {
    let mut merged: f64 = 0.0;
    let largest = entries.iter().flat_map(|(_, e)| e.values()).fold(0.0, |m: f64, k| m.max(k.abs()));
    let mut kept: Vec<(Expansion, Vec<Place>)> = Vec::new();
    for (entry, expansion) in entries {
        if expansion.is_empty() {
            continue;
        }
        let twin = kept.iter_mut().find_map(|(known, places)| {
            same_up_to_sign(known, &expansion, largest).map(|sign| (sign, &*known, places))
        });
        match twin {
            Some((sign, known, places)) => {
                merged = merged.max(difference(known, &expansion, sign));
                places.push(Place { entry, sign });
            }
            None => kept.push((expansion, vec![Place { entry, sign: 1.0 }])),
        }
    }
    kept.iter_mut().for_each(|(expansion, places)| orient(expansion, places));
    let functions: BTreeSet<Function> = kept.iter().flat_map(|(e, _)| e.keys().copied()).collect();
    let index: BTreeMap<Function, usize> = functions.iter().enumerate().map(|(l, &f)| (f, l)).collect();
    let coefficients = kept
        .into_iter()
        .map(|(expansion, places)| Coefficient {
            terms: expansion.into_iter().filter_map(|(f, k)| Some((*index.get(&f)?, k))).collect(),
            places,
        })
        .collect();
    Lagrangian {
        dof,
        functions: functions.into_iter().collect(),
        coefficients,
        truncation: truncation + merged,
    }
}

/// Turns the coefficient so that its largest term, the first of equal ones, is positive: then sums rarely begin with
/// a sign, and names do not depend on what a reduction does to the smaller terms.
fn orient(expansion: &mut Expansion, places: &mut [Place]) {
    let largest = expansion
        .values()
        .fold(0.0, |best: f64, &k| if k.abs() > best.abs() * (1.0 + 1e-9) { k } else { best });
    if largest < 0.0 {
        expansion.values_mut().for_each(|k| *k = -*k);
        places.iter_mut().for_each(|place| place.sign = -place.sign);
    }
}

/// Σ|a − sign b| over all terms.
fn difference(a: &Expansion, b: &Expansion, sign: f64) -> f64 {
    let of = |e: &Expansion, f: &Function| e.get(f).copied().unwrap_or(0.0);
    let functions: BTreeSet<&Function> = a.keys().chain(b.keys()).collect();
    functions.into_iter().map(|f| (of(a, f) - sign * of(b, f)).abs()).sum()
}

/// +1 or −1 where `b` is ±`a` to rounding.
fn same_up_to_sign(a: &Expansion, b: &Expansion, largest: f64) -> Option<f64> {
    let ((_, first_a), (_, first_b)) = (a.iter().next()?, b.iter().next()?);
    let sign = if (*first_a < 0.0) == (*first_b < 0.0) { 1.0 } else { -1.0 };
    let own = a.values().fold(0.0, |m: f64, k| m.max(k.abs()));
    let tolerance = 1e-13 * largest + 1e-12 * own;
    let near = |x: &Expansion, y: &Expansion| {
        x.iter().all(|(f, k)| (k - sign * y.get(f).copied().unwrap_or(0.0)).abs() <= tolerance)
    };
    (near(a, b) && near(b, a)).then_some(sign)
}
