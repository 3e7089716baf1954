//! The largest rates, and what they make of a coefficient in the torque.

use crate::arm::Arm;
use crate::lagrangian::{Absolute, Coefficient, Entry, Lagrangian};
use crate::motion::Motion;
use serde::{Deserialize, Serialize};

/// The largest rates that multiply D, h and G in the law, by joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// |q̇|, rad/s or m/s.
    pub speed: Vec<f64>,
    /// |v_r|, rad/s or m/s.
    pub reference_speed: Vec<f64>,
    /// |a_r|, rad/s² or m/s².
    pub reference_acceleration: Vec<f64>,
}

impl Rates {
    /// The motion's own: q̇ = v_r = q̇_d and a_r = q̈_d.
    pub fn of(motion: &Motion) -> Self {
        let position_bound = motion.position_bound();
        let (speed, acceleration) = (position_bound.speed, position_bound.acceleration);
        Self { reference_speed: speed.clone(), speed, reference_acceleration: acceleration }
    }

    /// The joints' limits; `None` where one is missing.
    pub fn limits(arm: &Arm) -> Option<Self> {
        let speed: Vec<f64> = arm.joints.iter().map(|joint| joint.limits.velocity).collect::<Option<_>>()?;
        let acceleration = arm.joints.iter().map(|joint| joint.limits.acceleration).collect::<Option<_>>()?;
        Some(Self { reference_speed: speed.clone(), speed, reference_acceleration: acceleration })
    }

    /// Ū_m of row `i`: the most that multiplies α_m there, over all its places.
    pub fn multipliers(&self, lagrangian: &Lagrangian, i: usize) -> Vec<f64> {
        let sum = |c: &Coefficient| c.places.iter().map(|place| self.multiplier(place.entry, i)).sum();
        lagrangian.coefficients.iter().map(sum).collect()
    }

    /// The most that multiplies one entry in row `i`.
    pub fn multiplier(&self, entry: Entry, i: usize) -> f64 {
        let (a, v, w) = (&self.reference_acceleration, &self.speed, &self.reference_speed);
        match entry {
            Entry::D(r, c) if r == i => a[c],
            Entry::D(r, c) if c == i => a[r],
            Entry::H(r, j, k) if r == i && j == k => v[j] * w[j],
            Entry::H(r, j, k) if r == i => v[j] * w[k] + v[k] * w[j],
            Entry::G(r) if r == i => 1.0,
            _ => 0.0,
        }
    }

    /// The same for the coefficients in absolute angles in the torque of joint `i`: at most this, as a sum over what
    /// their rates are in joint angles.
    pub fn multipliers_in(&self, absolute: &Absolute, i: usize) -> Vec<f64> {
        let Absolute { coordinates, lagrangian, .. } = absolute;
        let (a, v, w) = (&self.reference_acceleration, &self.speed, &self.reference_speed);
        let row = coordinates.column(i);
        let enters = |r: usize| row.iter().find(|&&(b, _)| b == r).map_or(0.0, |&(_, sign)| f64::from(sign));
        let of = |coefficient: &Coefficient| {
            let n = lagrangian.dof;
            let mut linear = vec![0.0_f64; n];
            let mut bilinear = vec![0.0_f64; n * n];
            let mut constant = 0.0_f64;
            for place in &coefficient.places {
                let mut acceleration = |r: usize, c: usize| {
                    for (j, sign) in coordinates.row(c) {
                        linear[j] += place.sign * enters(r) * f64::from(sign);
                    }
                };
                match place.entry {
                    Entry::D(r, c) if r == c => acceleration(r, c),
                    Entry::D(r, c) => {
                        acceleration(r, c);
                        acceleration(c, r);
                    }
                    Entry::H(r, b, c) => {
                        let pairs = if b == c { vec![(b, c)] } else { vec![(b, c), (c, b)] };
                        for (b, c) in pairs {
                            for (j, own) in coordinates.row(b) {
                                for (k, other) in coordinates.row(c) {
                                    bilinear[j * n + k] += place.sign * enters(r) * f64::from(own * other);
                                }
                            }
                        }
                    }
                    Entry::G(r) => constant += place.sign * enters(r),
                }
            }
            let linear: f64 = linear.iter().zip(a).map(|(x, a)| x.abs() * a).sum();
            let products = v.iter().flat_map(|v| w.iter().map(move |w| v * w));
            let bilinear: f64 = bilinear.iter().zip(products).map(|(x, u)| x.abs() * u).sum();
            linear + bilinear + constant.abs()
        };
        lagrangian.coefficients.iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::Rates;
    use crate::check::prepare;
    use crate::lagrangian::{Absolute, Coordinates, Entry, expand};

    /// Over the corners of the rates the most that one coefficient in absolute angles can do to a torque in joint angles,
    /// by its definition: θ̇ = T q̇ and τ = Tᵀ τ'.
    #[test]
    fn multipliers_in_absolute_angles_are_attained_or_exceeded() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/puma3.json");
        let arm = prepare(&path).expect("a sound specification").built.arm;
        let coordinates = Coordinates::of(&arm).expect("two parallel axes");
        let absolute = Absolute::new(&expand(&arm), coordinates.clone()).expect("a model");
        let rates = Rates {
            speed: vec![1.0, 2.0, 0.5],
            reference_speed: vec![0.7, 1.5, 3.0],
            reference_acceleration: vec![5.0, 7.0, 11.0],
        };
        let n = arm.dof();
        let turned = |rate: &[f64]| -> Vec<f64> {
            let row = |a| coordinates.row(a).iter().map(|&(j, s)| f64::from(s) * rate[j]).sum();
            (0..n).map(row).collect()
        };
        let mut largest = vec![vec![0.0_f64; absolute.lagrangian.coefficients.len()]; n];
        for corner in 0..1_usize << (3 * n) {
            let signed = |from: usize, rate: &[f64]| -> Vec<f64> {
                let sign = |i: usize| if corner >> (from + i) & 1 == 1 { -1.0 } else { 1.0 };
                turned(&(0..n).map(|i| sign(i) * rate[i]).collect::<Vec<_>>())
            };
            let (v, w) = (signed(0, &rates.speed), signed(n, &rates.reference_speed));
            let a = signed(2 * n, &rates.reference_acceleration);
            for (m, coefficient) in absolute.lagrangian.coefficients.iter().enumerate() {
                let mut rows = vec![0.0; n];
                for place in &coefficient.places {
                    match place.entry {
                        Entry::D(i, j) => {
                            rows[i] += place.sign * a[j];
                            if i != j {
                                rows[j] += place.sign * a[i];
                            }
                        }
                        Entry::H(i, j, k) if j == k => rows[i] += place.sign * v[j] * w[j],
                        Entry::H(i, j, k) => rows[i] += place.sign * (v[j] * w[k] + v[k] * w[j]),
                        Entry::G(i) => rows[i] += place.sign,
                    }
                }
                for (i, largest) in largest.iter_mut().enumerate() {
                    let column = coordinates.column(i);
                    let tau: f64 = column.iter().map(|&(b, s)| f64::from(s) * rows[b]).sum();
                    largest[m] = largest[m].max(tau.abs());
                }
            }
        }
        let mut attained = 0;
        for (i, largest) in largest.iter().enumerate() {
            for (bound, found) in rates.multipliers_in(&absolute, i).iter().zip(largest) {
                assert!(*found <= bound * (1.0 + 1e-14), "{found} > {bound}");
                attained += usize::from(*found >= bound * (1.0 - 1e-14));
            }
        }
        assert!(attained > n * absolute.lagrangian.coefficients.len() * 9 / 10, "{attained}");
    }
}
