//! Links of an arm at one position: poses, bodies and what moves them.

use crate::arm::{Coupling, Joint, JointKind};

pub(super) type Vector = [f64; 3];
/// By rows.
pub(super) type Matrix = [Vector; 3];

#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) kind: JointKind,
    /// The coordinate that the joint follows; itself in an arm without joints that follow others.
    pub(super) follows: Coupling,
    rotation: Matrix,
    translation: Vector,
    pub(super) body: Composite,
    /// Inertia tensor about the frame's origin.
    pub(super) inertia: Matrix,
}

/// Mass, first moment and pseudo-inertia of one body or several.
#[derive(Clone, Copy, Debug)]
pub(super) struct Composite {
    pub(super) mass: f64,
    pub(super) first: Vector,
    second: Matrix,
}

/// Where a joint's moved frame stands in the frame before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pose {
    rotation: Matrix,
    pub(super) origin: Vector,
}

impl Link {
    pub(super) fn new(joint: &Joint, follows: Coupling) -> Self {
        let (body, second) = (&joint.body, joint.body.pseudo_inertia);
        let trace = second[0][0] + second[1][1] + second[2][2];
        let mut inertia = second.map(|row| row.map(|entry| -entry));
        (0..3).for_each(|i| inertia[i][i] += trace);
        Self {
            kind: joint.kind,
            follows,
            rotation: joint.pose.rotation,
            translation: joint.pose.translation,
            body: Composite { mass: body.mass, first: body.first_moment, second },
            inertia,
        }
    }

    /// The pose where the arm's coordinates are `q`.
    pub(super) fn pose(&self, q: &[f64]) -> Pose {
        let q = q.get(self.follows.coordinate).map_or(0.0, |q| self.follows.multiplier * q);
        let (q, fixed) = (q + self.follows.offset, &self.rotation);
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = libm::sincos(q);
                let turned = |[x, y, z]: Vector| -> Vector { [cos * x + sin * y, cos * y - sin * x, z] };
                Pose { rotation: fixed.map(turned), origin: self.translation }
            }
            JointKind::Prismatic => {
                let origin = std::array::from_fn(|i| self.translation[i] + fixed[i][2] * q);
                Pose { rotation: *fixed, origin }
            }
        }
    }

    /// The rate of the joint where those of the coordinates are `qd`.
    pub(super) fn rate(&self, qd: &[f64]) -> f64 {
        qd.get(self.follows.coordinate).map_or(0.0, |qd| self.follows.multiplier * qd)
    }
}

impl Pose {
    /// A vector of the moved frame, in the frame before.
    fn outward(&self, x: Vector) -> Vector {
        apply(&self.rotation, x)
    }

    /// A vector of the frame before, in the moved frame.
    pub(super) fn inward(&self, x: Vector) -> Vector {
        let r = &self.rotation;
        std::array::from_fn(|i| r[0][i] * x[0] + r[1][i] * x[1] + r[2][i] * x[2])
    }

    /// Force and moment about the moved frame's origin, in the frame before and about its origin.
    pub(super) fn wrench(&self, force: Vector, moment: Vector) -> (Vector, Vector) {
        let force = self.outward(force);
        (force, add(self.outward(moment), cross(self.origin, force)))
    }

    /// A body of the moved frame, in the frame before.
    pub(super) fn moved(&self, body: &Composite) -> Composite {
        let (r, p, mass) = (&self.rotation, self.origin, body.mass);
        let first = self.outward(body.first);
        // R Σ Rᵀ: Σ is symmetric, so that its rows are its columns.
        let half = body.second.map(|row| apply(r, row));
        let second = std::array::from_fn(|i| {
            let turned: Vector =
                std::array::from_fn(|j| r[i][0] * half[0][j] + r[i][1] * half[1][j] + r[i][2] * half[2][j]);
            std::array::from_fn(|j| turned[j] + first[i] * p[j] + p[i] * first[j] + mass * p[i] * p[j])
        });
        Composite { mass, first: std::array::from_fn(|i| first[i] + mass * p[i]), second }
    }
}

impl Composite {
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first: add(self.first, other.first),
            second: std::array::from_fn(|i| add(self.second[i], other.second[i])),
        }
    }

    /// Force and moment that give the body unit acceleration about or along z.
    pub(super) fn driven(&self, kind: JointKind) -> (Vector, Vector) {
        let (h, s) = (self.first, &self.second);
        match kind {
            JointKind::Revolute => ([-h[1], h[0], 0.0], [-s[0][2], -s[1][2], s[0][0] + s[1][1]]),
            JointKind::Prismatic => ([0.0, 0.0, self.mass], [h[1], -h[0], 0.0]),
        }
    }
}

/// What the joint itself has to bear.
pub(super) fn along(kind: JointKind, force: Vector, moment: Vector) -> f64 {
    match kind {
        JointKind::Revolute => moment[2],
        JointKind::Prismatic => force[2],
    }
}

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn apply(m: &Matrix, x: Vector) -> Vector {
    m.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}
