//! The model in absolute angles: where joints turn about parallel axes, each link's angle against the first of them.
//!
//! With θ̇ = T q̇ and S = T⁻¹ the same torque is τ = Tᵀ τ', where D' = Sᵀ D S, h'_abc = Σ S_ia S_jb S_kc h_ijk and
//! G' = Sᵀ G. Of two parallel links D' has one entry that moves where D has three.

use std::collections::BTreeMap;

use super::coefficients::{Entry, Layers, distinct};
use super::expand::{Expansion, NEGLIGIBLE};
use super::{Combination, Lagrangian};
use crate::arm::{Arm, JointKind};

/// Angular velocities of links in place of joint velocities.
///
/// Holds: invertible for any signs, whatever the arm; that axes are parallel makes coefficients short, nothing else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinates {
    /// By joint i: the σ in θ̇_i = q̇_i + σ θ̇_{i−1}, which is 1 or −1 for axes that point the same or the opposite way,
    /// and 0 where θ̇_i = q̇_i.
    pub onto: Vec<i8>,
}

impl Coordinates {
    /// Those of an arm; `None` where no two neighbouring joints turn about parallel axes.
    pub fn of(arm: &Arm) -> Option<Self> {
        let turns = |i: usize| arm.joints[i].kind == JointKind::Revolute;
        let sign = |i: usize| {
            let along = arm.joints[i].pose.rotation[2][2];
            if i == 0 || !turns(i - 1) || !turns(i) || along.abs() != 1.0 {
                0
            } else if along > 0.0 {
                1
            } else {
                -1
            }
        };
        let onto: Vec<i8> = (0..arm.dof()).map(sign).collect();
        onto.contains(&1).then_some(()).or(onto.contains(&-1).then_some(()))?;
        Some(Self { onto })
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
#[derive(Clone, Debug, PartialEq)]
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
    pub fn new(known: &Lagrangian, coordinates: Coordinates) -> Self {
        let joint = table(known);
        let n = known.dof;
        let transformed = |entry: Entry| {
            let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
            let mut add = |entry: Entry, sign: i8| {
                if let Some(&(m, own)) = joint.get(&entry) {
                    for &(l, k) in &known.coefficients[m].terms {
                        *sum.entry(l).or_insert(0.0) += f64::from(sign) * own * k;
                    }
                }
            };
            match entry {
                Entry::D(a, b) => products(&[coordinates.back(a), coordinates.back(b)])
                    .for_each(|(at, sign)| add(d(at[0], at[1]), sign)),
                Entry::H(a, b, c) => {
                    products(&[coordinates.back(a), coordinates.back(b), coordinates.back(c)])
                        .for_each(|(at, sign)| add(h(at[0], at[1], at[2]), sign));
                }
                Entry::G(a) => {
                    products(&[coordinates.back(a)]).for_each(|(at, sign)| add(Entry::G(at[0]), sign))
                }
            }
            sum
        };
        let sums: Vec<(Entry, BTreeMap<usize, f64>)> =
            Entry::all(n).map(|entry| (entry, transformed(entry))).collect();
        let of_gravity = |entry: &Entry| matches!(entry, Entry::G(_));
        let largest = |gravity: bool| {
            let own = sums.iter().filter(|(entry, _)| of_gravity(entry) == gravity);
            own.flat_map(|(_, sum)| sum.values()).fold(0.0_f64, |most, k| most.max(k.abs()))
        };
        let floor = [NEGLIGIBLE * largest(false), NEGLIGIBLE * largest(true)];
        let layers = sums
            .into_iter()
            .map(|(entry, sum)| {
                let floor = floor[usize::from(of_gravity(&entry))];
                let kept = sum.into_iter().filter(|(_, k)| k.abs() > floor);
                let layer: Expansion = kept.map(|(l, k)| (known.functions[l], k)).collect();
                Layers { entry, layers: vec![layer] }
            })
            .collect();
        let lagrangian = distinct(n, layers, vec![known.truncation]).over(&known.functions);
        let own = table(&lagrangian);
        let parts = known
            .coefficients
            .iter()
            .map(|coefficient| {
                let Some(place) = coefficient.places.first() else { return Vec::new() };
                let at = match place.entry {
                    Entry::D(i, j) => products(&[coordinates.column(i), coordinates.column(j)])
                        .map(|(at, sign)| (d(at[0], at[1]), sign))
                        .collect::<Vec<_>>(),
                    Entry::H(i, j, k) => {
                        products(&[coordinates.column(i), coordinates.column(j), coordinates.column(k)])
                            .map(|(at, sign)| (h(at[0], at[1], at[2]), sign))
                            .collect()
                    }
                    Entry::G(i) => {
                        products(&[coordinates.column(i)]).map(|(at, sign)| (Entry::G(at[0]), sign)).collect()
                    }
                };
                let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
                for (entry, sign) in at {
                    if let Some(&(s, turned)) = own.get(&entry) {
                        *sum.entry(s).or_insert(0.0) += place.sign * turned * f64::from(sign);
                    }
                }
                sum.into_iter().filter(|part| part.1 != 0.0).collect()
            })
            .collect();
        Self { coordinates, lagrangian, parts }
    }
}

/// Where each entry of the model stands, and its sign there.
fn table(lagrangian: &Lagrangian) -> BTreeMap<Entry, (usize, f64)> {
    let of = |(m, c): (usize, &super::Coefficient)| {
        c.places.iter().map(|place| (place.entry, (m, place.sign))).collect::<Vec<_>>()
    };
    lagrangian.coefficients.iter().enumerate().flat_map(of).collect()
}

/// All choices of one element from each list, with the product of their signs.
fn products(lists: &[Vec<(usize, i8)>]) -> impl Iterator<Item = (Vec<usize>, i8)> {
    let mut out = vec![(Vec::new(), 1)];
    for list in lists {
        out = out
            .iter()
            .flat_map(|(at, sign): &(Vec<usize>, i8)| {
                list.iter().map(move |&(i, own)| ([at.as_slice(), &[i]].concat(), sign * own))
            })
            .collect();
    }
    out.into_iter()
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
