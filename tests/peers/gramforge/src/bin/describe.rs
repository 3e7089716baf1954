//! Describes arms as the generator reads them, for compare.py:
//!
//! ```text
//! describe SPECIFICATION...      prints one JSON object a line
//! ```
//!
//! Joints stand as in the reference values of `tests/data/truth`; `inverse_dynamics` counts the operations of the exact torque
//! at v_r = q̇.

use std::path::Path;
use std::process::ExitCode;

use gramforge::internals::arm::{Arm, Joint, JointKind};
use gramforge::internals::check::prepare;
use gramforge::internals::error::Error;
use gramforge::internals::lagrangian::expand;
use gramforge::internals::torque::exact;
use serde_json::{Value, json};

fn described(path: &Path) -> Result<Value, Error> {
    let arm = prepare(path)?.built.arm;
    if arm.linkage.is_some() {
        return Err(Error::input(
            path,
            "arm",
            "has joints that follow others, which the peers' models cannot say",
            "remove <mimic> from the robot file",
        ));
    }
    let operations = exact(&arm, &expand(&arm)).1.inverse_dynamics().operations();
    let limits = arm.joint_box();
    let joints: Vec<Value> = arm.joints.iter().zip(limits).map(|(joint, limits)| joint_in(joint, limits)).collect();
    Ok(json!({
        "n": arm.dof(),
        "conventions": { "gravity_vector": arm.gravity },
        "joints": joints,
        "motor_inertia": { "G2Jm": armature(&arm) },
        "inverse_dynamics": operations,
    }))
}

fn joint_in(joint: &Joint, limits: [f64; 2]) -> Value {
    json!({
        "type": if joint.kind == JointKind::Revolute { "R" } else { "P" },
        "axis": [0.0, 0.0, 1.0],
        "R": joint.pose.rotation,
        "p": joint.pose.translation,
        "mass": joint.body.mass,
        "com": joint.body.com(),
        "I_com": joint.body.inertia_at_com(),
        "qlim": limits,
    })
}

fn armature(arm: &Arm) -> Vec<f64> {
    arm.joints.iter().map(|joint| joint.armature).collect()
}

fn main() -> ExitCode {
    for path in std::env::args().skip(1) {
        match described(Path::new(&path)) {
            Ok(arm) => println!("{arm}"),
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::from(error.exit_code());
            }
        }
    }
    ExitCode::SUCCESS
}
