//! A [`Chain`] that moves: composite bodies in the base frame, made ready to be integrated millions of times. Like the chain, it
//! shares nothing with the generator.

use crate::chain::{Chain, Matrix, Vector, about, add, apply, cross, dot, scaled, times, transposed, turned};

/// Most joints of a plant.
pub const MOST: usize = 7;

/// One number for each joint; those beyond the last joint are zero.
pub type Row = [f64; MOST];

/// `values` as a row.
pub fn row(values: &[f64]) -> Row {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
}

#[derive(Clone, Debug)]
struct Body {
    prismatic: bool,
    xyz: Vector,
    placed: Matrix,
    axis: Vector,
    mass: f64,
    com: Vector,
    inertia: Matrix,
    armature: f64,
}

/// An arm whose joints each have a coordinate of their own.
#[derive(Clone, Debug)]
pub struct Plant {
    bodies: Vec<Body>,
    gravity: Vector,
    /// Viscous friction by joint, N·m·s/rad or N·s/m; none at first.
    pub viscous: Row,
    /// Coulomb friction by joint, the same both ways, N·m or N; none at first. A joint at rest stays there until more pulls at it.
    pub coulomb: Row,
}

/// Where a joint is and what moves behind it, base frame.
#[derive(Clone, Copy, Debug, Default)]
struct Placed {
    axis: Vector,
    origin: Vector,
    mass: f64,
    /// Mass times the place of the centre.
    first: Vector,
    /// Inertia about the origin of the base.
    second: Matrix,
    /// Force, and its moment about the origin of the base.
    force: Vector,
    moment: Vector,
}

impl Plant {
    /// The plant of `chain`.
    ///
    /// # Panics
    /// If a joint follows another, or there are more than [`MOST`].
    pub fn new(chain: &Chain) -> Self {
        assert!(chain.links.len() <= MOST, "{} joints", chain.links.len());
        let body = |(i, link): (usize, &crate::chain::Link)| {
            assert_eq!(link.follows, (i, 1.0, 0.0), "joint {i} follows another");
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            let axes = turned(link.com_rpy);
            let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            Body {
                prismatic: link.prismatic,
                xyz: link.xyz,
                placed: turned(link.rpy),
                axis: scaled(link.axis, 1.0 / dot(link.axis, link.axis).sqrt()),
                mass: link.mass,
                com: link.com,
                inertia: times(&axes, &times(&own, &transposed(&axes))),
                armature: link.armature,
            }
        };
        let bodies = chain.links.iter().enumerate().map(body).collect();
        Self { bodies, gravity: chain.gravity, viscous: [0.0; MOST], coulomb: [0.0; MOST] }
    }

    /// Number of joints.
    pub fn dof(&self) -> usize {
        self.bodies.len()
    }

    /// D(q) q̈ + C(q, q̇) q̇, and G(q) if `heavy`, N·m or N.
    pub fn torque(&self, q: &Row, qd: &Row, qdd: &Row, heavy: bool) -> Row {
        let placed = self.placed(q, qd, qdd, heavy);
        self.load(&placed, qdd)
    }

    /// D(q) a_r + C(q, q̇) v_r + G(q) with the C of Christoffel: C v_r is the polar form of C(q, x) x.
    pub fn passivity_torque(&self, q: &Row, qd: &Row, v_r: &Row, a_r: &Row) -> Row {
        let still = [0.0; MOST];
        let own = self.torque(q, &still, a_r, true);
        let sum = self.torque(q, &std::array::from_fn(|i| qd[i] + v_r[i]), &still, false);
        let difference = self.torque(q, &std::array::from_fn(|i| qd[i] - v_r[i]), &still, false);
        std::array::from_fn(|i| own[i] + 0.25 * (sum[i] - difference[i]))
    }

    /// q̈ under the torques `torque`, with friction.
    pub fn acceleration(&self, q: &Row, qd: &Row, torque: &Row) -> Row {
        let still = [0.0; MOST];
        let placed = self.placed(q, qd, &still, true);
        let load = self.load(&placed, &still);
        let matrix = self.mass_matrix(&placed);
        let friction = |i: usize| {
            let side = if qd[i] == 0.0 { 0.0 } else { qd[i].signum() };
            self.viscous[i] * qd[i] + self.coulomb[i] * side
        };
        let rest = std::array::from_fn(|i| torque[i] - load[i] - friction(i));
        let holds = std::array::from_fn(|i| qd[i] == 0.0 && self.coulomb[i] > 0.0);
        self.slipping(&matrix, rest, holds)
    }

    /// q̈ where `matrix` q̈ = `rest` less dry friction of the joints that it `holds`: all of them first, then without those at which
    /// more than their friction pulls, one after the other.
    fn slipping(&self, matrix: &[Row; MOST], mut rest: Row, mut holds: [bool; MOST]) -> Row {
        let n = self.dof();
        loop {
            let (mut free, mut right) = (*matrix, rest);
            for i in (0..n).filter(|&i| holds[i]) {
                (0..n).for_each(|j| (free[i][j], free[j][i]) = (0.0, 0.0));
                (free[i][i], right[i]) = (1.0, 0.0);
            }
            let found = solved(&mut free, right, n);
            let pull = |i: usize| rest[i] - (0..n).map(|j| matrix[i][j] * found[j]).sum::<f64>();
            let Some(i) = (0..n).find(|&i| holds[i] && pull(i).abs() > self.coulomb[i]) else { return found };
            rest[i] -= self.coulomb[i] * pull(i).signum();
            holds[i] = false;
        }
    }

    /// One Runge–Kutta step of `h` seconds under a held torque.
    pub fn step(&self, q: &mut Row, qd: &mut Row, torque: &Row, h: f64) {
        let moved = |x: &Row, by: &Row, h: f64| -> Row { std::array::from_fn(|i| x[i] + h * by[i]) };
        let a1 = self.acceleration(q, qd, torque);
        let v2 = moved(qd, &a1, 0.5 * h);
        let a2 = self.acceleration(&moved(q, qd, 0.5 * h), &v2, torque);
        let v3 = moved(qd, &a2, 0.5 * h);
        let a3 = self.acceleration(&moved(q, &v2, 0.5 * h), &v3, torque);
        let v4 = moved(qd, &a3, h);
        let a4 = self.acceleration(&moved(q, &v3, h), &v4, torque);
        for i in 0..self.dof() {
            q[i] += h / 6.0 * (qd[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
            let before = qd[i];
            qd[i] += h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
            // Dry friction has stopped it on the way.
            if self.coulomb[i] > 0.0 && before * qd[i] < 0.0 {
                qd[i] = 0.0;
            }
        }
    }

    fn placed(&self, q: &Row, qd: &Row, qdd: &Row, heavy: bool) -> [Placed; MOST] {
        let mut out = [Placed::default(); MOST];
        let mut turn = turned([0.0; 3]);
        let (mut origin, mut omega, mut alpha) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut linear = if heavy { scaled(self.gravity, -1.0) } else { [0.0; 3] };
        for (i, body) in self.bodies.iter().enumerate() {
            let frame = times(&turn, &body.placed);
            let axis = apply(&frame, body.axis);
            let mut step = apply(&turn, body.xyz);
            if body.prismatic {
                step = add(step, scaled(axis, q[i]));
            }
            origin = add(origin, step);
            linear = add(linear, add(cross(alpha, step), cross(omega, cross(omega, step))));
            if body.prismatic {
                linear = add(linear, add(scaled(axis, qdd[i]), scaled(cross(omega, axis), 2.0 * qd[i])));
                turn = frame;
            } else {
                alpha = add(alpha, add(scaled(axis, qdd[i]), scaled(cross(omega, axis), qd[i])));
                omega = add(omega, scaled(axis, qd[i]));
                turn = times(&frame, &about(body.axis, q[i]));
            }
            let lever = apply(&turn, body.com);
            let centre = add(origin, lever);
            let pull = add(linear, add(cross(alpha, lever), cross(omega, cross(omega, lever))));
            let own = times(&turn, &times(&body.inertia, &transposed(&turn)));
            let force = scaled(pull, body.mass);
            let spin = add(apply(&own, alpha), cross(omega, apply(&own, omega)));
            let far = body.mass * dot(centre, centre);
            out[i] = Placed {
                axis,
                origin,
                mass: body.mass,
                first: scaled(centre, body.mass),
                second: std::array::from_fn(|a| {
                    std::array::from_fn(|b| {
                        own[a][b] + if a == b { far } else { 0.0 } - body.mass * centre[a] * centre[b]
                    })
                }),
                force,
                moment: add(spin, cross(centre, force)),
            };
        }
        for i in (1..self.dof()).rev() {
            let outer = out[i];
            let inner = &mut out[i - 1];
            inner.mass += outer.mass;
            inner.first = add(inner.first, outer.first);
            inner.force = add(inner.force, outer.force);
            inner.moment = add(inner.moment, outer.moment);
            for (a, b) in inner.second.iter_mut().zip(&outer.second) {
                *a = add(*a, *b);
            }
        }
        out
    }

    /// The torques that hold the forces of `placed`, and what the rotors take.
    fn load(&self, placed: &[Placed; MOST], qdd: &Row) -> Row {
        let mut out = [0.0; MOST];
        for (i, body) in self.bodies.iter().enumerate() {
            out[i] = body.armature * qdd[i] + self.along(i, &placed[i], placed[i].force, placed[i].moment);
        }
        out
    }

    /// What joint `i` feels of a force and of its moment about the origin of the base.
    fn along(&self, i: usize, joint: &Placed, force: Vector, moment: Vector) -> f64 {
        match self.bodies[i].prismatic {
            true => dot(joint.axis, force),
            false => dot(joint.axis, add(moment, scaled(cross(joint.origin, force), -1.0))),
        }
    }

    fn mass_matrix(&self, placed: &[Placed; MOST]) -> [Row; MOST] {
        let mut out = [[0.0; MOST]; MOST];
        for (k, body) in self.bodies.iter().enumerate() {
            let joint = &placed[k];
            let (spin, base) = match body.prismatic {
                true => ([0.0; 3], joint.axis),
                false => (joint.axis, cross(joint.origin, joint.axis)),
            };
            let momentum = add(scaled(base, joint.mass), cross(spin, joint.first));
            let turning = add(apply(&joint.second, spin), cross(joint.first, base));
            for j in 0..=k {
                out[k][j] = self.along(j, &placed[j], momentum, turning);
                out[j][k] = out[k][j];
            }
            out[k][k] += body.armature;
        }
        out
    }
}

/// Solves `matrix` x = `right` after Cholesky.
fn solved(matrix: &mut [Row; MOST], mut right: Row, n: usize) -> Row {
    for j in 0..n {
        for k in 0..j {
            let factor = matrix[j][k];
            for i in j..n {
                matrix[i][j] -= matrix[i][k] * factor;
            }
            right[j] -= factor * right[k];
        }
        let root = matrix[j][j].sqrt();
        for i in j..n {
            matrix[i][j] /= root;
        }
        right[j] /= root;
    }
    for j in (0..n).rev() {
        for i in j + 1..n {
            right[j] -= matrix[i][j] * right[i];
        }
        right[j] /= matrix[j][j];
    }
    right
}
