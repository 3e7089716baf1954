//! Both bodies against the oracle, on arms that use everything.

mod absolute;

use std::path::Path;

use super::{expanded, recursive};
use crate::arm::{Arm, Body, Joint, JointKind, Limits, Transform};
use crate::check::prepare;
use crate::dynamics::{coriolis, gravity, mass_matrix, passivity_torque, positions};
use crate::graph::Graph;
use crate::lagrangian::expand;
use crate::numerics::low_discrepancy::LowDiscrepancy;
use crate::reduction;

pub(super) fn arm(file: &str) -> Arm {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(file);
    prepare(&path).expect("a sound specification").built.arm
}

/// D a_r + C v_r + G from the matrices.
fn oracle(arm: &Arm, q: &[f64], qd: &[f64], v_r: &[f64], a_r: &[f64]) -> Vec<f64> {
    let (d, c, g) = (mass_matrix(arm, q), coriolis(arm, q, qd), gravity(arm, q));
    let row = |i: usize| (0..arm.dof()).map(|j| d[i][j] * a_r[j] + c[i][j] * v_r[j]).sum::<f64>() + g[i];
    (0..arm.dof()).map(row).collect()
}

/// Largest |τ − oracle| of a body over random states, as a fraction of the largest torque of its state.
fn error(arm: &Arm, body: &Graph, states: usize) -> f64 {
    let n = arm.dof();
    let spread = LowDiscrepancy::new(4 * n);
    let mut worst = 0.0_f64;
    for index in 0..states {
        let x: Vec<f64> = spread.point(index).iter().map(|u| 6.0 * u - 3.0).collect();
        let (q, qd, v_r, a_r) = (&x[..n], &x[n..2 * n], &x[2 * n..3 * n], &x[3 * n..]);
        let wanted = oracle(arm, q, qd, v_r, a_r);
        let scale = wanted.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        for (tau, wanted) in body.interpret(q, qd, v_r, a_r).iter().zip(&wanted) {
            let apart = (tau - wanted).abs() / scale;
            worst = if apart.is_nan() { f64::INFINITY } else { worst.max(apart) };
        }
    }
    worst
}

#[test]
fn expanded_and_recursive_bodies_give_the_passivity_torque() {
    for file in ["puma3.json", "stanford.json", "ur5.json"] {
        let arm = arm(file);
        let lagrangian = expand(&arm);
        let bodies = [recursive(&arm), expanded(&arm, &lagrangian, &reduction::exact(&lagrangian))];
        for body in bodies {
            let error = error(&arm, &body, 200);
            assert!(error < 1e-11, "{file}: {error:e}");
        }
    }
    let panda = arm("panda.json");
    let error = error(&panda, &recursive(&panda), 200);
    assert!(error < 1e-11, "{error:e}");
}

/// Numbers from −1 to 1 by a linear congruence, the same everywhere.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    }

    fn one_in(&mut self, times: u32) -> bool {
        self.next() + 1.0 < 2.0 / f64::from(times)
    }

    fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.next())
    }
}

/// An arm with joints of both kinds, skew, square, parallel and opposed axes, and bodies without any symmetry.
pub(super) fn random_arm(seed: u64) -> Arm {
    let mut numbers = Numbers(seed);
    let n = 2 + (seed % 4) as usize;
    let joints = (0..n).map(|j| {
        let prismatic = numbers.one_in(4);
        let quarter = std::f64::consts::FRAC_PI_2;
        let turn = if numbers.one_in(3) {
            Transform::roll_pitch_yaw(numbers.vector().map(|x| 3.0 * x))
        } else {
            let quarters = (numbers.next() * 2.0).round();
            let about = if numbers.one_in(2) { numbers.next() } else { 0.0 };
            Transform::rotation(0, quarters * quarter).then(&Transform::rotation(2, about))
        };
        let inertia = numbers.vector();
        let body = Body::from_com(
            2.0 + numbers.next(),
            numbers.vector(),
            [
                [1.0, 0.2 * inertia[0], 0.2 * inertia[1]],
                [0.2 * inertia[0], 1.2, 0.2 * inertia[2]],
                [0.2 * inertia[1], 0.2 * inertia[2], 0.9],
            ],
        );
        Joint {
            name: format!("joint{}", j + 1),
            kind: if prismatic { JointKind::Prismatic } else { JointKind::Revolute },
            pose: Transform::translation(numbers.vector()).then(&turn),
            body,
            link: Transform::IDENTITY,
            armature: 0.5 + 0.5 * numbers.next(),
            viscous_friction: 0.0,
            coulomb_friction: [0.0; 2],
            limits: Limits::default(),
        }
    });
    let joints = joints.collect();
    let gravity = if numbers.one_in(2) { [0.0, 0.0, -9.81] } else { numbers.vector().map(|g| 9.0 * g) };
    Arm { gravity, joints, tip: Transform::IDENTITY, linkage: None }
}

/// The torque of another description of the same arm, as [`error`] measures a body.
fn difference(arm: &Arm, other: &Arm) -> f64 {
    let n = arm.dof();
    let spread = LowDiscrepancy::new(4 * n);
    let mut worst = 0.0_f64;
    for index in 0..20 {
        let x: Vec<f64> = spread.point(index).iter().map(|u| 6.0 * u - 3.0).collect();
        let torque = |arm: &Arm| {
            let q = positions(arm, &x[..n]);
            passivity_torque(arm, arm.gravity, &q, &x[n..2 * n], &x[2 * n..3 * n], &x[3 * n..])
        };
        let (wanted, got) = (torque(arm), torque(other));
        let scale = wanted.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        for (a, b) in wanted.iter().zip(&got) {
            worst = worst.max((a - b).abs() / scale);
        }
    }
    worst
}

#[test]
fn regrouping_and_placing_change_no_torque() {
    use crate::arm::{Along, Kept, Mass, Offset, Origin};
    for seed in 0..300 {
        let arm = random_arm(seed);
        let n = arm.dof();
        let regrouped = arm.regrouped();
        let apart = difference(&arm, &regrouped);
        assert!(apart < 1e-12, "seed {seed}: {apart:e}");
        for joint in &regrouped.joints[1..] {
            let body = &joint.body;
            let gone = match joint.kind {
                JointKind::Revolute => [body.mass, body.first_moment[2], body.pseudo_inertia[2][2]],
                JointKind::Prismatic => std::array::from_fn(|i| body.pseudo_inertia[i][i]),
            };
            assert_eq!(gone, [0.0; 3], "seed {seed}");
        }
        for origin in [Origin::Next, Origin::Before] {
            let kept = Kept { mass: Mass::ForX, offset: Offset::ForY, along: Along::LikeX };
            let other = arm.placed(&vec![origin; n]).regrouped_keeping(&vec![kept; n]);
            let apart = difference(&arm, &other);
            assert!(apart < 1e-11, "seed {seed}, {origin:?}: {apart:e}");
        }
    }
}

#[test]
fn the_recursion_holds_for_any_arm() {
    for seed in 0..24 {
        let arm = random_arm(seed);
        let error = error(&arm, &recursive(&arm), 20);
        assert!(error < 1e-11, "seed {seed}: {error:e}");
    }
}

#[test]
fn the_recursion_does_not_take_the_first_joint_s_angle_where_gravity_is_along_its_axis() {
    let graph = recursive(&arm("ur5.json"));
    assert_eq!(graph.operations().trig_pairs, 5);
}
