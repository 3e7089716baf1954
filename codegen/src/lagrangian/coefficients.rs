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

impl Entry {
    /// The entries of a model of `n` joints: d before h before g.
    pub fn all(n: usize) -> impl Iterator<Item = Self> {
        let pairs = move || (0..n).flat_map(move |j| (j..n).map(move |k| (j, k)));
        let d = pairs().map(|(i, j)| Entry::D(i, j));
        let h = (0..n).flat_map(move |i| pairs().map(move |(j, k)| Entry::H(i, j, k)));
        d.chain(h).chain((0..n).map(Entry::G))
    }
}

/// A place where a coefficient stands, and the sign it has there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The entry.
    pub entry: Entry,
    /// +1 or −1.
    pub sign: f64,
}

/// One distinct coefficient α_m of the model; with uncertain parameters u it is α_m + Σ_k u_k ∂α_m/∂u_k.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficient {
    /// Its terms.
    pub terms: Combination,
    /// ∂α_m/∂u_k for each uncertain parameter; none where the arm is known.
    pub variations: Vec<Combination>,
    /// Where it stands.
    pub places: Vec<Place>,
}

impl Coefficient {
    /// Number of functions in α_m, whatever the uncertain parameters are.
    pub fn width(&self) -> usize {
        let functions = [&self.terms].into_iter().chain(&self.variations).flatten();
        functions.map(|&(l, _)| l).collect::<BTreeSet<_>>().len()
    }

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

/// An entry of the model with its derivatives by the uncertain parameters.
pub(super) struct Layers {
    pub entry: Entry,
    /// At the arm's own parameters first, then by each parameter.
    pub layers: Vec<Expansion>,
}

/// Gathers the entries into distinct coefficients and numbers the functions that remain. `truncation` is what each
/// layer of the entries lacks already; what twins differ by is added to it.
pub(super) fn distinct(dof: usize, entries: Vec<Layers>, mut truncation: Vec<f64>) -> Lagrangian {
    let largest: Vec<f64> = (0..truncation.len())
        .map(|layer| {
            let values = entries.iter().flat_map(|e| e.layers[layer].values());
            values.fold(0.0, |m: f64, k| m.max(k.abs()))
        })
        .collect();
    let mut merged = vec![0.0_f64; truncation.len()];
    let mut kept: Vec<(Vec<Expansion>, Vec<Place>)> = Vec::new();
    for Layers { entry, layers } in entries {
        if layers.iter().all(Expansion::is_empty) {
            continue;
        }
        let twin = kept.iter_mut().find_map(|(known, places)| {
            same_up_to_sign(known, &layers, &largest).map(|sign| (sign, &*known, places))
        });
        match twin {
            Some((sign, known, places)) => {
                for (merged, (a, b)) in merged.iter_mut().zip(known.iter().zip(&layers)) {
                    *merged = merged.max(difference(a, b, sign));
                }
                places.push(Place { entry, sign });
            }
            None => kept.push((layers, vec![Place { entry, sign: 1.0 }])),
        }
    }
    kept.iter_mut().for_each(|(layers, places)| orient(layers, places));
    let functions: BTreeSet<Function> =
        kept.iter().flat_map(|(layers, _)| layers.iter().flat_map(|e| e.keys().copied())).collect();
    let index: BTreeMap<Function, usize> = functions.iter().enumerate().map(|(l, &f)| (f, l)).collect();
    let combination = |expansion: Expansion| -> Combination {
        expansion.into_iter().filter_map(|(f, k)| Some((*index.get(&f)?, k))).collect()
    };
    let coefficients = kept
        .into_iter()
        .map(|(layers, places)| {
            let mut layers = layers.into_iter().map(combination);
            let terms = layers.next().unwrap_or_default();
            Coefficient { terms, variations: layers.collect(), places }
        })
        .collect();
    truncation.iter_mut().zip(merged).for_each(|(lost, merged)| *lost += merged);
    Lagrangian {
        dof,
        functions: functions.into_iter().collect(),
        coefficients,
        truncation: truncation.remove(0),
        ranges: Vec::new(),
        variation_truncation: truncation,
    }
}

/// Turns the coefficient so that its largest term, the first of equal ones, is positive: then sums rarely begin with
/// a sign, and names do not depend on what a reduction does to the smaller terms.
fn orient(layers: &mut [Expansion], places: &mut [Place]) {
    let Some(first) = layers.iter().find(|layer| !layer.is_empty()) else { return };
    let largest =
        first.values().fold(0.0, |best: f64, &k| if k.abs() > best.abs() * (1.0 + 1e-9) { k } else { best });
    if largest < 0.0 {
        layers.iter_mut().flat_map(|layer| layer.values_mut()).for_each(|k| *k = -*k);
        places.iter_mut().for_each(|place| place.sign = -place.sign);
    }
}

/// Σ|a − sign b| over all terms.
fn difference(a: &Expansion, b: &Expansion, sign: f64) -> f64 {
    let of = |e: &Expansion, f: &Function| e.get(f).copied().unwrap_or(0.0);
    let functions: BTreeSet<&Function> = a.keys().chain(b.keys()).collect();
    functions.into_iter().map(|f| (of(a, f) - sign * of(b, f)).abs()).sum()
}

/// +1 or −1 where every layer of `b` is ± that of `a` to rounding, with the same sign.
fn same_up_to_sign(a: &[Expansion], b: &[Expansion], largest: &[f64]) -> Option<f64> {
    let first = |layers: &[Expansion]| layers.iter().find_map(|layer| layer.values().next().copied());
    let sign = if (first(a)? < 0.0) == (first(b)? < 0.0) { 1.0 } else { -1.0 };
    let near = |((a, b), largest): ((&Expansion, &Expansion), &f64)| {
        let own = a.values().fold(0.0, |m: f64, k| m.max(k.abs()));
        let tolerance = 1e-13 * largest + 1e-12 * own;
        let within = |x: &Expansion, y: &Expansion| {
            x.iter().all(|(f, k)| (k - sign * y.get(f).copied().unwrap_or(0.0)).abs() <= tolerance)
        };
        within(a, b) && within(b, a)
    };
    a.iter().zip(b).zip(largest).all(near).then_some(sign)
}
