//! A combination of ψ functions prepared for fast jets: value, gradient and Hessian by one pass over a tree.

use std::collections::BTreeMap;

use crate::lagrangian::{Function, MAX_JOINTS, WHOLE};

/// A complex number [real, imaginary].
pub(super) type Complex = [f64; 2];

/// Value, gradient and Hessian at one point, over the joints that occur.
#[derive(Clone, Debug, Default)]
pub struct Jet {
    /// f.
    pub value: f64,
    /// ∂f/∂q_i.
    pub gradient: [f64; MAX_JOINTS],
    /// ∂²f/∂q_i∂q_j.
    pub hessian: [[f64; MAX_JOINTS]; MAX_JOINTS],
}

impl Jet {
    /// Takes value, gradient and the upper triangle of the Hessian over `k` joints; what is missing is 0.
    pub fn of(mut numbers: impl Iterator<Item = f64>, k: usize) -> Self {
        let mut next = || numbers.next().unwrap_or(0.0);
        let mut jet = Self { value: next(), ..Self::default() };
        for i in 0..k {
            jet.gradient[i] = next();
        }
        for i in 0..k {
            for j in i..k {
                jet.hessian[i][j] = next();
                jet.hessian[j][i] = jet.hessian[i][j];
            }
        }
        jet
    }
}

/// f(q) = Re Σ c_l Π_j φ_jl(q_j), φ = e^{iκq} for a revolute joint and q^p for a prismatic one.
///
/// Terms that differ only in their last joint's exponent share everything before it, so f is evaluated like a nested
/// Horner scheme: the long last level carries three numbers a term, only the short upper ones carry Hessians.
#[derive(Clone, Debug)]
pub struct Polynomial {
    /// The joints that occur, ascending.
    pub joints: Vec<usize>,
    /// Whether each is prismatic.
    pub(super) prismatic: Vec<bool>,
    /// The part of its angle that the exponents of each count, as a factor; 1 for a whole angle.
    unit: Vec<f64>,
    /// Exponents from `-largest` to `largest`.
    pub(super) largest: Vec<i8>,
    /// One level a joint, the first joint first.
    pub(super) levels: Vec<Level>,
    /// c_l in tree order.
    pub(super) coefficients: Vec<Complex>,
    /// The exponents of each term over `joints`, in tree order.
    exponents: Vec<Vec<i8>>,
}

/// Children are sorted, so each group is a range of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// Group g owns the children `starts[g]..starts[g + 1]`.
    pub starts: Vec<usize>,
    /// Index into the joint's factors, by child.
    pub factor: Vec<usize>,
}

/// Buffers of [`Polynomial::jet`], to be used again.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    below: Vec<Complex>,
    above: Vec<Complex>,
    factors: Vec<[Complex; 3]>,
}

impl Polynomial {
    /// Gathers Σ k_l ψ_l.
    pub fn new<'a>(terms: impl Iterator<Item = (&'a Function, f64)> + Clone) -> Self {
        let occurs = |j: usize| terms.clone().any(|(psi, _)| psi.kappa[j] != 0 || psi.power[j] != 0);
        let joints: Vec<usize> = (0..MAX_JOINTS).filter(|&j| occurs(j)).collect();
        // All functions of one arm count the same parts of its angles.
        let part = terms.clone().next().map_or(WHOLE, |(psi, _)| psi.part);
        let unit = joints.iter().map(|&j| 1.0 / f64::from(part[j])).collect();
        let prismatic = joints.iter().map(|&j| terms.clone().any(|(psi, _)| psi.power[j] != 0)).collect();
        let mut gathered: BTreeMap<Vec<i8>, Complex> = BTreeMap::new();
        for (psi, k) in terms {
            let exponent = |&j: &usize| psi.kappa[j] + i8::try_from(psi.power[j]).unwrap_or(i8::MAX);
            let slot = gathered.entry(joints.iter().map(exponent).collect()).or_default();
            // k cos θ = Re k e^{iθ} and k sin θ = Re(−ik e^{iθ}).
            slot[usize::from(psi.sine)] += if psi.sine { -k } else { k };
        }
        Self::of(joints, prismatic, unit, gathered)
    }

    /// What the exponents of a revolute joint count: this part of its angle; `None` for a prismatic joint.
    pub(super) fn angle(&self, slot: usize) -> Option<f64> {
        (!self.prismatic[slot]).then(|| self.unit[slot])
    }

    fn of(
        joints: Vec<usize>,
        prismatic: Vec<bool>,
        unit: Vec<f64>,
        gathered: BTreeMap<Vec<i8>, Complex>,
    ) -> Self {
        let exponents: Vec<Vec<i8>> = gathered.keys().cloned().collect();
        let largest: Vec<i8> = (0..joints.len())
            .map(|slot| exponents.iter().map(|e| e[slot].abs()).max().unwrap_or(0))
            .collect();
        let levels = levels(&exponents, &largest);
        Self {
            joints,
            prismatic,
            unit,
            largest,
            levels,
            coefficients: gathered.into_values().collect(),
            exponents,
        }
    }

    /// Over the same joints the sum of the terms as `change` turns them: other exponents, and a factor.
    pub(super) fn mapped(&self, change: impl Fn(&[i8]) -> (Vec<i8>, f64)) -> Self {
        let mut gathered: BTreeMap<Vec<i8>, Complex> = BTreeMap::new();
        for (c, exponents) in self.coefficients.iter().zip(&self.exponents) {
            let (exponents, factor) = change(exponents);
            if factor != 0.0 {
                let slot = gathered.entry(exponents).or_default();
                slot[0] += factor * c[0];
                slot[1] += factor * c[1];
            }
        }
        Self::of(self.joints.clone(), self.prismatic.clone(), self.unit.clone(), gathered)
    }

    /// Magnitude |c_l| and exponents of every term.
    pub fn terms(&self) -> impl Iterator<Item = (f64, &[i8])> {
        let size = |c: &Complex| libm::sqrt(c[0] * c[0] + c[1] * c[1]) * (1.0 + 4.0 * f64::EPSILON);
        self.coefficients.iter().map(size).zip(self.exponents.iter().map(Vec::as_slice))
    }

    /// Value, gradient and Hessian at `q`, which has one entry for each of [`Polynomial::joints`].
    pub fn jet(&self, q: &[f64], scratch: &mut Scratch) -> Jet {
        let k = self.joints.len();
        let Scratch { below, above, factors } = scratch;
        below.clear();
        below.extend_from_slice(&self.coefficients);
        for (slot, level) in self.levels.iter().enumerate().rev() {
            fill_factors(factors, q[slot], self.largest[slot], self.angle(slot));
            let deeper = k - 1 - slot;
            climb(level, factors, deeper, below, above);
            std::mem::swap(below, above);
        }
        // Without joints every term is the constant; without terms there is no root.
        Jet::of(below.iter().map(|c| c[0]), k)
    }
}

/// Groups the sorted terms by their first joints: level `slot` joins what agrees in the first `slot` exponents.
fn levels(exponents: &[Vec<i8>], largest: &[i8]) -> Vec<Level> {
    let k = largest.len();
    let mut out = vec![Level::default(); k];
    for slot in 0..k {
        let level = &mut out[slot];
        let mut before: Option<&Vec<i8>> = None;
        for term in exponents {
            let differs = |length: usize| before.is_none_or(|b| b[..length] != term[..length]);
            if differs(slot + 1) {
                if differs(slot) {
                    level.starts.push(level.factor.len());
                }
                let index = i16::from(term[slot]) + i16::from(largest[slot]);
                level.factor.push(usize::try_from(index).unwrap_or(0));
            }
            before = Some(term);
        }
        level.starts.push(level.factor.len());
    }
    out
}

/// φ, φ′ and φ″ for all exponents from −largest to largest.
fn fill_factors(factors: &mut Vec<[Complex; 3]>, q: f64, largest: i8, angle: Option<f64>) {
    factors.clear();
    let top = usize::from(largest.unsigned_abs());
    factors.resize(2 * top + 1, [[0.0; 2]; 3]);
    let (sin, cos) = angle.map_or((0.0, q), |unit| libm::sincos(q * unit));
    let mut f = [1.0, 0.0];
    // Of the two powers before.
    let mut lower = [0.0; 2];
    for e in 0..=top {
        if e > 0 {
            lower = [f[0], lower[0]];
            f = times(f, [cos, sin]);
        }
        let k = e as f64 * angle.unwrap_or(1.0);
        if angle.is_none() {
            factors[top + e] = [f, [k * lower[0], 0.0], [k * (k - 1.0) * lower[1], 0.0]];
        } else {
            factors[top + e] = [f, [-k * f[1], k * f[0]], [-k * k * f[0], -k * k * f[1]]];
            // e^{−ikq} and its derivatives are the conjugates.
            factors[top - e] = factors[top + e].map(|[re, im]| [re, -im]);
        }
    }
}

pub(super) fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn size(joints: usize) -> usize {
    1 + joints + joints * (joints + 1) / 2
}

/// One level up. Children carry [f, gradient, upper triangle of the Hessian] over `deeper` joints, groups the same
/// over one joint more, which comes first.
fn climb(
    level: &Level,
    factors: &[[Complex; 3]],
    deeper: usize,
    below: &[Complex],
    above: &mut Vec<Complex>,
) {
    let (inner, outer) = (size(deeper), size(deeper + 1));
    let groups = level.starts.len() - 1;
    above.clear();
    above.resize(groups * outer, [0.0; 2]);
    if deeper == 0 {
        return climb_from_terms(level, factors, below, above);
    }
    for (group, out) in above.chunks_exact_mut(outer).enumerate() {
        let range = level.starts[group]..level.starts[group + 1];
        let children = below[range.start * inner..range.end * inner].chunks_exact(inner);
        for (child, &factor) in children.zip(&level.factor[range]) {
            let [f, f1, f2] = factors[factor];
            let (value, rest) = out.split_at_mut(2 + deeper);
            add(&mut value[..1], f, &child[..1]);
            add(&mut value[1..2], f1, &child[..1]);
            add(&mut value[2..], f, &child[1..=deeper]);
            let (row, triangle) = rest.split_at_mut(1 + deeper);
            add(&mut row[..1], f2, &child[..1]);
            add(&mut row[1..], f1, &child[1..=deeper]);
            add(triangle, f, &child[1 + deeper..]);
        }
    }
}

/// The same of the terms themselves, which are the most: [f, gradient, Hessian] over one joint.
fn climb_from_terms(level: &Level, factors: &[[Complex; 3]], below: &[Complex], above: &mut [Complex]) {
    for (out, bounds) in above.as_chunks_mut::<3>().0.iter_mut().zip(level.starts.windows(2)) {
        let range = bounds[0]..bounds[1];
        for (&c, &factor) in below[range.clone()].iter().zip(&level.factor[range]) {
            for (out, &f) in out.iter_mut().zip(&factors[factor]) {
                let product = times(f, c);
                out[0] += product[0];
                out[1] += product[1];
            }
        }
    }
}

fn add(out: &mut [Complex], factor: Complex, child: &[Complex]) {
    for (out, &c) in out.iter_mut().zip(child) {
        let product = times(factor, c);
        out[0] += product[0];
        out[1] += product[1];
    }
}
