//! Torques at one position by composite bodies: for every pair of joint speeds at once what the recursion gives for one
//! choice of all speeds. They round otherwise than the recursion does, so they only tell where it is worth running.

use crate::arm::{Arm, Body, JointKind, Transform};
use crate::lagrangian::MAX_JOINTS;

/// How far torques by composite bodies and by the recursion may be apart, as a part of their sizes: some hundred times what
/// they round by.
const APART: f64 = 4e-12;

/// An arm at one position, in the base frame.
pub(super) struct Composite {
    kinds: Vec<JointKind>,
    axes: Vec<[f64; 3]>,
    origins: Vec<[f64; 3]>,
    armature: Vec<f64>,
    gravity: [f64; 3],
    /// All that joint j carries, as one body.
    carried: Vec<Body>,
}

/// A field x ↦ G x + b of velocities or accelerations.
#[derive(Clone, Copy)]
struct Field {
    gradient: [[f64; 3]; 3],
    constant: [f64; 3],
}

impl Composite {
    /// `arm` at `q`; no joint follows another.
    pub fn new(arm: &Arm, q: &[f64]) -> Self {
        let n = arm.dof();
        let mut out = Self {
            kinds: arm.joints.iter().map(|joint| joint.kind).collect(),
            axes: Vec::with_capacity(n),
            origins: Vec::with_capacity(n),
            armature: arm.joints.iter().map(|joint| joint.armature).collect(),
            gravity: arm.gravity,
            carried: Vec::with_capacity(n),
        };
        let mut pose = Transform::IDENTITY;
        for (joint, &q) in arm.joints.iter().zip(q) {
            pose = moved(&pose, &joint.pose);
            match joint.kind {
                JointKind::Revolute => {
                    let (sin, cos) = libm::sincos(q);
                    let turned = |[x, y, z]: [f64; 3]| [cos * x + sin * y, cos * y - sin * x, z];
                    pose.rotation = pose.rotation.map(turned);
                }
                JointKind::Prismatic => {
                    let rows = pose.translation.iter_mut().zip(&pose.rotation);
                    rows.for_each(|(p, row)| *p += q * row[2]);
                }
            }
            out.axes.push(pose.rotation.map(|row| row[2]));
            out.origins.push(pose.translation);
            out.carried.push(joint.body.moved(&pose));
        }
        for j in (1..n).rev() {
            out.carried[j - 1] = out.carried[j - 1].plus(&out.carried[j]);
        }
        out
    }

    /// g_i, row i of D, and by pair j ≤ k what multiplies q̇_j q̇_k in τ_i.
    pub fn row(&self, i: usize) -> (f64, [f64; MAX_JOINTS], [[f64; MAX_JOINTS]; MAX_JOINTS]) {
        let n = self.axes.len();
        let still = Field { gradient: [[0.0; 3]; 3], constant: self.gravity.map(|g| -g) };
        let (mut d, mut c) = ([0.0; MAX_JOINTS], [[0.0; MAX_JOINTS]; MAX_JOINTS]);
        for k in 0..n {
            let moved = self.velocity(k);
            d[k] = self.along(i, i.max(k), &moved);
            for j in (0..=k).filter(|&j| self.kinds[j] == JointKind::Revolute) {
                let factor = if j == k { 1.0 } else { 2.0 };
                c[j][k] = factor * self.along(i, i.max(k), &moved.swept(self.axes[j]));
            }
        }
        d[i] += self.armature[i];
        (self.along(i, i, &still), d, c)
    }

    /// Velocities that joint k gives what it carries at speed 1.
    fn velocity(&self, k: usize) -> Field {
        let z = self.axes[k];
        match self.kinds[k] {
            JointKind::Revolute => {
                let gradient = [[0.0, -z[2], z[1]], [z[2], 0.0, -z[0]], [-z[1], z[0], 0.0]];
                Field { gradient, constant: cross(z, self.origins[k]).map(|x| -x) }
            }
            JointKind::Prismatic => Field { gradient: [[0.0; 3]; 3], constant: z },
        }
    }

    /// What joint i must give for all that joint m carries to be accelerated by `field`.
    fn along(&self, i: usize, m: usize, field: &Field) -> f64 {
        let Body { mass, first_moment: s, pseudo_inertia: sigma } = &self.carried[m];
        let (g, b) = (&field.gradient, field.constant);
        let force: [f64; 3] = std::array::from_fn(|a| dot(g[a], *s) + mass * b[a]);
        let z = self.axes[i];
        if self.kinds[i] == JointKind::Prismatic {
            return dot(z, force);
        }
        // Σ is symmetric.
        let entry = |a: usize, b: usize| dot(g[a], sigma[b]);
        let pull = cross(*s, b);
        let lever = cross(self.origins[i], force);
        z[0] * (entry(2, 1) - entry(1, 2) + pull[0] - lever[0])
            + z[1] * (entry(0, 2) - entry(2, 0) + pull[1] - lever[1])
            + z[2] * (entry(1, 0) - entry(0, 1) + pull[2] - lever[2])
    }
}

impl Field {
    /// z × the field.
    fn swept(&self, z: [f64; 3]) -> Self {
        let g = &self.gradient;
        let column = |c: usize| cross(z, [g[0][c], g[1][c], g[2][c]]);
        let columns = [column(0), column(1), column(2)];
        Self {
            gradient: std::array::from_fn(|r| std::array::from_fn(|c| columns[c][r])),
            constant: cross(z, self.constant),
        }
    }
}

/// By joint a bound on how far its torques by composite bodies and by the recursion may be apart, per unit of speeds
/// squared and of accelerations, where |q_j| ≤ `reach`.
pub(super) fn apart(arm: &Arm, reach: &[f64]) -> Vec<f64> {
    let long = |x: [f64; 3]| x.iter().map(|x| x.abs()).sum::<f64>();
    let slides = |(joint, q): (&crate::arm::Joint, &f64)| match joint.kind {
        JointKind::Revolute => 0.0,
        JointKind::Prismatic => q.abs(),
    };
    let far = 1.0
        + arm.joints.iter().map(|joint| long(joint.pose.translation)).sum::<f64>()
        + arm.joints.iter().zip(reach).map(slides).sum::<f64>();
    let size = |body: &Body| {
        let second: f64 = body.pseudo_inertia.iter().map(|row| long(*row)).sum();
        second + 2.0 * long(body.first_moment) * far + body.mass.abs() * far * far
    };
    let mut sum = 0.0;
    let mut out: Vec<f64> = Vec::with_capacity(arm.dof());
    for joint in arm.joints.iter().rev() {
        sum += size(&joint.body) + joint.armature.abs();
        out.push(APART * sum);
    }
    out.reverse();
    out
}

/// `pose` in the frame at `parent`, without regard to right angles.
fn moved(parent: &Transform, pose: &Transform) -> Transform {
    let r = &pose.rotation;
    let column = |row: [f64; 3], c: usize| row[0] * r[0][c] + row[1] * r[1][c] + row[2] * r[2][c];
    Transform {
        rotation: parent.rotation.map(|row| std::array::from_fn(|c| column(row, c))),
        translation: std::array::from_fn(|i| {
            dot(parent.rotation[i], pose.translation) + parent.translation[i]
        }),
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
