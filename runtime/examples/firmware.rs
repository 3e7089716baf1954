//! A control loop as firmware has it: no allocation, one step a period, a safe command where a measurement fails.
//!
//! The model is written by hand here; a generated module gives one in the same way.

use gramforge_runtime::reference::{QuinticReference, Reference};
use gramforge_runtime::{Bounds, ConfigError, Controller, ExactLaw, Gains, Model, OnFault, Settings};

/// A pendulum: a point mass at the end of a massless rod.
struct Pendulum;

const MASS: f64 = 2.0;
const LENGTH: f64 = 0.5;
const PERIOD: f64 = 0.001;

impl Model<1> for Pendulum {
    type Scalar = f64;

    fn passivity_torque(&self, q: &[f64; 1], _: &[f64; 1], _: &[f64; 1], a_r: &[f64; 1]) -> [f64; 1] {
        [MASS * LENGTH * LENGTH * a_r[0] + MASS * 9.81 * LENGTH * libm::sin(q[0])]
    }

    fn viscous_friction(&self) -> [f64; 1] {
        [0.1]
    }

    fn bounds(&self) -> &Bounds<f64, 1> {
        &Bounds { d: [[0.0]], h: [[[0.0]]], b: [0.0], g: [0.0] }
    }
}

/// What stands for the drive: the pendulum itself, integrated.
struct Drive {
    q: f64,
    qd: f64,
}

impl Drive {
    fn apply(&mut self, torque: f64) {
        let gravity = MASS * 9.81 * LENGTH * libm::sin(self.q);
        let qdd = (torque - gravity - 0.1 * self.qd) / (MASS * LENGTH * LENGTH);
        self.qd += PERIOD * qdd;
        self.q += PERIOD * self.qd;
    }
}

fn main() -> Result<(), ConfigError> {
    let gains = Gains { p12: [[4.0]], damping: [[20.0]], pqq: [[5.0]] };
    let settings = Settings { period: PERIOD, torque_limit: [Some(40.0)], on_fault: OnFault::Gravity };
    let mut controller = Controller::new(Pendulum, ExactLaw { gains, coulomb: [[0.0, 0.0]] }, settings)?;
    let motion = QuinticReference { from: [0.0], to: [1.0], duration: 2.0 };
    let mut drive = Drive { q: 0.05, qd: 0.0 };
    for tick in 0_u32..3000 {
        let desired = motion.at(f64::from(tick) * PERIOD);
        // Once a second the sensor fails.
        let q = if tick % 1000 == 999 { f64::NAN } else { drive.q };
        let torque = match controller.step(&[q], &[drive.qd], &desired) {
            Ok(command) => command.torque,
            Err(fault) => fault.command,
        };
        drive.apply(torque[0]);
        if tick % 500 == 0 {
            println!("{:.1} s: q = {:.5}, wanted {:.5} rad", f64::from(tick) * PERIOD, drive.q, desired.q[0]);
        }
    }
    assert!((drive.q - 1.0).abs() < 1e-3, "{}", drive.q);
    Ok(())
}
