//! Faults of values, on the sample arm; the samples themselves have none.

use std::path::Path;

use serde_json::{Value, json};

use super::{Extent, checked, prepare};
use crate::load::parse;
use crate::spec::{MatrixSpec, VectorSpec};

/// The faults of arm3.json after `edit` are as many as `lines`, each by its beginning.
fn expect(edit: impl Fn(&mut Value), lines: &[&str]) {
    let mut value: Value =
        serde_json::from_str(include_str!("../../../generated/specs/arm3_xi2.json")).expect("JSON");
    edit(&mut value);
    let loaded = parse(&value.to_string(), Path::new("a.json")).unwrap_or_else(|e| panic!("{e}"));
    let message = match checked(loaded, Extent::Whole) {
        Ok(_) => String::new(),
        Err(error) => {
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        }
    };
    let found: Vec<&str> = message.lines().map(crate::error::unplaced).collect();
    assert_eq!(found.len(), lines.len(), "{message}");
    for line in lines {
        assert!(found.iter().any(|f| f.starts_with(line)), "no {line:?} in\n{message}");
    }
}

#[test]
fn the_samples_are_sound() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for file in [
        "generated/specs/arm3_xi2",
        "generated/specs/puma560_xi12",
        "tests/data/puma3",
        "tests/data/stanford",
        "tests/data/ur5",
        "tests/data/panda",
    ] {
        prepare(&root.join(format!("{file}.json"))).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn names_name_modules() {
    expect(|v| v["name"] = json!("Arm"), &["name: is \"Arm\"; write a lower-case letter"]);
    expect(|v| v["name"] = json!(""), &["name: is \"\"; write"]);
    expect(|v| v["name"] = json!("3arm"), &["name: is \"3arm\"; write"]);
    expect(|v| v["name"] = json!("my-arm"), &["name: is \"my-arm\"; write"]);
    expect(|v| v["name"] = json!("gen"), &["name: is \"gen\", a word of the Rust language; choose"]);
    expect(|v| v["name"] = json!("arm_3"), &[]);
}

#[test]
fn a_check_of_the_desired_motion_needs_limits_and_no_motion() {
    let limited = |v: &mut Value| {
        v["emit"] = json!({ "check_reference": true });
        v["measure"] = json!("workspace");
        v.as_object_mut().expect("an object").remove("motion");
        for link in v["arm"]["dh"]["links"].as_array_mut().expect("links") {
            link["limits"] = json!({ "position": [-1.0, 1.0], "velocity": 1.0, "acceleration": 3.0 });
        }
    };
    expect(limited, &[]);
    expect(
        |v| v["emit"] = json!({ "check_reference": true }),
        &[
            "emit.check_reference: asks for a check of the program's own motions, but what is promised is about `motion`; remove",
            "emit.check_reference: needs the limits of velocity and acceleration of every joint, which are missing for joint1, joint2, joint3; add",
        ],
    );
    let more = |v: &mut Value| {
        limited(v);
        v["emit"]["law"] = json!("runtime");
        v["arm"]["dh"]["links"][1]["limits"] = json!({ "position": [-1.0, 1.0], "velocity": 1.0 });
    };
    expect(
        more,
        &[
            "emit.check_reference: asks for a check that is part of a step that is written out, but `emit.law` is `runtime`; remove",
            "emit.check_reference: needs the limits of velocity and acceleration of every joint, which are missing for joint2; add",
            "measure: is \"workspace\", but of the joint limits joint2 lacks acceleration; add",
        ],
    );
    let none = |v: &mut Value| {
        limited(v);
        v.as_object_mut().expect("an object").remove("control");
    };
    expect(
        none,
        &[
            "emit.check_reference: asks the controller to check the desired motion, but there is no `control`; add",
        ],
    );
}

#[test]
fn motions_fit_the_arm() {
    expect(
        |v| v["motion"]["quintic"] = json!({ "from": [0.0], "to": [0.0, 1.0, 1.0, 1.0], "duration": 0.0 }),
        &[
            "motion.quintic.from: has 1 entry; write 3, one for each joint",
            "motion.quintic.to: has 4 entries; write 3, one for each joint",
            "motion.quintic.duration: is 0; write a number above 0, in s",
        ],
    );
    let home = json!([0.0, 0.0, 0.0]);
    expect(
        |v| {
            v["motion"] = json!({ "waypoints": { "times": [0.5, 1.0, 1.0], "positions": [home, [1.0]] } });
        },
        &[
            "motion.waypoints.times[0]: is 0.5; start at 0",
            "motion.waypoints.times[2]: is 1, after 1; write the times in increasing order",
            "motion.waypoints.positions: has 2 entries; write 3, one for each time",
            "motion.waypoints.positions[1]: has 1 entry; write 3",
        ],
    );
    expect(
        |v| v["motion"] = json!({ "waypoints": { "times": [0.0], "positions": [home] } }),
        &["motion.waypoints.times: has 1 entry; write at least 2 times"],
    );
    expect(
        |v| v["motion"] = json!({ "sinusoids": { "offset": [], "terms": [[]], "duration": -1.0 } }),
        &[
            "motion.sinusoids.offset: has 0",
            "motion.sinusoids.terms: has 1",
            "motion.sinusoids.duration: is -1",
        ],
    );
    expect(|v| v["motion"] = json!({ "csv": { "file": "" } }), &["motion.csv.file: is empty"]);
}

#[test]
fn measures_have_what_they_need() {
    let without = |v: &mut Value| {
        v.as_object_mut().expect("an object").remove("motion");
    };
    expect(without, &["motion: is missing, but the measure `tube` needs it; add a motion"]);
    expect(
        |v| {
            without(v);
            v["measure"] = json!("trajectory");
        },
        &["motion: is missing, but the measure `trajectory`"],
    );
    expect(
        |v| {
            without(v);
            v.as_object_mut().expect("an object").remove("measure");
        },
        &["motion: is missing, but the measure `tube`, the default,"],
    );
    expect(
        |v| v["measure"]["tube"]["position_error"] = json!([0.1, -0.1]),
        &[
            "measure.tube.position_error: has 2 entries; write 3",
            "measure.tube.position_error[1]: is -0.1; write a number of at least 0",
        ],
    );
    expect(
        |v| {
            v["measure"] = json!("workspace");
            v["arm"]["dh"]["links"][0]["limits"] = json!({ "position": [-1.0, 2.0], "velocity": 1.0 });
        },
        &[
            "measure: is \"workspace\", but of the joint limits joint1 lacks acceleration, joint2 lacks position \
           and velocity and acceleration, joint3 lacks",
        ],
    );
    expect(
        |v| {
            without(v);
            v["measure"] = json!("workspace");
            for link in v["arm"]["dh"]["links"].as_array_mut().expect("links") {
                link["limits"] = json!({ "position": [-1.0, 1.0], "velocity": 1.0, "acceleration": 1.0 });
            }
        },
        &[],
    );
    expect(|v| v["model"]["shared"]["functions"] = json!(0), &["model.shared.functions: is 0; write"]);
}

#[test]
fn gains_make_a_law() {
    expect(|v| v["control"]["W"] = json!(0.0), &["control.W: is 0; write a positive number"]);
    expect(
        |v| v["control"]["W"] = json!([1.0, -2.0, 0.0]),
        &["control.W[1]: is -2; write a positive", "control.W[2]: is 0; write a positive"],
    );
    expect(
        |v| v["control"]["W"] = json!([1.0, 2.0]),
        &["control.W: has 2 entries; write one number, 3 numbers"],
    );
    expect(
        |v| v["control"]["W"] = json!([[1.0, 0.0], [0.0]]),
        &["control.W: has 2 rows of [2, 1] entries; write one number, 3 numbers or 3 rows of 3 numbers"],
    );
    let full = |a: f64, b: f64| json!([[2.0, a, 0.0], [b, 2.0, 0.0], [0.0, 0.0, 2.0]]);
    expect(
        |v| v["control"]["Pqq"] = full(1.0, 0.5),
        &["control.Pqq[0][1]: is not symmetric: 1 and 0.5; write"],
    );
    expect(|v| v["control"]["Omega"] = full(3.0, 3.0), &["control.Omega: is [[2.0, 3.0, 0.0], [3.0"]);
    expect(
        |v| {
            v["control"]["Pqq"] = json!([1.0, 2.0, 3.0]);
            v["control"]["Omega"] = full(1.0, 1.0);
        },
        &["control.Omega: gives a P12 = Pqq⁻¹Ω that is not symmetric: 1 and 0."],
    );
    expect(
        |v| v["control"]["Omega"] = full(-1.0, -1.0),
        &["control.Omega: gives P12 = Pqq⁻¹Ω the negative entry -4 at row 0, column 1; choose"],
    );
    expect(|v| v["control"]["Omega"] = full(1.0, 1.0), &[]);
}

#[test]
fn the_other_numbers_of_control_and_simulation() {
    expect(|v| v["control"]["period"] = json!(0.0), &["control.period: is 0; write a number above 0, in s"]);
    expect(|v| v["control"]["boundary_layer"] = json!(0.0), &["control.boundary_layer: is 0; write"]);
    expect(
        |v| v["control"]["initial_error"] = json!({ "position": [0.1, 0.1, -0.1], "velocity": -1.0 }),
        &[
            "control.initial_error.position[2]: is -0.1; write",
            "control.initial_error.velocity: is -1; write",
        ],
    );
    expect(
        |v| v["simulation"] = json!({ "duration": -1.0, "substeps": 0 }),
        &["simulation.duration: is -1; write", "simulation.substeps: is 0; write"],
    );
}

#[test]
fn faults_of_arm_and_values_come_together() {
    expect(
        |v| {
            v["arm"]["dh"]["links"][1]["mass"] = json!(-1.0);
            v["control"]["W"] = json!([1.0]);
            v["name"] = json!("fn");
        },
        &["arm.dh.links[1].mass: is -1", "control.W: has 1 entry", "name: is \"fn\""],
    );
}

#[test]
fn scalars_lists_and_tables_take_their_shape() {
    assert_eq!(VectorSpec::Scalar(2.0).by_joint(2), Some(vec![2.0, 2.0]));
    assert_eq!(VectorSpec::List(vec![1.0]).by_joint(2), None);
    let diagonal = Some(vec![vec![1.0, 0.0], vec![0.0, 2.0]]);
    assert_eq!(MatrixSpec::Diagonal(vec![1.0, 2.0]).by_rows(2), diagonal);
    assert_eq!(MatrixSpec::Scalar(3.0).by_rows(1), Some(vec![vec![3.0]]));
    assert_eq!(MatrixSpec::Full(vec![vec![1.0, 2.0]]).by_rows(2), None);
}
