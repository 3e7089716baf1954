//! The model in absolute angles: where joints turn about parallel axes, each link's angle against the first of them.
//!
//! With θ̇ = T q̇ and S = T⁻¹ the same torque is τ = Tᵀ τ', where D' = Sᵀ D S, h'_abc = Σ S_ia S_jb S_kc h_ijk and
//! G' = Sᵀ G. Of two parallel links D' has one entry that moves where D has three.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::coefficients::{Accuracy, Entry, Layers, distinct};
use super::{Combination, Lagrangian};
use crate::arm::{Arm, JointKind};

/// Angular velocities of links in place of joint velocities.
///
/// Holds: invertible for any signs, whatever the arm; that axes are parallel makes coefficients short, nothing else.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Coordinates {
    /// By joint i: the σ in θ̇_i = q̇_i + σ θ̇_{i−1}, which is 1 or −1 for axes that point the same or the opposite way,
    /// and 0 where θ̇_i = q̇_i.
    pub onto: Vec<i8>,
}

impl Coordinates {
    /// Those of an arm; `None` where no two neighbouring joints turn about parallel axes, or joints follow others.
    pub fn of(arm: &Arm) -> Option<Self> {
        if arm.linkage.is_some() {
            return None;
        }
        let turns = |i: usize| arm.joints[i].kind == JointKind::Revolute;
        let sign = |i: usize| {
            let pose = &arm.joints[i].pose;
            if i == 0 || !turns(i - 1) || !turns(i) || !pose.is_along_z() {
                0
            } else if pose.rotation[2][2] > 0.0 {
                1
            } else {
                -1
            }
        };
        let onto: Vec<i8> = (0..arm.dof()).map(sign).collect();
        onto.iter().any(|&sign| sign != 0).then_some(Self { onto })
    }

    /// The non-zero entries of row `a` of T: θ̇_a = Σ T_aj q̇_j.
    pub fn row(&self, a: usize) -> Vec<(usize, i8)> {
        let mut out = vec![(a, 1)];
        let (mut j, mut sign) = (a, 1);
        while self.onto[j] != 0 {
            sign *= self.onto[j];
            j -= 1;
            out.push((j, sign));
        }
        out
    }

    /// The non-zero entries of column `i` of T: τ_i = Σ T_ai τ'_a.
    pub fn column(&self, i: usize) -> Vec<(usize, i8)> {
        let mut out = vec![(i, 1)];
        let mut sign = 1;
        for a in i + 1..self.onto.len() {
            sign *= self.onto[a];
            if sign == 0 {
                break;
            }
            out.push((a, sign));
        }
        out
    }

    /// The non-zero entries of column `a` of S.
    fn back(&self, a: usize) -> Vec<(usize, i8)> {
        let next = self.onto.get(a + 1).copied().filter(|&sign| sign != 0);
        [(a, 1)].into_iter().chain(next.map(|sign| (a + 1, -sign))).collect()
    }
}

/// A model in absolute angles beside the one in joint angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Absolute {
    /// What the angles are.
    pub coordinates: Coordinates,
    /// The model there, over the same functions.
    pub lagrangian: Lagrangian,
    /// For each coefficient of the model in joint angles the coefficients of [`Absolute::lagrangian`] that it is the sum
    /// of, with their integer factors.
    pub parts: Vec<Vec<(usize, f64)>>,
}

impl Absolute {
    /// Of a model whose parameters are all known.
    ///
    /// `None` where entries that are one coefficient in joint angles, or zero there, are different sums in absolute
    /// angles: a reduction would make them differ.
    pub fn new(known: &Lagrangian, coordinates: Coordinates) -> Option<Self> {
        let joint = table(known);
        let n = known.dof;
        let transformed = |entry: Entry| {
            let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
            for (entry, sign) in spread(entry, |a| coordinates.back(a)) {
                let Some(&(m, own)) = joint.get(&entry) else { continue };
                for &(l, k) in &known.coefficients[m].terms {
                    *sum.entry(l).or_insert(0.0) += f64::from(sign) * own * k;
                }
            }
            sum
        };
        let sums: Vec<(Entry, BTreeMap<usize, f64>)> =
            Entry::all(n).map(|entry| (entry, transformed(entry))).collect();
        let accuracy = |entry: Entry| {
            let parts = spread(entry, |a| coordinates.back(a));
            let known = |(entry, sign): (Entry, i8)| {
                joint.get(&entry).map(|&(m, _)| (f64::from(sign), known.coefficients[m].accuracy()))
            };
            Accuracy::sum(parts.into_iter().filter_map(known))
        };
        let layers = sums
            .into_iter()
            .map(|(entry, sum)| {
                let accuracy = accuracy(entry);
                let layer = sum.into_iter().filter(|(_, k)| k.abs() > accuracy.resolution).collect();
                Layers { entry, layers: vec![layer], errors: vec![accuracy] }
            })
            .collect();
        let lagrangian = distinct(n, &known.functions, layers).over(&known.functions);
        let own = table(&lagrangian);
        let mut parts: Vec<Option<Vec<(usize, f64)>>> = vec![None; known.coefficients.len()];
        for entry in Entry::all(n) {
            let (m, place) = joint.get(&entry).map_or((None, 1.0), |&(m, sign)| (Some(m), sign));
            let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
            for (entry, sign) in spread(entry, |i| coordinates.column(i)) {
                if let Some(&(s, turned)) = own.get(&entry) {
                    *sum.entry(s).or_insert(0.0) += place * turned * f64::from(sign);
                }
            }
            let here: Vec<(usize, f64)> = sum.into_iter().filter(|part| part.1 != 0.0).collect();
            let known = match m {
                Some(m) => parts[m].get_or_insert_with(|| here.clone()),
                None => &Vec::new(),
            };
            if *known != here {
                return None;
            }
        }
        let parts = parts.into_iter().map(Option::unwrap_or_default).collect();
        Some(Self { coordinates, lagrangian, parts })
    }
}

/// Where each entry of the model stands, and its sign there.
fn table(lagrangian: &Lagrangian) -> BTreeMap<Entry, (usize, f64)> {
    let of = |(m, c): (usize, &super::Coefficient)| {
        c.places.iter().map(|place| (place.entry, (m, place.sign))).collect::<Vec<_>>()
    };
    lagrangian.coefficients.iter().enumerate().flat_map(of).collect()
}

/// The entries that one in other coordinates is the sum of, with signs: every index turned into those that `of` gives.
fn spread(entry: Entry, of: impl Fn(usize) -> Vec<(usize, i8)>) -> Vec<(Entry, i8)> {
    match entry {
        Entry::D(i, j) => pairs(&of(i), &of(j)).map(|(i, j, sign)| (d(i, j), sign)).collect(),
        Entry::H(i, j, k) => {
            let rows = of(i);
            let row = |(j, k, sign): (usize, usize, i8)| {
                rows.iter().map(move |&(i, own)| (h(i, j, k), own * sign)).collect::<Vec<_>>()
            };
            pairs(&of(j), &of(k)).flat_map(row).collect()
        }
        Entry::G(i) => of(i).into_iter().map(|(i, sign)| (Entry::G(i), sign)).collect(),
    }
}

/// Each of `a` with each of `b`, and the product of their signs.
fn pairs(a: &[(usize, i8)], b: &[(usize, i8)]) -> impl Iterator<Item = (usize, usize, i8)> {
    a.iter().flat_map(move |&(i, s)| b.iter().map(move |&(j, t)| (i, j, s * t)))
}

fn d(i: usize, j: usize) -> Entry {
    Entry::D(i.min(j), i.max(j))
}

fn h(i: usize, j: usize, k: usize) -> Entry {
    Entry::H(i, j.min(k), j.max(k))
}

impl Lagrangian {
    /// The same model with the numbers of `functions`, which hold all of its own.
    fn over(mut self, functions: &[super::Function]) -> Self {
        let new: Vec<usize> =
            self.functions.iter().map(|psi| functions.binary_search(psi).unwrap_or_default()).collect();
        let renumber = |terms: &mut Combination| terms.iter_mut().for_each(|term| term.0 = new[term.0]);
        for coefficient in &mut self.coefficients {
            renumber(&mut coefficient.terms);
        }
        self.functions = functions.to_vec();
        self
    }
}
