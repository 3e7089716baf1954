//! What sines and cosines that are off by more than rounding do to the recursive body.
//!
//! There sin² + cos² = 1 is used without being computed, so the error is not that of an expansion. But the recursion
//! is linear in every joint's rotation R_j wherever that occurs, and where sine and cosine are off by ε the rotation
//! is off by √2 ε in norm: in the plane that it turns, R_j times a number of modulus below √2 ε is added. A sum of
//! products of operators, vectors and the symmetric bilinear form of Γ = [ω̇]× + ½(ω ω_rᵀ + ω_r ωᵀ) − (ω·ω_r)·1
//! therefore changes by no more than the same sum over norms does when every ‖R_j‖ = 1 is replaced by 1 + √2 ε. That
//! sum is computed here, by the same recursion, for unit rates one at a time: ΔD, Δh and ΔG come out entry by entry,
//! also where the exact entry is zero.
//!
//! Norms: ‖Γ‖ ≤ |ω̇| + |ω||ω_r|; the axial vector of ΓΣ − (ΓΣ)ᵀ ≤ √2 ‖Γ‖ ‖Σ‖_F.

use std::ops::{Add, Mul};

use super::Bounds;
use super::rounding::{gamma, monomial};
use crate::arm::{Arm, Joint, JointKind};
use crate::lagrangian::{Combination, Lagrangian};

/// A bound on a norm, and on what it can change by.
#[derive(Clone, Copy, Debug, Default)]
struct Size {
    exact: f64,
    change: f64,
}

impl Size {
    fn fixed(exact: f64) -> Self {
        Self { exact, change: 0.0 }
    }

    /// The change, and roundings of code that is as long as a recursion.
    fn bound(self) -> f64 {
        if self.change == 0.0 {
            0.0
        } else {
            (self.change + gamma(1024.0) * (self.exact + self.change)).next_up()
        }
    }
}

impl Add for Size {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { exact: self.exact + b.exact, change: self.change + b.change }
    }
}

impl Mul for Size {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let change = self.exact * b.change + self.change * b.exact + self.change * b.change;
        Self { exact: self.exact * b.exact, change }
    }
}

/// Bounds on what the recursive body of `arm` is off by, where |q_j| ≤ `reach` for prismatic joints and every sine and
/// cosine is off by `sine`.
pub fn recursion(arm: &Arm, reach: &[f64], sine: f64) -> Bounds {
    entries(arm, reach, std::f64::consts::SQRT_2 * sine, &Size::bound)
}

/// Roundings of a recursion, times what its constants may exceed the parameters by that they were made of: a body keeps
/// at most 30 times what was gathered on it, a few sums of products make each constant and some thousand the torque.
const MOVES: f64 = 131_072.0;

/// Bounds on the rounding in f64 of the recursive body of `arm`, where |q_j| ≤ `reach` for prismatic joints and sines and
/// cosines are as good as rounding: a part of the recursion over norms, which bounds whatever is summed on the way.
fn recursion_rounding(arm: &Arm, reach: &[f64]) -> Bounds {
    let part = gamma(MOVES);
    let mut bounds = entries(arm, reach, 0.0, &|size: Size| (part * size.exact).next_up());
    for (j, joint) in arm.joints.iter().enumerate() {
        bounds.d[j][j] = (bounds.d[j][j] + part * joint.armature.abs()).next_up();
    }
    bounds
}

fn entries(arm: &Arm, reach: &[f64], turn: f64, bound: &dyn Fn(Size) -> f64) -> Bounds {
    let n = arm.dof();
    let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
    let (rest, model) = (vec![0.0; n], Norms { arm, reach, turn, bound });
    let gravity = norm(&arm.gravity);
    let mut bounds = Bounds {
        d: vec![vec![0.0; n]; n],
        h: vec![vec![vec![0.0; n]; n]; n],
        b: vec![0.0; n],
        g: model.torque(gravity, &rest, &rest, &rest),
    };
    for j in 0..n {
        for (row, bound) in bounds.d.iter_mut().zip(model.torque(0.0, &rest, &rest, &unit(j))) {
            row[j] = bound;
        }
        for k in j..n {
            for (plane, bound) in bounds.h.iter_mut().zip(model.torque(0.0, &unit(j), &unit(k), &rest)) {
                plane[j][k] = bound;
                plane[k][j] = bound;
            }
        }
    }
    bounds
}

struct Norms<'a> {
    arm: &'a Arm,
    reach: &'a [f64],
    /// √2 ε.
    turn: f64,
    /// What is made of the size of an entry.
    bound: &'a dyn Fn(Size) -> f64,
}

impl Norms<'_> {
    /// By joint, what |τ_i| can change by, for gravity and rates of the given magnitudes.
    fn torque(&self, gravity: f64, qd: &[f64], v_r: &[f64], a_r: &[f64]) -> Vec<f64> {
        let (mut velocity, mut reference, mut angular) = (Size::default(), Size::default(), Size::default());
        let (mut linear, mut gradient) = (Size::fixed(gravity), Size::default());
        let half = Size::fixed(0.5);
        let mut wrenches = Vec::new();
        for (j, joint) in self.arm.joints.iter().enumerate() {
            let turn = self.turn(joint);
            let [rate, wanted, rise] = [qd[j], v_r[j], a_r[j]].map(Size::fixed);
            (velocity, reference, angular) = (turn * velocity, turn * reference, turn * angular);
            linear = turn * (linear + gradient * self.origin(j, joint));
            let bend = velocity * wanted + reference * rate;
            match joint.kind {
                JointKind::Revolute => {
                    angular = angular + half * bend + rise;
                    (velocity, reference) = (velocity + rate, reference + wanted);
                }
                JointKind::Prismatic => linear = linear + bend + rise,
            }
            gradient = angular + velocity * reference;
            let body = &joint.body;
            let (mass, first) = (Size::fixed(body.mass.abs()), Size::fixed(norm(&body.first_moment)));
            let second = Size::fixed(std::f64::consts::SQRT_2 * norm(body.pseudo_inertia.as_flattened()));
            wrenches.push((mass * linear + first * gradient, second * gradient + first * linear));
        }
        let mut torque = Vec::with_capacity(wrenches.len());
        let mut carried = (Size::default(), Size::default());
        for (j, joint) in self.arm.joints.iter().enumerate().rev() {
            let (force, moment) = (wrenches[j].0 + carried.0, wrenches[j].1 + carried.1);
            torque.push(match joint.kind {
                JointKind::Revolute => (self.bound)(moment),
                JointKind::Prismatic => (self.bound)(force),
            });
            let turn = self.turn(joint);
            carried = (turn * force, turn * moment + self.origin(j, joint) * turn * force);
        }
        torque.reverse();
        torque
    }

    fn turn(&self, joint: &Joint) -> Size {
        match joint.kind {
            JointKind::Revolute => Size { exact: 1.0, change: self.turn },
            JointKind::Prismatic => Size::fixed(1.0),
        }
    }

    /// Distance of the moved frame's origin in the frame before.
    fn origin(&self, j: usize, joint: &Joint) -> Size {
        let fixed = norm(&joint.pose.translation);
        Size::fixed(match joint.kind {
            JointKind::Revolute => fixed,
            JointKind::Prismatic => fixed + self.reach[j],
        })
    }
}

/// Euclidean norm, rounded up.
fn norm(x: &[f64]) -> f64 {
    libm::sqrt(x.iter().map(|x| x * x).sum::<f64>()) * (1.0 + 8.0 * f64::EPSILON)
}

/// By coefficient, what the recursive body of `arm` may be off by from `combinations`, its expansion, which lack `lacking`,
/// where |q_j| ≤ `reach`.
pub fn beside_expansion(
    lagrangian: &Lagrangian,
    combinations: &[Combination],
    lacking: &[f64],
    arm: &Arm,
    reach: &[f64],
) -> Vec<f64> {
    let largest = reach.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    let own = recursion_rounding(arm, reach).certificates(lagrangian);
    let all = own.iter().zip(combinations).zip(lacking);
    all.map(|((own, terms), lacking)| {
        let sum: f64 = terms.iter().map(|&(l, k)| k.abs() * monomial(lagrangian, l, reach)).sum();
        (own.bound + gamma(1024.0) * sum + lacking * largest).next_up()
    })
    .collect()
}
