//! Mistakes in what is uncertain and in how it is learnt.

use serde_json::{Value, json};

use super::case::{Case, case, judge};
use super::input::Input;

fn link(input: &mut Input, link: Value) {
    input.control("uncertainty", json!({ "links": [link] }));
}

/// Law `adaptive` with a good interval, and this in its adaptation.
fn p_theta(input: &mut Input, value: Value) {
    link(input, json!({ "joint": "joint3", "mass": [2.8, 4.2] }));
    input.control("law", json!("adaptive")).control("adaptation", json!({ "Ptheta": value }));
    input.control("boundary_layer", json!(0.1)).control("allow_long_period", json!(true));
}

const CASES: &[Case] = &[
    case(
        "unknown joint",
        |i| link(i, json!({ "joint": "elbow", "mass": [2.8, 4.2] })),
        "control.uncertainty.links[0].joint",
        &["is \"elbow\"", "no joint of the arm", "name one of joint1, joint2, joint3"],
    ),
    case(
        "a joint twice",
        |i| {
            let entry = json!({ "joint": "joint3", "mass": [2.8, 4.2] });
            i.control("uncertainty", json!({ "links": [entry, entry] }));
        },
        "control.uncertainty.links[1].joint",
        &["is \"joint3\" again", "one place"],
    ),
    case(
        "link without an interval",
        |i| link(i, json!({ "joint": "joint3" })),
        "control.uncertainty.links[0]",
        &["names no uncertain number", "write an interval"],
    ),
    case(
        "interval beside the arm's own mass",
        |i| link(i, json!({ "joint": "joint3", "mass": [3.6, 4.2] })),
        "control.uncertainty.links[0].mass",
        &["is [3.6, 4.2]", "does not contain the arm's own 3.5", "write an interval about"],
    ),
    case(
        "interval beside the arm's own first moment",
        |i| link(i, json!({ "joint": "joint2", "first_moment": [[-0.3, 0.1], null, null] })),
        "control.uncertainty.links[0].first_moment[0]",
        &["is [-0.3, 0.1]", "does not contain the arm's own -0.375", "write an interval about"],
    ),
    case(
        "ends the wrong way round",
        |i| link(i, json!({ "joint": "joint3", "mass": [4.2, 2.8] })),
        "control.uncertainty.links[0].mass",
        &["is [4.2, 2.8]", "the lower one first"],
    ),
    case(
        "negative mass",
        |i| {
            i.control("uncertainty", json!({ "payload": { "mass": [-0.1, 1.0] } }));
        },
        "control.uncertainty.payload.mass",
        &["is [-0.1, 1.0]", "at least 0"],
    ),
    case(
        "viscous friction of two joints",
        |i| {
            i.control("uncertainty", json!({ "viscous_friction": [null, [0.0, 1.0]] }));
        },
        "control.uncertainty.viscous_friction",
        &["has 2 entries", "write 3, one for each joint"],
    ),
    case(
        "negative viscous friction",
        |i| {
            i.control("uncertainty", json!({ "viscous_friction": [null, [-1.0, 1.0], null] }));
        },
        "control.uncertainty.viscous_friction[1]",
        &["is [-1.0, 1.0]", "at least 0"],
    ),
    case(
        "eleven uncertain numbers",
        |i| {
            let near = |x: f64| json!([x - 0.001, x + 0.001]);
            let moments = [near(-0.3), near(0.0), near(0.0)];
            let inertia = json!({ "xx": near(0.12), "yy": near(0.0), "zz": near(0.0), "xy": near(0.0), "xz": near(0.0), "yz": near(0.0) });
            i.control(
                "uncertainty",
                json!({ "links": [
                { "joint": "joint2", "mass": near(4.0) },
                { "joint": "joint3", "mass": near(3.5), "first_moment": moments, "pseudo_inertia": inertia }
            ] }),
            );
        },
        "control.uncertainty",
        &["has 11 uncertain numbers", "keep the 10"],
    ),
    case(
        "intervals that reach an arm that cannot be",
        |i| link(i, json!({ "joint": "joint3", "mass": [0.0, 3.5] })),
        "control.uncertainty",
        &[
            "admits an arm that cannot exist",
            "links[0].mass = 0.0",
            "smallest eigenvalue -",
            "narrow the intervals",
        ],
    ),
    case(
        "nothing uncertain to learn",
        |i| {
            i.control("law", json!("adaptive"));
        },
        "control.uncertainty",
        &["is missing", "nothing to learn", "write the intervals"],
    ),
    case(
        "nothing that varies to learn",
        |i| {
            link(i, json!({ "joint": "joint3", "mass": [3.5, 3.5] }));
            i.control("law", json!("adaptive"));
        },
        "control.law",
        &["no parameter can vary", "widen an interval"],
    ),
    case(
        "adaptation of a law that does not learn",
        |i| {
            i.control("adaptation", json!({ "Ptheta": 1.0 }));
        },
        "control.adaptation",
        &["applies only to law `adaptive`", "remove it"],
    ),
    case("Ptheta of zero", |i| p_theta(i, json!(0.0)), "control.adaptation.Ptheta", &["is 0", "above 0"]),
    case(
        "negative Ptheta of one parameter",
        |i| p_theta(i, json!([-1.0])),
        "control.adaptation.Ptheta[0]",
        &["is -1", "above 0"],
    ),
    case(
        "Ptheta of two parameters",
        |i| p_theta(i, json!([1.0, 1.0])),
        "control.adaptation.Ptheta",
        &["has 2 entries", "write one number, or 1, one for each parameter"],
    ),
    case(
        "Ptheta without an inverse",
        |i| p_theta(i, json!(1e-310)),
        "control.adaptation.Ptheta",
        &["has an inverse that overflows", "write larger numbers"],
    ),
];

#[test]
fn uncertainty() {
    judge(CASES);
}
