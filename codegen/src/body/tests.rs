//! Both bodies against the oracle, on arms that use everything.

use std::path::Path;

use super::{expanded, recursive};
use crate::arm::Arm;
use crate::check::prepare;
use crate::dynamics::{coriolis, gravity, mass_matrix};
use crate::lagrangian::expand;
use crate::reduction;
use crate::spread::Spread;

fn arm(file: &str) -> Arm {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(file);
    prepare(&path).expect("a sound specification").built.arm
}

/// D a_r + C v_r + G from the matrices.
fn oracle(arm: &Arm, q: &[f64], qd: &[f64], v_r: &[f64], a_r: &[f64]) -> Vec<f64> {
    let (d, c, g) = (mass_matrix(arm, q), coriolis(arm, q, qd), gravity(arm, q));
    let row = |i: usize| (0..arm.dof()).map(|j| d[i][j] * a_r[j] + c[i][j] * v_r[j]).sum::<f64>() + g[i];
    (0..arm.dof()).map(row).collect()
}

#[test]
fn expanded_and_recursive_bodies_give_the_passivity_torque() {
    for file in ["puma3.json", "stanford.json", "ur5.json"] {
        let arm = arm(file);
        let n = arm.dof();
        let lagrangian = expand(&arm);
        let bodies = [recursive(&arm), expanded(&arm, &lagrangian, &reduction::exact(&lagrangian))];
        let spread = Spread::new(4 * n);
        for index in 0..200 {
            let x: Vec<f64> = spread.point(index).iter().map(|u| 6.0 * u - 3.0).collect();
            let (q, qd, v_r, a_r) = (&x[..n], &x[n..2 * n], &x[2 * n..3 * n], &x[3 * n..]);
            let wanted = oracle(&arm, q, qd, v_r, a_r);
            let scale = wanted.iter().fold(1.0, |m: f64, t| m.max(t.abs()));
            for body in &bodies {
                for (tau, wanted) in body.interpret(q, qd, v_r, a_r).iter().zip(&wanted) {
                    assert!((tau - wanted).abs() < 1e-10 * scale, "{file}: {tau} {wanted}");
                }
            }
        }
    }
}

#[test]
fn the_recursion_does_not_take_the_first_joint_s_angle_where_gravity_is_along_its_axis() {
    let graph = recursive(&arm("ur5.json"));
    assert_eq!(graph.operations().trig_pairs, 5);
}

#[test]
#[ignore]
fn show() {
    for file in [
        "../../generated/specs/arm3_exact.json",
        "puma3.json",
        "../../generated/specs/puma560_exact.json",
        "ur5.json",
        "panda.json",
        "stanford.json",
    ] {
        let arm = arm(file);
        let t = std::time::Instant::now();
        let g = recursive(&arm);
        println!("{file}: {:?} = {} in {:?}", g.operations(), g.operations().arithmetic(), t.elapsed());
    }
}
