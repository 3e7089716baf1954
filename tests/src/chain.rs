//! An outside oracle: the dynamics of a chain of joints in the base frame, after Newton and Euler, from the numbers of a
//! URDF file. It shares nothing with the generator: no joint frames, no polarisation, no expansion.

/// A joint and the link behind it, as a URDF file says them.
#[derive(Clone, Debug)]
pub struct Link {
    /// Whether the joint slides.
    pub prismatic: bool,
    /// Origin of the joint's frame in that of the link before, m.
    pub xyz: [f64; 3],
    /// Its roll, pitch and yaw, rad.
    pub rpy: [f64; 3],
    /// Axis in the joint's frame, of any length.
    pub axis: [f64; 3],
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the joint's frame, m.
    pub com: [f64; 3],
    /// Roll, pitch and yaw of the frame of `inertia`, rad.
    pub com_rpy: [f64; 3],
    /// ixx, iyy, izz, ixy, ixz, iyz about the centre of mass, kg·m².
    pub inertia: [f64; 6],
    /// Rotor inertia, joint side, kg·m² or kg.
    pub armature: f64,
    /// The coordinate that the joint follows, its rate over that of the coordinate, and its position where that is 0;
    /// (i, 1, 0) for the joint that has coordinate i.
    pub follows: (usize, f64, f64),
}

pub(crate) type Vector = [f64; 3];
pub(crate) type Matrix = [[f64; 3]; 3];

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(crate) fn scaled(a: Vector, k: f64) -> Vector {
    a.map(|x| k * x)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn apply(m: &Matrix, x: Vector) -> Vector {
    std::array::from_fn(|i| dot(m[i], x))
}

pub(crate) fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub(crate) fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// The turn by `angle` about the unit vector `axis`, after Rodrigues.
pub(crate) fn about(axis: Vector, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let across = [[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let own = if i == j { c } else { 0.0 };
            own + s * across[i][j] + (1.0 - c) * axis[i] * axis[j]
        })
    })
}

pub(crate) fn turned([roll, pitch, yaw]: Vector) -> Matrix {
    let x = about([1.0, 0.0, 0.0], roll);
    let y = about([0.0, 1.0, 0.0], pitch);
    times(&about([0.0, 0.0, 1.0], yaw), &times(&y, &x))
}

/// What a joint and its link do at one instant, base frame.
struct State {
    axis: Vector,
    origin: Vector,
    com: Vector,
    force: Vector,
    moment: Vector,
}

/// A chain with its gravity, m/s².
#[derive(Clone, Debug)]
pub struct Chain {
    /// The links, base first.
    pub links: Vec<Link>,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [f64; 3],
}

impl Chain {
    /// Number of coordinates.
    pub fn dof(&self) -> usize {
        self.links.iter().map(|link| link.follows.0 + 1).max().unwrap_or(0)
    }

    /// τ of the coordinates for their positions, velocities and accelerations, N·m or N: Jᵀ τ' of all joints.
    pub fn torque(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
        let states = self.states(q, qd, qdd);
        let mut torque = vec![0.0; self.dof()];
        for (i, (link, own)) in self.links.iter().zip(&states).enumerate() {
            let (c, m, _) = link.follows;
            let mut along = link.armature * m * qdd[c];
            for outer in &states[i..] {
                let lever = add(outer.com, scaled(own.origin, -1.0));
                along += if link.prismatic {
                    dot(own.axis, outer.force)
                } else {
                    dot(own.axis, add(cross(lever, outer.force), outer.moment))
                };
            }
            torque[c] += m * along;
        }
        torque
    }

    fn states(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<State> {
        let mut turn = turned([0.0; 3]);
        let (mut origin, mut omega, mut alpha) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut linear = scaled(self.gravity, -1.0);
        let mut states = Vec::new();
        for link in &self.links {
            let (c, m, offset) = link.follows;
            let (q, qd, qdd) = (m * q[c] + offset, m * qd[c], m * qdd[c]);
            let length = dot(link.axis, link.axis).sqrt();
            let unit = scaled(link.axis, 1.0 / length);
            let frame = times(&turn, &turned(link.rpy));
            let axis = apply(&frame, unit);
            let slide = if link.prismatic { scaled(axis, q) } else { [0.0; 3] };
            let step = add(apply(&turn, link.xyz), slide);
            origin = add(origin, step);
            linear = add(linear, add(cross(alpha, step), cross(omega, cross(omega, step))));
            if link.prismatic {
                linear = add(linear, add(scaled(axis, qdd), scaled(cross(omega, axis), 2.0 * qd)));
                turn = frame;
            } else {
                alpha = add(alpha, add(scaled(axis, qdd), scaled(cross(omega, axis), qd)));
                omega = add(omega, scaled(axis, qd));
                turn = times(&frame, &about(unit, q));
            }
            let arm = apply(&turn, link.com);
            let centre = add(linear, add(cross(alpha, arm), cross(omega, cross(omega, arm))));
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            let axes = times(&turn, &turned(link.com_rpy));
            let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            let inertia = times(&axes, &times(&own, &transposed(&axes)));
            let moment = add(apply(&inertia, alpha), cross(omega, apply(&inertia, omega)));
            let force = scaled(centre, link.mass);
            states.push(State { axis, origin, com: add(origin, arm), force, moment });
        }
        states
    }

    /// G(q).
    pub fn gravity_torque(&self, q: &[f64]) -> Vec<f64> {
        let rest = vec![0.0; self.dof()];
        self.torque(q, &rest, &rest)
    }

    /// D(q) by rows.
    pub fn mass_matrix(&self, q: &[f64]) -> Vec<Vec<f64>> {
        let still = Self { gravity: [0.0; 3], ..self.clone() };
        let rest = vec![0.0; self.dof()];
        let columns: Vec<Vec<f64>> =
            (0..self.dof()).map(|j| still.torque(q, &rest, &unit(self.dof(), j))).collect();
        (0..self.dof()).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
    }

    /// The Christoffel C(q, q̇) by rows: the velocity terms are a quadratic form, and C x is its polar form.
    pub fn coriolis(&self, q: &[f64], qd: &[f64]) -> Vec<Vec<f64>> {
        let still = Self { gravity: [0.0; 3], ..self.clone() };
        let rest = vec![0.0; self.dof()];
        let form = |x: &[f64]| still.torque(q, x, &rest);
        let column = |j: usize| -> Vec<f64> {
            let other = unit(self.dof(), j);
            let sum: Vec<f64> = qd.iter().zip(&other).map(|(a, b)| a + b).collect();
            let difference: Vec<f64> = qd.iter().zip(&other).map(|(a, b)| a - b).collect();
            form(&sum).iter().zip(form(&difference)).map(|(a, b)| 0.25 * (a - b)).collect()
        };
        let columns: Vec<Vec<f64>> = (0..self.dof()).map(column).collect();
        (0..self.dof()).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
    }

    /// The chain as a URDF file with links `base`, `l1`… and joints `j1`…, all limits ±2, 3 and 500.
    pub fn urdf(&self) -> String {
        let triple = |x: [f64; 3]| format!("{} {} {}", x[0], x[1], x[2]);
        let mut out =
            String::from("<?xml version=\"1.0\"?>\n<robot name=\"chain\">\n  <link name=\"base\"/>\n");
        for (i, link) in (1..).zip(&self.links) {
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            out.push_str(&format!(
                "  <link name=\"l{i}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"{}\"/>\n      \
                 <mass value=\"{}\"/>\n      <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"{xy}\" \
                 ixz=\"{xz}\" iyz=\"{yz}\"/>\n    </inertial>\n  </link>\n",
                triple(link.com),
                triple(link.com_rpy),
                link.mass
            ));
        }
        for (i, link) in self.links.iter().enumerate() {
            let (coordinate, multiplier, offset) = link.follows;
            let (kind, parent) = (
                if link.prismatic { "prismatic" } else { "revolute" },
                if i == 0 { "base".to_string() } else { format!("l{i}") },
            );
            let master = self.links.iter().position(|l| l.follows == (coordinate, 1.0, 0.0));
            let mimic = match master.filter(|master| *master != i) {
                Some(master) => format!(
                    "\n    <mimic joint=\"j{}\" multiplier=\"{multiplier}\" offset=\"{offset}\"/>",
                    master + 1
                ),
                None => String::new(),
            };
            out.push_str(&format!(
                "  <joint name=\"j{}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    <child link=\"l{}\"/>\n    \
                 <origin xyz=\"{}\" rpy=\"{}\"/>\n    <axis xyz=\"{}\"/>\n    \
                 <limit lower=\"-2\" upper=\"2\" effort=\"500\" velocity=\"3\"/>{mimic}\n  </joint>\n",
                i + 1,
                i + 1,
                triple(link.xyz),
                triple(link.rpy),
                triple(link.axis)
            ));
        }
        out + "</robot>\n"
    }
}

fn unit(n: usize, j: usize) -> Vec<f64> {
    (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect()
}
