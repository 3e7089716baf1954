//! The exact torque by the polarised Newton–Euler recursion, specialised to the arm's constants.

mod choice;
mod motion;
mod pass;
mod search;
mod vector;
mod wrench;

pub use search::recursive;
pub(crate) use search::{Plan, costs, planned};

use crate::arm::{Arm, Joint, JointKind, Transform};
use crate::graph::{Builder, Expr, Graph, Variable};
use choice::Choice;
use motion::{Frame, Motion, Products, Step};
use pass::Pass;
use vector::{Turn, Vector, transposed};
use wrench::{Units, Wrench};

/// The recursion over a placed and regrouped arm, each link as `choices` says; in `units`, which must be
/// metres for an arm with a prismatic joint. Written out for a person, with names.
fn build(arm: &Arm, choices: &[Choice], units: &Units) -> Graph {
    let builder = Builder::new();
    let pass = Pass::new(&builder, arm.clone(), choices, units, None);
    for (j, motion) in pass.motions.iter().enumerate().skip(1) {
        name_motion(motion, j);
    }
    for (j, link) in pass.links.iter().enumerate().rev() {
        name_wrench(&link.inner, j + 1);
        name_wrench(&link.whole, j + 1);
    }
    let outputs: Vec<_> =
        (1..).zip(&pass.links).map(|(i, link)| link.torque.named(&format!("tau{i}"), true).id()).collect();
    builder.finish(&outputs)
}

/// The base at rest: it is accelerated against gravity.
fn base<'g>(builder: &'g Builder, arm: &Arm, units: &Units) -> Motion<'g> {
    let zero = builder.constant(0.0);
    let frame = Frame {
        w: [zero; 3],
        r: [zero; 3],
        h: [[zero; 3]; 3],
        a: arm.gravity.map(|g| builder.constant((0.0 - g) / units.acceleration)),
    };
    let products = Products { xy: zero, xz: zero, yz: zero, spin: zero };
    Motion { still: frame, still_products: products, turned: frame, turned_products: products, turn: None }
}

fn step<'g>(builder: &'g Builder, joint: &Joint, j: usize, choice: &Choice, units: &Units) -> Step<'g> {
    let (mut axes, offset) = split(&joint.pose.rotation);
    let mut own = match joint.kind {
        JointKind::Revolute => {
            let (sin, cos) = builder.sin_cos(j);
            Some(Turn { sin, cos })
        }
        JointKind::Prismatic => None,
    };
    // A sum of angles needs the constant one between them to stand with the joint's own, and so does a skew offset.
    let summed = choice.sum;
    let skew = joint.pose.rotation.iter().flatten().any(|entry| entry.fract() != 0.0);
    match own {
        Some(turn) if summed || skew => own = Some(offset_turn(builder, offset).then(&turn)),
        None if summed && offset != [0.0, 1.0] => own = Some(offset_turn(builder, offset)),
        _ => axes = joint.pose.rotation,
    }
    Step {
        kind: joint.kind,
        axes,
        own,
        origin: joint.pose.translation.map(|p| builder.constant(p / units.acceleration)),
        lever: joint.pose.translation.map(|p| builder.constant(p / units.force)),
        q: (joint.kind == JointKind::Prismatic).then(|| builder.input(Variable::Q(j))),
        qd: builder.input(Variable::Qd(j)),
        vr: builder.input(Variable::Vr(j)),
        ar: builder.input(Variable::Ar(j)),
    }
}

fn offset_turn(builder: &Builder, [sin, cos]: [f64; 2]) -> Turn<'_> {
    Turn { sin: builder.constant(sin), cos: builder.constant(cos) }
}

/// R as a rotation that brings z into place by the shortest way and a turn about it: (the former, sine and cosine of
/// the latter).
fn split(r: &[[f64; 3]; 3]) -> ([[f64; 3]; 3], [f64; 2]) {
    let z = r.map(|row| row[2]);
    let axes = if z[0] == 0.0 && z[1] == 0.0 {
        let way = 1.0_f64.copysign(z[2]);
        [[1.0, 0.0, 0.0], [0.0, way, 0.0], [0.0, 0.0, way]]
    } else if z[0] == 0.0 {
        [[1.0, 0.0, 0.0], [0.0, z[2], z[1]], [0.0, 0.0 - z[1], z[2]]]
    } else if z[1] == 0.0 {
        [[z[2], 0.0, z[0]], [0.0, 1.0, 0.0], [0.0 - z[0], 0.0, z[2]]]
    } else {
        *r
    };
    let back = transposed(&axes);
    let entry = |i: usize, j: usize| (0..3).map(|k| back[i][k] * r[k][j]).sum::<f64>();
    let turn = Transform {
        rotation: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
        ..Transform::IDENTITY
    };
    let turn = turn.rounded(crate::arm::NOISE).rotation;
    (axes, [turn[1][0], turn[0][0]])
}

fn name_motion(motion: &Motion<'_>, number: usize) {
    let put = |x: Vector<'_>, prefix: &str| {
        for (component, axis) in x.into_iter().zip(["x", "y", "z"]) {
            component.hint(|| format!("{prefix}{number}_{axis}"));
        }
    };
    for frame in [&motion.turned, &motion.still] {
        put(frame.w, "w");
        put(frame.r, "wr");
        put(frame.a, "a");
        for (row, axis) in frame.h.into_iter().zip(["x", "y", "z"]) {
            for (entry, column) in row.into_iter().zip(["x", "y", "z"]) {
                entry.hint(|| format!("h{number}_{axis}{column}"));
            }
        }
    }
    if let Some(turn) = motion.turn {
        turn.sin.hint(|| format!("sin{number}"));
        turn.cos.hint(|| format!("cos{number}"));
    }
}

fn name_wrench(wrench: &Wrench<'_>, number: usize) {
    for (x, prefix) in [(wrench.force, "f"), (wrench.moment, "n")] {
        for (component, axis) in x.into_iter().zip(["x", "y", "z"]) {
            component.hint(|| format!("{prefix}{number}_{axis}"));
        }
    }
}

impl<'g> Expr<'g> {
    /// Names a node that is no constant.
    fn hint(self, name: impl FnOnce() -> String) {
        if !self.is_constant() {
            self.named(&name(), false);
        }
    }

    /// The constant `x` in the same graph.
    fn constant_like(self, x: f64) -> Self {
        crate::dynamics::Scalar::constant(self, x)
    }
}
