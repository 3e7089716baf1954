//! Polynomials of a bounded total degree in the joints' displacements from a point.

use super::polynomial::Jet;
use crate::lagrangian::MAX_JOINTS;

/// Largest degree.
pub const ORDER: usize = 5;

/// The monomials δ^a with |a| ≤ `order` in `joints` displacements, those with the smaller exponents of the first
/// joint first, then of the second and so on.
#[derive(Clone, Debug)]
pub struct Monomials {
    /// Number of displacements.
    pub joints: usize,
    /// The exponents of each monomial.
    pub exponents: Vec<[i8; MAX_JOINTS]>,
    /// The monomials of each joint are summed in groups that agree in the exponents of all joints before it: the
    /// largest exponent of each group, by joint.
    groups: Vec<Vec<usize>>,
}

impl Monomials {
    /// All monomials up to `order`, which is at most [`ORDER`].
    pub fn new(joints: usize, order: usize) -> Self {
        let mut exponents = vec![[0; MAX_JOINTS]];
        let mut groups = Vec::new();
        for slot in 0..joints {
            let mut next = Vec::new();
            let mut group = Vec::new();
            for before in &exponents {
                let left = order.saturating_sub(degree(before));
                group.push(left);
                for (e, _) in (0_i8..).zip(0..=left) {
                    let mut more = *before;
                    more[slot] = e;
                    next.push(more);
                }
            }
            groups.push(group);
            exponents = next;
        }
        Self { joints, exponents, groups }
    }
}

/// |a|.
pub fn degree(exponents: &[i8; MAX_JOINTS]) -> usize {
    exponents.iter().map(|e| usize::from(e.unsigned_abs())).sum()
}

/// Buffers of [`jet`], to be used again.
#[derive(Clone, Debug, Default)]
pub struct Buffers {
    below: Vec<f64>,
    above: Vec<f64>,
}

/// Value, gradient and Hessian of Σ c_a δ^a at `at`.
pub fn jet(monomials: &Monomials, coefficients: &[f64], at: &[f64], buffers: &mut Buffers) -> Jet {
    let k = monomials.joints;
    let Some(last) = k.checked_sub(1) else { return Jet::of(coefficients.iter().copied(), 0) };
    let Buffers { below, above } = buffers;
    below.clear();
    horner(&monomials.groups[last], coefficients, at[last], below);
    for slot in (0..last).rev() {
        climb(&monomials.groups[slot], last - slot, &powers(at[slot]), below, above);
        std::mem::swap(below, above);
    }
    Jet::of(below.iter().copied(), k)
}

/// The sums over the last joint's exponents with their two derivatives.
fn horner(groups: &[usize], coefficients: &[f64], x: f64, out: &mut Vec<f64>) {
    let mut rest = coefficients;
    for &largest in groups {
        let Some((group, more)) = rest.split_at_checked(largest + 1) else { return };
        let (mut f, mut f1, mut f2) = (0.0, 0.0, 0.0);
        for c in group.iter().rev() {
            f2 = f2 * x + f1;
            f1 = f1 * x + f;
            f = f * x + c;
        }
        out.extend([f, f1, 2.0 * f2]);
        rest = more;
    }
}

/// One joint more. Children carry [f, gradient, upper triangle of the Hessian] over `deeper` joints, groups the same
/// over one joint more, which comes first.
fn climb(groups: &[usize], deeper: usize, powers: &[[f64; 3]], below: &[f64], above: &mut Vec<f64>) {
    let (inner, outer) = (size(deeper), size(deeper + 1));
    above.clear();
    above.resize(groups.len() * outer, 0.0);
    let mut children = below.chunks_exact(inner);
    for (out, &largest) in above.chunks_exact_mut(outer).zip(groups) {
        let (value, rest) = out.split_at_mut(2 + deeper);
        let (row, triangle) = rest.split_at_mut(1 + deeper);
        for (&[f, f1, f2], child) in powers[..=largest].iter().zip(&mut children) {
            let (short, long) = child.split_at(1 + deeper);
            value[0] += f * short[0];
            value[1] += f1 * short[0];
            row[0] += f2 * short[0];
            add(&mut value[2..], f, &short[1..]);
            add(&mut row[1..], f1, &short[1..]);
            add(triangle, f, long);
        }
    }
}

/// x^e and its first two derivatives for e up to [`ORDER`].
fn powers(x: f64) -> [[f64; 3]; ORDER + 1] {
    let mut out = [[0.0; 3]; ORDER + 1];
    out[0][0] = 1.0;
    for e in 1..=ORDER {
        let k = e as f64;
        let before = out[e - 1];
        out[e] = [before[0] * x, k * before[0], k * before[1]];
    }
    out
}

fn add(out: &mut [f64], factor: f64, child: &[f64]) {
    for (out, c) in out.iter_mut().zip(child) {
        *out += factor * c;
    }
}

fn size(joints: usize) -> usize {
    1 + joints + joints * (joints + 1) / 2
}
