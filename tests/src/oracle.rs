//! An arm and its torques outside the generator: plain Newton–Euler in the base frame, in numbers of 30 digits.

use crate::double::{Double, sin_cos};

type Vector = [Double; 3];
type Matrix = [Vector; 3];

/// One step of a kinematic chain that does not move.
#[derive(Clone, Copy, Debug)]
pub enum Fixed {
    /// Turn about coordinate axis 0, 1 or 2 by an angle, rad.
    Turn(usize, f64),
    /// Shift, m.
    Shift([f64; 3]),
}

/// A joint with the body it moves.
#[derive(Clone, Debug)]
pub struct Link {
    /// From the link frame before (the base) to the joint.
    pub before: Vec<Fixed>,
    /// Whether the joint turns; else it slides.
    pub turns: bool,
    /// Its axis, of any length.
    pub axis: [f64; 3],
    /// From the moved joint to the link frame.
    pub after: Vec<Fixed>,
    /// kg.
    pub mass: f64,
    /// Centre of mass in the link frame, m.
    pub com: [f64; 3],
    /// Inertia about it, link frame, kg·m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
}

fn lift(x: [f64; 3]) -> Vector {
    x.map(Double::from)
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn scaled(a: Vector, k: Double) -> Vector {
    a.map(|x| x * k)
}

fn dot(a: Vector, b: Vector) -> Double {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    let entry = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

fn apply(m: &Matrix, x: Vector) -> Vector {
    m.map(|row| dot(row, x))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|j| dot(row, std::array::from_fn(|k| b[k][j]))))
}

fn transposed(m: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// Rodrigues: the turn about a unit vector.
fn turn(axis: Vector, angle: f64) -> Matrix {
    let (sin, cos) = sin_cos(angle);
    let zero = Double::ZERO;
    let skew = [[zero, -axis[2], axis[1]], [axis[2], zero, -axis[0]], [-axis[1], axis[0], zero]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let own = if i == j { cos } else { zero };
            own + sin * skew[i][j] + (Double::ONE - cos) * axis[i] * axis[j]
        })
    })
}

fn unit(axis: usize) -> Vector {
    std::array::from_fn(|i| if i == axis { Double::ONE } else { Double::ZERO })
}

/// Where everything is at one position, base frame.
struct Pose {
    axis: Vector,
    origin: Vector,
    com: Vector,
    inertia: Matrix,
}

fn walk(rotation: &mut Matrix, place: &mut Vector, steps: &[Fixed]) {
    for step in steps {
        match *step {
            Fixed::Turn(axis, angle) => *rotation = product(rotation, &turn(unit(axis), angle)),
            Fixed::Shift(offset) => *place = add(*place, apply(rotation, lift(offset))),
        }
    }
}

fn poses(links: &[Link], q: &[f64]) -> Vec<Pose> {
    let mut rotation = [unit(0), unit(1), unit(2)];
    let mut place = lift([0.0; 3]);
    let mut out = Vec::new();
    for (link, &q) in links.iter().zip(q) {
        walk(&mut rotation, &mut place, &link.before);
        let axis = lift(link.axis);
        let length = dot(axis, axis).sqrt();
        // 1/x: one step of Newton's from the head's.
        let near = Double::from(1.0 / length.0);
        let inverse = near * (Double::from(2.0) - length * near);
        let axis = scaled(axis, inverse);
        let (along, origin) = (apply(&rotation, axis), place);
        if link.turns {
            rotation = product(&rotation, &turn(axis, q));
        } else {
            place = add(place, scaled(along, Double::from(q)));
        }
        walk(&mut rotation, &mut place, &link.after);
        let [xx, yy, zz, xy, xz, yz] = link.inertia;
        let own: Matrix = [lift([xx, xy, xz]), lift([xy, yy, yz]), lift([xz, yz, zz])];
        out.push(Pose {
            axis: along,
            origin,
            com: add(place, apply(&rotation, lift(link.com))),
            inertia: product(&product(&rotation, &own), &transposed(&rotation)),
        });
    }
    out
}

/// Inverse dynamics, gravity as an acceleration of the base against it.
fn torques(links: &[Link], poses: &[Pose], qd: &[Double], qdd: &[Double], gravity: [f64; 3]) -> Vec<Double> {
    let (mut w, mut dw) = (lift([0.0; 3]), lift([0.0; 3]));
    // Acceleration of the point of the link before that is at the joint.
    let (mut at, mut acceleration) = (lift([0.0; 3]), lift(gravity.map(|g| -g)));
    let moved = |w: Vector, dw: Vector, r: Vector| add(cross(dw, r), cross(w, cross(w, r)));
    let mut wrenches = Vec::new();
    for (((link, pose), &qd), &qdd) in links.iter().zip(poses).zip(qd).zip(qdd) {
        let lever = add(pose.origin, at.map(|x| -x));
        acceleration = add(acceleration, moved(w, dw, lever));
        at = pose.origin;
        let (rate, rise) = (scaled(pose.axis, qd), scaled(pose.axis, qdd));
        if link.turns {
            dw = add(add(dw, rise), cross(w, rate));
            w = add(w, rate);
        } else {
            acceleration = add(acceleration, add(rise, scaled(cross(w, rate), Double::from(2.0))));
        }
        let lever = add(pose.com, at.map(|x| -x));
        let force = scaled(add(acceleration, moved(w, dw, lever)), Double::from(link.mass));
        let moment = add(apply(&pose.inertia, dw), cross(w, apply(&pose.inertia, w)));
        wrenches.push((force, moment));
    }
    (0..poses.len())
        .map(|i| {
            let mut sum = Double::ZERO;
            for j in i..poses.len() {
                let (force, moment) = wrenches[j];
                let lever = add(poses[j].com, poses[i].origin.map(|x| -x));
                let whole = if links[i].turns { add(moment, cross(lever, force)) } else { force };
                sum = sum + dot(poses[i].axis, whole);
            }
            sum
        })
        .collect()
}

/// The passivity torque D a_r + C(q, q̇) v_r + G with the Christoffel C, and nothing else: C v_r is what the quadratic
/// torque of q̇ + v_r has beyond those of q̇ and of v_r, halved.
pub fn passivity_torque(
    links: &[Link],
    gravity: [f64; 3],
    q: &[f64],
    qd: &[f64],
    v_r: &[f64],
    a_r: &[f64],
) -> Vec<Double> {
    let poses = poses(links, q);
    let rest = vec![Double::ZERO; q.len()];
    let up = |x: &[f64]| -> Vec<Double> { x.iter().copied().map(Double::from).collect() };
    let (qd, v_r) = (up(qd), up(v_r));
    let both: Vec<Double> = qd.iter().zip(&v_r).map(|(&a, &b)| a + b).collect();
    let quadratic = |v: &[Double]| torques(links, &poses, v, &rest, [0.0; 3]);
    let (sum, own, other) = (quadratic(&both), quadratic(&qd), quadratic(&v_r));
    let linear = torques(links, &poses, &rest, &up(a_r), gravity);
    let half = Double::from(0.5);
    (0..q.len()).map(|i| linear[i] + half * (sum[i] - own[i] - other[i])).collect()
}
