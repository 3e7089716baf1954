//! The canonical functions ψ: cos(κ·q) and sin(κ·q), times powers of the prismatic coordinates.

use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt;

/// Most joints an arm may have.
pub const MAX_JOINTS: usize = 8;

/// One function ψ(q) = Π_j q_j^power_j · (cos or sin)(Σ_j κ_j q_j / part_j).
///
/// Holds: the first nonzero entry of κ is positive; κ = 0 goes with the cosine; κ_j = 0 for prismatic
/// joints and power_j = 0 for revolute ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Function {
    /// κ, by joint.
    pub kappa: [i8; MAX_JOINTS],
    /// Exponents of the prismatic coordinates, by joint.
    pub power: [u8; MAX_JOINTS],
    /// True for the sine.
    pub sine: bool,
    /// By joint the part of its angle that κ counts, the same in all functions of one arm: [`crate::arm::Arm::parts`].
    pub part: [u8; MAX_JOINTS],
}

/// Whole angles.
pub const WHOLE: [u8; MAX_JOINTS] = [1; MAX_JOINTS];

impl Function {
    /// The constant 1.
    pub const ONE: Self = Self { kappa: [0; MAX_JOINTS], power: [0; MAX_JOINTS], sine: false, part: WHOLE };

    /// Canonical form of Π q^power · trig(κ·q): the function and the sign that the flip of κ costs.
    /// `None` where the function is sin 0 = 0.
    pub fn canonical(self) -> Option<(Self, f64)> {
        match self.kappa.iter().find(|&&k| k != 0) {
            None if self.sine => None,
            Some(&first) if first < 0 => {
                let sign = if self.sine { -1.0 } else { 1.0 };
                Some((Self { kappa: self.kappa.map(|k| -k), ..self }, sign))
            }
            _ => Some((self, 1.0)),
        }
    }

    /// Frequency of joint `j`: κ_j / part_j.
    pub fn frequency(&self, j: usize) -> f64 {
        let kappa = f64::from(self.kappa[j]);
        if self.part[j] == 1 { kappa } else { kappa / f64::from(self.part[j]) }
    }

    /// ∂ψ/∂q_k as (function, factor); `None` where it vanishes. For a prismatic joint the factor is
    /// the exponent, for a revolute one ±κ_k / part_k.
    pub fn derivative(&self, k: usize) -> Option<(Self, f64)> {
        let mut out = *self;
        if self.power[k] > 0 {
            out.power[k] -= 1;
            return Some((out, f64::from(self.power[k])));
        }
        if self.kappa[k] == 0 {
            return None;
        }
        out.sine = !self.sine;
        let sign = if self.sine { 1.0 } else { -1.0 };
        Some((out, sign * self.frequency(k)))
    }

    /// ψ(q); joints beyond the slice count as 0.
    pub fn evaluate(&self, q: &[f64]) -> f64 {
        let (monomial, angle) = self.parts_at(q);
        monomial * if self.sine { libm::sin(angle) } else { libm::cos(angle) }
    }

    /// Whether this is the cosine and `other` the sine of the same angle, times the same powers.
    pub(super) fn is_before(&self, other: &Self) -> bool {
        !self.sine && *other == Self { sine: true, ..*self }
    }

    /// The values of a cosine and of the sine beside it, the same to the last bit as each alone.
    pub(super) fn evaluate_both(&self, q: &[f64]) -> [f64; 2] {
        let (monomial, angle) = self.parts_at(q);
        let (sin, cos) = libm::sincos(angle);
        [monomial * cos, monomial * sin]
    }

    /// Π q^power and the angle.
    fn parts_at(&self, q: &[f64]) -> (f64, f64) {
        let mut angle = 0.0;
        let mut monomial = 1.0;
        for (j, (&q, &power)) in q.iter().zip(&self.power).enumerate() {
            angle += self.frequency(j) * q;
            for _ in 0..power {
                monomial *= q;
            }
        }
        (monomial, angle)
    }

    /// True for a function other than 1 in which every joint occurs once at most: |κ_j| ≤ 1, powers ≤ 1.
    pub fn is_first_degree(&self) -> bool {
        *self != Self::ONE
            && (0..MAX_JOINTS).all(|j| self.kappa[j].unsigned_abs() <= self.part[j])
            && self.power.iter().all(|&p| p <= 1)
    }

    /// The first joint that occurs; [`MAX_JOINTS`] for the constant.
    pub fn leading_joint(&self) -> usize {
        (0..MAX_JOINTS).find(|&j| self.moves(j)).unwrap_or(MAX_JOINTS)
    }

    /// True where no joint occurs in both.
    pub fn is_disjoint(&self, other: &Self) -> bool {
        (0..MAX_JOINTS).all(|j| !self.moves(j) || !other.moves(j))
    }

    fn moves(&self, j: usize) -> bool {
        self.kappa[j] != 0 || self.power[j] != 0
    }

    /// The product ψ φ as a combination of at most two functions.
    pub fn times(&self, other: &Self) -> BTreeMap<Self, f64> {
        let pair = |sign: i8| std::array::from_fn(|j| self.kappa[j] + sign * other.kappa[j]);
        let power = std::array::from_fn(|j| self.power[j] + other.power[j]);
        // Of the sum and of the difference of the angles.
        let (sine, sum, difference) = match (self.sine, other.sine) {
            (false, false) => (false, 0.5, 0.5),
            (true, true) => (false, -0.5, 0.5),
            (true, false) => (true, 0.5, 0.5),
            (false, true) => (true, 0.5, -0.5),
        };
        let mut out = BTreeMap::new();
        for (kappa, k) in [(pair(1), sum), (pair(-1), difference)] {
            if let Some((psi, sign)) = (Self { kappa, power, sine, ..*self }).canonical() {
                *out.entry(psi).or_insert(0.0) += sign * k;
            }
        }
        out.retain(|_, k| *k != 0.0);
        out
    }

    /// A name that is an identifier: `one`, `cos_q2_q3`, `sin_q2_m2q3`, `q3p2_cos_q2`; `m` stands for minus, and
    /// `3d2q1` for 3/2 q1.
    pub fn identifier(&self) -> String {
        let mut parts = Vec::new();
        for (j, &power) in self.power.iter().enumerate() {
            match power {
                0 => {}
                1 => parts.push(format!("q{}", j + 1)),
                _ => parts.push(format!("q{}p{power}", j + 1)),
            }
        }
        if self.kappa.iter().any(|&k| k != 0) {
            parts.push(if self.sine { "sin" } else { "cos" }.to_string());
            for (j, &k) in self.kappa.iter().enumerate().filter(|&(_, &k)| k != 0) {
                let sign = if k < 0 { "m" } else { "" };
                let size = match self.multiple(j) {
                    (1, 1) => String::new(),
                    (k, 1) => k.to_string(),
                    (k, part) => format!("{k}d{part}"),
                };
                parts.push(format!("{sign}{size}q{}", j + 1));
            }
        }
        if parts.is_empty() { "one".to_string() } else { parts.join("_") }
    }

    /// |κ_j| over part_j in lowest terms.
    fn multiple(&self, j: usize) -> (u8, u8) {
        let (mut k, mut part) = (self.kappa[j].unsigned_abs(), self.part[j]);
        while part > 1 && k.is_multiple_of(2) {
            (k, part) = (k / 2, part / 2);
        }
        (k, part)
    }

    /// Sum of |κ| and of the exponents.
    fn degree(&self) -> u32 {
        let turns: u32 = self.kappa.iter().map(|k| u32::from(k.unsigned_abs())).sum();
        turns + self.power.iter().map(|&p| u32::from(p)).sum::<u32>()
    }
}

/// By degree, then κ with its larger leading entries first, then powers, cosine before sine.
impl Ord for Function {
    fn cmp(&self, other: &Self) -> Ordering {
        self.degree()
            .cmp(&other.degree())
            .then_with(|| other.kappa.cmp(&self.kappa))
            .then_with(|| other.power.cmp(&self.power))
            .then_with(|| self.sine.cmp(&other.sine))
    }
}

impl PartialOrd for Function {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// As a formula: `1`, `cos(q2 + q3)`, `q3^2 sin(q2 - 2 q3)`.
impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        for (j, &power) in self.power.iter().enumerate() {
            match power {
                0 => {}
                1 => parts.push(format!("q{}", j + 1)),
                _ => parts.push(format!("q{}^{power}", j + 1)),
            }
        }
        let mut angle = String::new();
        for (j, &k) in self.kappa.iter().enumerate().filter(|&(_, &k)| k != 0) {
            let sign = match (angle.is_empty(), k < 0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            let size = match self.multiple(j) {
                (1, 1) => String::new(),
                (k, 1) => format!("{k} "),
                (k, part) => format!("{k}/{part} "),
            };
            angle.push_str(&format!("{sign}{size}q{}", j + 1));
        }
        if !angle.is_empty() {
            parts.push(format!("{}({angle})", if self.sine { "sin" } else { "cos" }));
        }
        if parts.is_empty() { f.write_str("1") } else { f.write_str(&parts.join(" ")) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Function, MAX_JOINTS};
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    #[test]
    fn both_together_are_each_alone_to_the_last_bit() {
        let spread = LowDiscrepancy::new(2);
        let tiny = (0..120).flat_map(|e| [1.0, -1.0, 1.37].map(|x| libm::ldexp(x, -e)));
        let wide = (0..200_000).map(|index| 60.0 * (spread.point(index)[0] - 0.5));
        let mut cosine = Function::ONE;
        cosine.kappa[0] = 1;
        cosine.power = [0; MAX_JOINTS];
        let sine = Function { sine: true, ..cosine };
        assert!(cosine.is_before(&sine) && !sine.is_before(&cosine));
        for q in tiny.chain(wide).chain([0.0, -0.0]) {
            let both = cosine.evaluate_both(&[q]);
            let each = [cosine.evaluate(&[q]), sine.evaluate(&[q])];
            assert_eq!(both.map(f64::to_bits), each.map(f64::to_bits), "{q:e}");
        }
    }
}
