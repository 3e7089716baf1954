//! What the robust laws' tests share: gains, states, and the rate of V that a law leaves.

use super::{Gains, Law, Sample, Tracking, lyapunov};
use crate::Desired;
use crate::simulate::{Plant, RigidPlant};
use crate::test_arm::TwoLink;
use crate::vector::{along, dot, mat_vec};

pub(super) const GAINS: Gains<f64, 2> = Gains {
    p12: [[3.0, 1.0], [1.0, 3.0]],
    damping: [[5.0 + 5.5 / 8.0, -0.5 / 8.0], [-0.5 / 8.0, 5.0 + 5.5 / 8.0]],
    pqq: [[2.0, 0.5], [0.5, 2.0]],
};

/// Joint speeds up to 3 rad/s.
pub(super) fn states() -> impl Iterator<Item = Sample<f64, 2>> {
    (0..4000_u32).map(|k| {
        // An additive recurrence with irrational steps fills the box evenly.
        let at = |i: u32, half: f64| {
            let x = f64::from(k + 1) * f64::from(i).sqrt();
            half * (2.0 * (x - x.floor()) - 1.0)
        };
        Sample {
            q: [at(2, 3.0), at(3, 3.0)],
            qd: [at(5, 3.0), at(7, 3.0)],
            desired: Desired {
                q: [at(11, 3.0), at(13, 3.0)],
                qd: [at(17, 3.0), at(19, 3.0)],
                qdd: [at(23, 4.0), at(29, 4.0)],
            },
            period: 1e-3,
        }
    })
}

/// V̇ + zᵀ M z, (17), under a law that knows the perturbed arm and drives the true one.
pub(super) fn excess(law: &impl Law<TwoLink<f64>, 2, State = ()>, sample: &Sample<f64, 2>) -> f64 {
    let arm = TwoLink::<f64>::EXAMPLE;
    let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; 2] };
    let torque = law.torque(&TwoLink::perturbed(), &mut (), sample);
    let qdd = plant.acceleration(&sample.q, &sample.qd, &torque).unwrap();
    let h = 1e-5;
    let shifted = |h: f64| {
        let desired = &sample.desired;
        let moved = Sample {
            q: along(&sample.q, h, &sample.qd),
            qd: along(&sample.qd, h, &qdd),
            desired: Desired {
                q: along(&desired.q, h, &desired.qd),
                qd: along(&desired.qd, h, &desired.qdd),
                qdd: desired.qdd,
            },
            period: sample.period,
        };
        lyapunov(&arm, &GAINS, &moved)
    };
    let Tracking { s, q_e, .. } = Tracking::new(&GAINS.p12, sample);
    let omega_q_e = mat_vec(&GAINS.pqq, &mat_vec(&GAINS.p12, &q_e));
    let form = dot(&s, &mat_vec(&GAINS.damping, &s)) - 2.0 * dot(&s, &mat_vec(&GAINS.pqq, &q_e))
        + dot(&q_e, &omega_q_e);
    (shifted(h) - shifted(-h)) / (2.0 * h) + form
}
