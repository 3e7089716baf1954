//! The recursion over norms: how large what it sums can be, and how much that changes with its constants.
//!
//! D, h and G are sums of products of rotations, vectors, inertias and the symmetric bilinear form
//! Γ = [ω̇]× + ½(ω ω_rᵀ + ω_r ωᵀ) − (ω·ω_r)·1, linear in each constant wherever it occurs. The same sum over norms bounds
//! the magnitude of every entry and of everything that is summed on the way, also where the entry itself is zero. Where a
//! constant of norm x is off by δx, the entry is off by no more than the sum over x + δx exceeds the sum over x.
//!
//! Norms: ‖Γ‖ ≤ |ω̇| + |ω||ω_r|; the axial vector of ΓΣ − (ΓΣ)ᵀ ≤ √2 ‖Γ‖ ‖Σ‖_F.

use std::f64::consts::SQRT_2;
use std::ops::{Add, Mul};

use crate::arm::{Arm, Joint, JointKind, distance};

/// A bound on a norm, and on what it can change by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// The norm.
    pub exact: f64,
    /// What it can change by.
    pub change: f64,
}

impl Size {
    /// A norm that does not change.
    pub fn fixed(exact: f64) -> Self {
        Self { exact, change: 0.0 }
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

/// The norms of one joint's constants.
#[derive(Clone, Copy, Debug)]
struct Link {
    kind: JointKind,
    /// Of the rotation from the frame before, 1.
    turn: Size,
    /// Distance of the moved frame's origin in the frame before, m.
    origin: Size,
    mass: Size,
    first: Size,
    /// √2 ‖Σ‖_F.
    second: Size,
    armature: f64,
}

impl Link {
    /// Where |q| ≤ `position_bound`, m, for a prismatic joint.
    fn new(joint: &Joint, position_bound: f64) -> Self {
        let fixed = norm(&joint.pose.translation);
        let body = &joint.body;
        Self {
            kind: joint.kind,
            turn: Size::fixed(1.0),
            origin: Size::fixed(match joint.kind {
                JointKind::Revolute => fixed,
                JointKind::Prismatic => fixed + position_bound,
            }),
            mass: Size::fixed(body.mass.abs()),
            first: Size::fixed(norm(&body.first_moment)),
            second: Size::fixed(SQRT_2 * norm(body.pseudo_inertia.as_flattened())),
            armature: joint.armature.abs(),
        }
    }

    /// The same, with what `other` differs by as the change.
    fn beside(joint: &Joint, other: &Joint, position_bound: f64) -> Self {
        let mut out = Self::new(joint, position_bound);
        let (a, b) = (&joint.body, &other.body);
        let apart = |a: &[f64], b: &[f64]| norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
        // A rotation that is off by an angle moves no unit vector by more.
        out.turn.change = UP * distance(&joint.pose.rotation, &other.pose.rotation);
        out.origin.change = apart(&joint.pose.translation, &other.pose.translation);
        if joint.kind == JointKind::Prismatic {
            out.origin.change += position_bound * out.turn.change;
        }
        out.mass.change = (a.mass - b.mass).abs();
        out.first.change = apart(&a.first_moment, &b.first_moment);
        let second = apart(a.pseudo_inertia.as_flattened(), b.pseudo_inertia.as_flattened());
        out.second.change = SQRT_2 * second;
        out
    }
}

/// Factor for the few roundings of a norm, and for the angle between rotations that a norm of their difference stands for:
/// it is below that angle by a part of its square.
const UP: f64 = 1.0 + 1e-3;

/// Bounds on the entries of the model (1).
#[derive(Clone, Debug, PartialEq)]
pub struct Sizes {
    /// D, n×n, armature included.
    pub mass_matrix: Vec<Vec<Size>>,
    /// h_ijk, n×n×n.
    pub christoffel: Vec<Vec<Vec<Size>>>,
    /// G, n.
    pub gravity: Vec<Size>,
}

impl Sizes {
    /// Of `arm`, where |q_j| ≤ `position_bound`, m, for prismatic joints.
    pub fn new(arm: &Arm, position_bound: &[f64]) -> Self {
        Self::within(arm, &moving_reach(arm, position_bound))
    }

    /// The same, where `position_bound` bounds the positions of all joints that move.
    pub fn within(arm: &Arm, position_bound: &[f64]) -> Self {
        Self::of(&links(arm, position_bound), norm(&arm.gravity)).gathered(arm)
    }

    /// The same, where every joint's sine and cosine are off by `sine`: in the plane that it turns, its rotation times a
    /// number of modulus below √2 `sine` is added.
    pub fn with_sines(arm: &Arm, position_bound: &[f64], sine: f64) -> Self {
        let mut links = links(arm, &moving_reach(arm, position_bound));
        let couplings = arm.linkage.iter().flat_map(|linkage| &linkage.couplings);
        let parts = f64::from(arm.parts().into_iter().max().unwrap_or(1));
        let most = couplings.map(|c| c.multiplier.abs() * parts + 1.0).fold(1.0, f64::max);
        // The sine of k times an angle and a constant one more comes from k + 1 turns, each as far off.
        let change = match most > 1.0 && sine > 0.0 {
            true => UP * (libm::pow(1.0 + SQRT_2 * sine, most) - 1.0),
            false => SQRT_2 * sine,
        };
        for link in links.iter_mut().filter(|link| link.kind == JointKind::Revolute) {
            link.turn.change = change;
        }
        Self::of(&links, norm(&arm.gravity)).gathered(arm)
    }

    /// The same, with what `other` differs by, an arm with the same joints.
    pub fn beside(arm: &Arm, other: &Arm, position_bound: &[f64]) -> Self {
        let position_bound = moving_reach(arm, position_bound);
        let joints = arm.moving().iter().zip(other.moving()).enumerate();
        let links: Vec<Link> =
            joints.map(|(j, (joint, other))| Link::beside(joint, other, at(&position_bound, j))).collect();
        Self::of(&links, norm(&arm.gravity)).gathered(arm)
    }

    /// Of the coordinates of `arm`, where these are those of its chain: |J|ᵀ D' |J| and so on, and the armature.
    fn gathered(self, arm: &Arm) -> Self {
        let Some(linkage) = &arm.linkage else { return self };
        let n = arm.dof();
        let zero = Size::default();
        let mut out = Self {
            mass_matrix: vec![vec![zero; n]; n],
            christoffel: vec![vec![vec![zero; n]; n]; n],
            gravity: vec![zero; n],
        };
        let by = |size: Size, m: f64| Size { exact: size.exact * m.abs(), change: size.change * m.abs() };
        for (i, a) in linkage.couplings.iter().enumerate() {
            let row = a.coordinate;
            out.gravity[row] = out.gravity[row] + by(self.gravity[i], a.multiplier);
            for (j, b) in linkage.couplings.iter().enumerate() {
                let both = a.multiplier * b.multiplier;
                let sum = &mut out.mass_matrix[row][b.coordinate];
                *sum = *sum + by(self.mass_matrix[i][j], both);
                for (k, c) in linkage.couplings.iter().enumerate() {
                    let sum = &mut out.christoffel[row][b.coordinate][c.coordinate];
                    *sum = *sum + by(self.christoffel[i][j][k], both * c.multiplier);
                }
            }
        }
        for (j, joint) in arm.joints.iter().enumerate() {
            out.mass_matrix[j][j] = out.mass_matrix[j][j] + Size::fixed(joint.armature.abs());
        }
        out
    }

    fn of(links: &[Link], gravity: f64) -> Self {
        let n = links.len();
        let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
        let rest = vec![0.0; n];
        let zero = Size::default();
        let mut out = Self {
            mass_matrix: vec![vec![zero; n]; n],
            christoffel: vec![vec![vec![zero; n]; n]; n],
            gravity: torque(links, gravity, &rest, &rest, &rest),
        };
        for j in 0..n {
            for (row, size) in out.mass_matrix.iter_mut().zip(torque(links, 0.0, &rest, &rest, &unit(j))) {
                row[j] = size;
            }
            out.mass_matrix[j][j] = out.mass_matrix[j][j] + Size::fixed(links[j].armature);
            for k in j..n {
                let sizes = torque(links, 0.0, &unit(j), &unit(k), &rest);
                for (plane, size) in out.christoffel.iter_mut().zip(sizes) {
                    plane[j][k] = size;
                    plane[k][j] = size;
                }
            }
        }
        out
    }
}

/// Bounds on the positions of the joints that move, from those of the coordinates.
fn moving_reach(arm: &Arm, position_bound: &[f64]) -> Vec<f64> {
    arm.linkage
        .as_ref()
        .map_or_else(|| position_bound.to_vec(), |linkage| linkage.position_bound(position_bound))
}

fn links(arm: &Arm, position_bound: &[f64]) -> Vec<Link> {
    arm.moving().iter().enumerate().map(|(j, joint)| Link::new(joint, at(position_bound, j))).collect()
}

fn at(position_bound: &[f64], joint: usize) -> f64 {
    position_bound.get(joint).copied().unwrap_or_default()
}

/// By joint, a bound on |τ_i| for gravity and rates of the given magnitudes.
fn torque(links: &[Link], gravity: f64, qd: &[f64], v_r: &[f64], a_r: &[f64]) -> Vec<Size> {
    let (mut velocity, mut reference, mut angular) = (Size::default(), Size::default(), Size::default());
    let (mut linear, mut gradient) = (Size::fixed(gravity), Size::default());
    let half = Size::fixed(0.5);
    let mut wrenches = Vec::with_capacity(links.len());
    for (j, link) in links.iter().enumerate() {
        let turn = link.turn;
        let [rate, wanted, rise] = [qd[j], v_r[j], a_r[j]].map(Size::fixed);
        (velocity, reference, angular) = (turn * velocity, turn * reference, turn * angular);
        linear = turn * (linear + gradient * link.origin);
        let bend = velocity * wanted + reference * rate;
        match link.kind {
            JointKind::Revolute => {
                angular = angular + half * bend + rise;
                (velocity, reference) = (velocity + rate, reference + wanted);
            }
            JointKind::Prismatic => linear = linear + bend + rise,
        }
        gradient = angular + velocity * reference;
        wrenches
            .push((link.mass * linear + link.first * gradient, link.second * gradient + link.first * linear));
    }
    let mut torque = Vec::with_capacity(links.len());
    let mut carried = (Size::default(), Size::default());
    for (link, wrench) in links.iter().zip(wrenches).rev() {
        let (force, moment) = (wrench.0 + carried.0, wrench.1 + carried.1);
        torque.push(match link.kind {
            JointKind::Revolute => moment,
            JointKind::Prismatic => force,
        });
        let turn = link.turn;
        carried = (turn * force, turn * moment + link.origin * turn * force);
    }
    torque.reverse();
    torque
}

/// Euclidean norm, rounded up.
fn norm(x: &[f64]) -> f64 {
    libm::sqrt(x.iter().map(|x| x * x).sum::<f64>()) * (1.0 + 8.0 * f64::EPSILON)
}
