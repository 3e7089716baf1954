//! The exact torque by the polarised Newton–Euler recursion, specialised to the arm's constants.

mod choice;
mod motion;
mod search;
mod vector;
mod wrench;

pub use search::recursive;
pub(crate) use search::{Plan, cost, planned};

use crate::arm::{Arm, Joint, JointKind, Transform};
use crate::graph::{Builder, Expr, Graph, Variable};
use choice::Choice;
use motion::{Frame, Motion, Products, Step, advance, to_parent};
use vector::{Turn, Vector, transposed};
use wrench::{Units, Wrench, own};

/// The recursion over a placed and regrouped arm, each link as `choices` says; in `units`, which must be
/// metres for an arm with a prismatic joint. With `names` for whom the graph is written out.
fn build(arm: &Arm, choices: &[Choice], units: &Units, names: bool) -> Graph {
    let builder = Builder::new();
    let steps: Vec<Step> =
        (0..arm.dof()).map(|j| step(&builder, &arm.joints[j], j, &choices[j], units)).collect();
    let mut motions = vec![base(&builder, arm, units)];
    for (j, step) in steps.iter().enumerate() {
        let before = j.checked_sub(1).map_or(Choice::default(), |i| choices[i]);
        let motion = advance(&motions[j], step, &before, &choices[j]);
        if names {
            name_motion(&motion, j + 1);
        }
        motions.push(motion);
    }
    let zero = builder.constant(0.0);
    let mut torques = Vec::new();
    // What the links after this one ask for, in its still and in its own frame.
    let (mut still, mut turned) = (Wrench::zero(zero), Wrench::zero(zero));
    for j in (0..arm.dof()).rev() {
        let (joint, step, choice) = (&arm.joints[j], &steps[j], &choices[j]);
        let motion = &motions[j + 1];
        let (own_still, own_turned) = own(&joint.body, motion, choice, units);
        let inner = turned.plus(&own_turned);
        let outer = still.plus(&own_still);
        let whole = match &motion.turn {
            Some(turn) => inner.outward(turn).plus(&outer),
            None => inner.plus(&outer),
        };
        if names {
            name_wrench(&inner, j + 1);
            name_wrench(&whole, j + 1);
        }
        let along = match joint.kind {
            JointKind::Revolute => whole.moment[2],
            JointKind::Prismatic => whole.force[2],
        };
        torques.push(along + builder.constant(joint.armature) * builder.input(Variable::Ar(j)));
        let whole = match (joint.kind, step.q) {
            (JointKind::Prismatic, Some(q)) => whole.about([zero, zero, q]),
            _ => whole,
        };
        let seen = Wrench { force: to_parent(step, whole.force), moment: to_parent(step, whole.moment) };
        (still, turned) = (Wrench::zero(zero), Wrench::zero(zero));
        match (choice.sum, motions[j].turn) {
            (true, Some(turn)) => still = seen.about(turn.outward(step.lever)),
            _ => turned = seen.about(step.lever),
        }
    }
    torques.reverse();
    let outputs: Vec<_> =
        (1..).zip(torques).map(|(i, tau)| tau.named(&format!("tau{i}"), true).id()).collect();
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
