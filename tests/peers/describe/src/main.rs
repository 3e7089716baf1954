//! Describes arms as the generator reads them, for compare.py:
//!
//! ```text
//! describe SPECIFICATION...      prints one JSON object a line
//! ```
//!
//! Joints stand as in the reference values of `tests/data/truth`. `inverse_dynamics` counts the operations of the exact
//! torque at v_r = q̇.

use std::path::Path;
use std::process::ExitCode;

use gramforge::internals::arm::{Joint, JointKind};
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
            "has joints that follow other joints; the peers' models have no such joints",
            "remove <mimic> from the robot file",
        ));
    }
    let operations = exact(&arm, &expand(&arm)).1.inverse_dynamics().operations();
    let joints: Vec<Value> = arm
        .joints
        .iter()
        .zip(arm.joint_box())
        .map(|(joint, limits)| described_joint(joint, limits))
        .collect();
    let armature: Vec<f64> = arm.joints.iter().map(|joint| joint.armature).collect();
    Ok(json!({
        "n": arm.dof(),
        "conventions": { "gravity_vector": arm.gravity },
        "joints": joints,
        "motor_inertia": { "G2Jm": armature },
        "inverse_dynamics": operations,
    }))
}

fn described_joint(joint: &Joint, limits: [f64; 2]) -> Value {
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

fn main() -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for path in std::env::args().skip(1) {
        match described(Path::new(&path)) {
            Ok(arm) => println!("{arm}"),
            Err(error) => {
                eprintln!("{error}");
                code = ExitCode::from(error.exit_code());
            }
        }
    }
    code
}
