//! Several mistakes at once: all are told, each once, and nothing follows from another.

use serde_json::json;

use super::input::{Input, faults, urdf_joint, urdf_link};
use crate::common::unplaced;

/// The inputs, as `spec0.json`, `spec1.json` …, have exactly these faults.
fn expect(inputs: &[Input], wanted: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |(index, input): (usize, &Input)| input.write(folder.path(), &format!("spec{index}.json"));
    let specs: Vec<_> = inputs.iter().enumerate().map(write).collect();
    let lines: Vec<String> = faults(folder.path(), &specs).iter().map(|line| unplaced(line)).collect();
    let shown = lines.join("\n");
    assert_eq!(lines.len(), wanted.len(), "{shown}");
    for fault in wanted {
        let fault = format!("{}/{fault}", folder.path().display());
        assert_eq!(lines.iter().filter(|line| line.starts_with(&fault)).count(), 1, "{fault} in\n{shown}");
    }
}

#[test]
fn structure() {
    let mut input = Input::good();
    input.remove("/arm/dh/links/0/mass").link(1, "joint", json!("helical")).set("/colour", json!(1));
    input.control("W", json!("stiff"));
    expect(
        &[input],
        &[
            "spec0.json: arm.dh.links[0].mass: is missing",
            "spec0.json: arm.dh.links[1].joint: is \"helical\"",
            "spec0.json: colour: is not a field",
            "spec0.json: control.W: is \"stiff\"",
        ],
    );
}

#[test]
fn values_all_over_the_file() {
    let mut input = Input::good();
    input.set("/name", json!("Arm")).link(0, "mass", json!(-1.0)).control("period", json!(-1));
    input.set("/motion/quintic/to", json!([1.0])).set("/model/shared/functions", json!(0));
    input.set("/measure/tube/position_error", json!([0.1, 0.1])).set("/simulation", json!({ "substeps": 0 }));
    expect(
        &[input],
        &[
            "spec0.json: name: is \"Arm\"",
            "spec0.json: arm.dh.links[0].mass: is -1",
            "spec0.json: control.period: is -1",
            "spec0.json: motion.quintic.to: has 1 entry",
            "spec0.json: model.shared.functions: is 0",
            "spec0.json: measure.tube.position_error: has 2 entries",
            "spec0.json: simulation.substeps: is 0",
        ],
    );
}

#[test]
fn one_wrong_length_after_another() {
    let mut input = Input::good();
    input.set("/motion/quintic/from", json!([])).set("/motion/quintic/to", json!([1, 2, 3, 4]));
    input.control("W", json!([1.0])).control("Pqq", json!([[1.0]])).control("Omega", json!([1, 2, 3, 4]));
    expect(
        &[input],
        &[
            "spec0.json: motion.quintic.from: has 0 entries",
            "spec0.json: motion.quintic.to: has 4 entries",
            "spec0.json: control.W: has 1 entry",
            "spec0.json: control.Pqq: has 1 row",
            "spec0.json: control.Omega: has 4 entries",
        ],
    );
}

#[test]
fn in_what_is_asked_of_the_gains() {
    let mut input = Input::good();
    input.control("design", json!({ "convergence_time": -1.0, "tube": 0.3, "period": 0.0 }));
    input.control("boundary_layer", json!(0.1));
    expect(
        &[input],
        &[
            "spec0.json: control.period: is given while",
            "spec0.json: control.W: is given while",
            "spec0.json: control.Pqq: is given while",
            "spec0.json: control.Omega: is given while",
            "spec0.json: control.boundary_layer: is given while",
            "spec0.json: control.design.convergence_time: is -1",
            "spec0.json: control.design.period: is 0",
            "spec0.json: control.design.tube: is 0.3",
        ],
    );
}

#[test]
fn beyond_limits_in_several_joints_and_more() {
    let mut input = Input::good();
    input.link(0, "limits", json!({ "velocity": 0.1 })).link(2, "limits", json!({ "position": [-1.5, 1.5] }));
    input.control("boundary_layer", json!(0.0)).set("/model/shared/functions", json!(12));
    expect(
        &[input],
        &[
            "spec0.json: motion: velocity of joint 1",
            "spec0.json: motion: position of joint 3",
            "spec0.json: control.boundary_layer: is 0",
            "spec0.json: model.shared.functions: is 12",
        ],
    );
}

#[test]
fn in_the_table_and_in_the_specification() {
    let mut input = Input::good();
    input.csv("0,0,0,0\n1,0,x,0\n2,0,0\n1,0,0,0\n3,0,0,0\n").control("period", json!(0));
    expect(
        &[input],
        &["motion.csv: column 3 is `x`", "motion.csv: has 3 columns", "spec0.json: control.period: is 0"],
    );
}

#[test]
fn in_the_urdf_and_in_the_specification() {
    let mut input = Input::good();
    let light = urdf_link("arm").replace("mass value=\"1\"", "mass value=\"-1\"");
    let joint = urdf_joint("turn", "revolute", "base", "arm", "<dynamics damping=\"-1\"/>");
    input.urdf(&[urdf_link("base"), light, joint].concat()).control("period", json!(0));
    expect(
        &[input],
        &[
            "arm.urdf: link[arm].inertial.mass: is -1",
            "arm.urdf: joint[turn].dynamics.damping: is -1",
            "spec0.json: control.period: is 0",
        ],
    );
}

#[test]
fn in_two_specifications() {
    let (mut first, mut second) = (Input::good(), Input::good());
    first.link(1, "mass", json!(-1.0)).control("period", json!(0));
    second.set("/name", json!("other")).replace("\"law\":\"report\"", "\"law\":\"report\",,");
    expect(
        &[first, second, Input::good()],
        &[
            "spec0.json: arm.dh.links[1].mass: is -1",
            "spec0.json: control.period: is 0",
            "spec1.json: is not JSON that can be read (key must be a string)",
        ],
    );
}

#[test]
fn the_same_name_twice() {
    expect(&[Input::good(), Input::good()], &["spec1.json: name: is \"arm3_xi2\", which "]);
}

#[test]
fn a_wrong_number_of_links_is_one_mistake() {
    let mut input = Input::good();
    let link = input.spec["arm"]["dh"]["links"][0].clone();
    input.set("/arm/dh/links", json!(vec![link; 9])).control("W", json!([1.0, 2.0, 3.0]));
    expect(&[input], &["spec0.json: arm.dh.links: has 9 links"]);
    let mut input = Input::good();
    input.set("/arm/dh/links", json!([])).control("W", json!([1.0, 2.0, 3.0]));
    expect(&[input], &["spec0.json: arm.dh.links: has 0 links"]);
}

#[test]
fn a_misspelt_field_hides_no_other_fault() {
    let mut input = Input::good();
    input.remove("/control/period").control("peroid", json!(-1.0)).set("/colour", json!(1));
    input.set("/model/shared/functions", json!(0)).link(0, "mass", json!(-1.0));
    expect(
        &[input],
        &[
            "spec0.json: control.peroid: is not a field; did you mean `period`?",
            "spec0.json: colour: is not a field",
            "spec0.json: control.period: is -1",
            "spec0.json: model.shared.functions: is 0",
            "spec0.json: arm.dh.links[0].mass: is -1",
        ],
    );
}

#[test]
fn a_section_that_cannot_be_read_hides_no_fault_of_another() {
    let mut input = Input::good();
    input.control("W", json!("stiff")).set("/motion/quintic/duration", json!(0)).link(1, "mass", json!(-2.0));
    let mut other = Input::good();
    other.set("/arm/dh/links/0/joint", json!("helical")).control("period", json!(0.0));
    other.set("/measure/tube/position_error", json!(-0.1));
    expect(
        &[input, other],
        &[
            "spec0.json: control.W: is \"stiff\"",
            "spec0.json: motion.quintic.duration: is 0",
            "spec0.json: arm.dh.links[1].mass: is -2",
            "spec1.json: arm.dh.links[0].joint: is \"helical\"",
            "spec1.json: control.period: is 0",
            "spec1.json: measure.tube.position_error: is -0.1",
        ],
    );
}
