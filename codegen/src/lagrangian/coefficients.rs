//! The set of distinct coefficients, up to sign.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;

use super::{Combination, Function, Lagrangian};

/// An entry of the model (1); indices from 0, printed from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// The entry.
    pub entry: Entry,
    /// +1 or −1.
    pub sign: f64,
}

/// One distinct coefficient α_m of the model; with uncertain parameters u it is α_m + Σ_k u_k ∂α_m/∂u_k.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    /// Its terms.
    pub terms: Combination,
    /// ∂α_m/∂u_k for each uncertain parameter; none where the arm is known.
    pub variations: Vec<Combination>,
    /// Where it stands.
    pub places: Vec<Place>,
    /// What the terms may be off by, and what each of the variations may be, in this order.
    pub errors: Vec<Accuracy>,
}

/// How well an expansion is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Terms up to this magnitude cannot be told from rounding.
    pub resolution: f64,
    /// The expansion differs from the function by a sum of terms whose magnitudes sum to no more: those that were dropped,
    /// and the rounding of those that were kept.
    pub error: f64,
}

impl Accuracy {
    /// Of a sum, each part times a factor.
    pub(super) fn sum(parts: impl Iterator<Item = (f64, Self)>) -> Self {
        parts.fold(Self::default(), |sum, (factor, part)| Self {
            resolution: sum.resolution + factor.abs() * part.resolution,
            error: sum.error + factor.abs() * part.error,
        })
    }
}

impl Coefficient {
    /// How well its own terms are known.
    pub fn accuracy(&self) -> Accuracy {
        self.errors.first().copied().unwrap_or_default()
    }

    /// What the derivative by uncertain parameter `k` may be off by, as [`Accuracy::error`].
    pub fn variation_error(&self, k: usize) -> f64 {
        self.errors.get(k + 1).map_or(0.0, |accuracy| accuracy.error)
    }

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
    pub layers: Vec<Combination>,
    /// By layer.
    pub errors: Vec<Accuracy>,
}

/// Gathers the entries, over `functions`, into distinct coefficients and numbers the functions that remain anew. What twins
/// differ by is added to the error of the one that is kept.
pub(super) fn distinct(dof: usize, functions: &[Function], entries: Vec<Layers>) -> Lagrangian {
    let mut kept: Vec<(Layers, Vec<Place>)> = Vec::new();
    let mut vanishing = Vec::new();
    for entry in entries {
        if entry.layers.iter().all(Combination::is_empty) {
            vanishing.push((entry.entry, entry.errors));
            continue;
        }
        let twin = kept
            .iter_mut()
            .find_map(|(known, places)| same_up_to_sign(known, &entry).map(|sign| (sign, known, places)));
        match twin {
            Some((sign, known, places)) => {
                for (layer, accuracy) in known.errors.iter_mut().enumerate() {
                    let other = entry.errors[layer];
                    accuracy.resolution = accuracy.resolution.max(other.resolution);
                    let apart = difference(&known.layers[layer], &entry.layers[layer], sign);
                    accuracy.error = accuracy.error.max(other.error + apart);
                }
                places.push(Place { entry: entry.entry, sign });
            }
            None => {
                let place = Place { entry: entry.entry, sign: 1.0 };
                kept.push((entry, vec![place]));
            }
        }
    }
    kept.iter_mut().for_each(|(entry, places)| orient(&mut entry.layers, places));
    let mut occurs = vec![false; functions.len()];
    kept.iter().flat_map(|(entry, _)| entry.layers.iter().flatten()).for_each(|&(l, _)| occurs[l] = true);
    let mut index = vec![0; functions.len()];
    let mut left: Vec<Function> = Vec::new();
    for (l, psi) in functions.iter().enumerate().filter(|&(l, _)| occurs[l]) {
        index[l] = left.len();
        left.push(*psi);
    }
    let combination = |mut terms: Combination| -> Combination {
        terms.iter_mut().for_each(|term| term.0 = index[term.0]);
        terms
    };
    let coefficients = kept
        .into_iter()
        .map(|(Layers { layers, errors, .. }, places)| {
            let mut layers = layers.into_iter().map(combination);
            let terms = layers.next().unwrap_or_default();
            Coefficient { terms, variations: layers.collect(), places, errors }
        })
        .collect();
    Lagrangian { dof, functions: left, coefficients, ranges: Vec::new(), vanishing }
}

/// Turns the coefficient so that its largest term, the first of equal ones, is positive: then sums rarely begin with
/// a sign, and names do not depend on what a reduction does to the smaller terms.
fn orient(layers: &mut [Combination], places: &mut [Place]) {
    let Some(first) = layers.iter().find(|layer| !layer.is_empty()) else { return };
    let largest = first
        .iter()
        .fold(0.0, |best: f64, &(_, k)| if k.abs() > best.abs() * (1.0 + 1e-9) { k } else { best });
    if largest < 0.0 {
        layers.iter_mut().flatten().for_each(|(_, k)| *k = -*k);
        places.iter_mut().for_each(|place| place.sign = -place.sign);
    }
}

/// Σ|a − sign b| over all terms.
fn difference(a: &Combination, b: &Combination, sign: f64) -> f64 {
    let mut sum = 0.0;
    joined(a, b, |a, b| {
        sum += (a - sign * b).abs();
        true
    });
    sum
}

/// +1 or −1 where every layer of `b` is ± that of `a` to rounding, with the same sign.
fn same_up_to_sign(a: &Layers, b: &Layers) -> Option<f64> {
    let first = |entry: &Layers| entry.layers.iter().find_map(|layer| Some(layer.first()?.1));
    let sign = if (first(a)? < 0.0) == (first(b)? < 0.0) { 1.0 } else { -1.0 };
    let near = |layer: usize| {
        let tolerance = a.errors[layer].resolution + b.errors[layer].resolution;
        joined(&a.layers[layer], &b.layers[layer], |a, b| (a - sign * b).abs() <= tolerance)
    };
    (0..a.layers.len()).all(near).then_some(sign)
}

/// Whether `holds` of what multiplies each function in `a` and in `b`, by ascending function up to the first where it does not.
fn joined(a: &Combination, b: &Combination, mut holds: impl FnMut(f64, f64) -> bool) -> bool {
    let mut rest = b.iter().peekable();
    for &(l, k) in a {
        while let Some(&(_, other)) = rest.next_if(|term| term.0 < l) {
            if !holds(0.0, other) {
                return false;
            }
        }
        let other = rest.next_if(|term| term.0 == l).map_or(0.0, |term| term.1);
        if !holds(k, other) {
            return false;
        }
    }
    rest.all(|&(_, other)| holds(0.0, other))
}
