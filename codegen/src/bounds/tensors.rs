//! Bounds on the derivatives of a combination over its whole domain.

use crate::lagrangian::MAX_JOINTS;

/// The derivatives of a factor 1.
const CONSTANT: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// Σ_l |c_l| sup|∂^a ψ_l| for every partial derivative of order 0 to 3 over a domain with |q_j| ≤ reach_j.
///
/// For a trigonometric term that is |c| Π|κ_j|; a prismatic power q^p contributes p!/(p−a)! reach^{p−a}.
#[derive(Clone, Debug)]
pub struct Tensors {
    joints: usize,
    /// Order 0.
    pub value: f64,
    /// Order 1, by joint.
    pub gradient: Vec<f64>,
    /// Order 2, k×k.
    second: Vec<f64>,
    /// Order 3, k×k×k.
    third: Vec<f64>,
}

impl Tensors {
    /// The tensors of a sum of terms of the given magnitudes and exponents, where |q_j| ≤ `position_bound`.
    pub fn new<'a>(
        terms: impl Iterator<Item = (f64, &'a [i8])>,
        prismatic: impl Fn(usize) -> bool,
        position_bound: &[f64],
    ) -> Self {
        let k = position_bound.len();
        let mut out = Self {
            joints: k,
            value: 0.0,
            gradient: vec![0.0; k],
            second: vec![0.0; k * k],
            third: vec![0.0; k * k * k],
        };
        for (size, exponents) in terms {
            let mut factors = [CONSTANT; MAX_JOINTS];
            for slot in (0..k).filter(|&slot| exponents[slot] != 0) {
                factors[slot] = derivatives(exponents[slot], prismatic(slot), position_bound[slot]);
            }
            out.add(size, &factors[..k]);
        }
        out.mirror();
        out
    }

    fn add(&mut self, size: f64, factors: &[[f64; 4]]) {
        let k = self.joints;
        let mut order = [0_usize; MAX_JOINTS];
        let product = |order: &[usize]| factors.iter().zip(order).fold(size, |p, (f, &a)| p * f[a]);
        self.value += product(&order);
        // The derivatives of a constant factor add nothing.
        let varies = |i: usize| factors[i] != CONSTANT;
        for i in (0..k).filter(|&i| varies(i)) {
            order[i] += 1;
            self.gradient[i] += product(&order);
            for j in (i..k).filter(|&j| varies(j)) {
                order[j] += 1;
                self.second[i * k + j] += product(&order);
                for l in (j..k).filter(|&l| varies(l)) {
                    order[l] += 1;
                    self.third[(i * k + j) * k + l] += product(&order);
                    order[l] -= 1;
                }
                order[j] -= 1;
            }
            order[i] -= 1;
        }
    }

    /// Copies the sorted entries to all orders of their indices.
    fn mirror(&mut self) {
        let k = self.joints;
        for i in 0..k {
            for j in 0..k {
                self.second[i * k + j] = self.second[i.min(j) * k + i.max(j)];
                for l in 0..k {
                    let mut sorted = [i, j, l];
                    sorted.sort_unstable();
                    self.third[(i * k + j) * k + l] = self.third[(sorted[0] * k + sorted[1]) * k + sorted[2]];
                }
            }
        }
    }

    /// Σ_ij T_ij w_i w_j, the second directional derivative's bound for steps up to `w`.
    pub fn second(&self, w: &[f64]) -> f64 {
        let k = self.joints;
        (0..k).map(|i| w[i] * (0..k).map(|j| self.second[i * k + j] * w[j]).sum::<f64>()).sum()
    }

    /// Σ_jl T_ijl w_j w_l by i: what ∂²/∂s² of ∂f/∂q_i stays below for steps up to `w`.
    pub fn third(&self, w: &[f64]) -> [f64; MAX_JOINTS] {
        let k = self.joints;
        let mut out = [0.0; MAX_JOINTS];
        for (i, out) in out.iter_mut().enumerate().take(k) {
            for j in (0..k).filter(|&j| w[j] != 0.0) {
                let row = &self.third[(i * k + j) * k..(i * k + j + 1) * k];
                *out += w[j] * row.iter().zip(w).map(|(t, w)| t * w).sum::<f64>();
            }
        }
        out
    }
}

/// sup|φ|, sup|φ′|, sup|φ″|, sup|φ‴| of one joint's factor.
fn derivatives(exponent: i8, prismatic: bool, position_bound: f64) -> [f64; 4] {
    let k = f64::from(exponent).abs();
    if !prismatic {
        return [1.0, k, k * k, k * k * k];
    }
    let mut out = [0.0; 4];
    let mut factor = 1.0;
    for (a, out) in (0_u8..).zip(&mut out) {
        let left = i32::from(exponent) - i32::from(a);
        if left < 0 {
            break;
        }
        *out = factor * (0..left).fold(1.0, |power, _| power * position_bound);
        factor *= f64::from(left);
    }
    out
}
