//! Mistakes in what is asked of the gains.

use serde_json::json;

use super::case::{Case, case, judge};
use super::input::Input;

fn ask(input: &mut Input, request: serde_json::Value) {
    for gain in ["period", "W", "Pqq", "Omega"] {
        input.remove(&format!("/control/{gain}"));
    }
    input.control("design", request);
}

const CASES: &[Case] = &[
    case(
        "a gain beside the request",
        |i| {
            ask(i, json!({ "convergence_time": 1.5 }));
            i.control("W", json!(40.0));
        },
        "control.W",
        &["is given while `control.design` asks for it", "remove"],
    ),
    case(
        "the period beside the request",
        |i| {
            ask(i, json!({ "convergence_time": 1.5 }));
            i.control("period", json!(0.01));
        },
        "control.period",
        &["is given while", "`control.design.period`"],
    ),
    case(
        "neither gain nor request",
        |i| {
            i.remove("/control/Pqq");
        },
        "control.Pqq",
        &["is missing", "write a number", "Pqq of equation (12)"],
    ),
    case(
        "no time",
        |i| ask(i, json!({ "period": 0.001 })),
        "control.design.convergence_time",
        &["is missing", "write a number"],
    ),
    case(
        "a time of zero",
        |i| ask(i, json!({ "convergence_time": 0.0 })),
        "control.design.convergence_time",
        &["is 0", "write a number from"],
    ),
    case(
        "a negative period",
        |i| ask(i, json!({ "convergence_time": 1.5, "period": -0.001 })),
        "control.design.period",
        &["is -1e-3", "write a number from"],
    ),
    case(
        "a tube wider than the measure's",
        |i| ask(i, json!({ "convergence_time": 1.5, "tube": [0.1, 0.3, 0.2] })),
        "control.design.tube[1]",
        &["is 0.3", "up to 0.2 of joint 2", "write at most 0.2", "widen `measure.tube.position_error`"],
    ),
    case(
        "a tube of two joints",
        |i| ask(i, json!({ "convergence_time": 1.5, "tube": [0.1, 0.1] })),
        "control.design.tube",
        &["has 2 entries", "write 3"],
    ),
    case(
        "no tube at all",
        |i| {
            ask(i, json!({ "convergence_time": 1.5 }));
            i.set("/measure", json!("trajectory"));
        },
        "control.design",
        &["needs room for errors", "take the measure `tube`"],
    ),
    case(
        "an arm that may start outside the tube",
        |i| {
            ask(i, json!({ "convergence_time": 1.5 }));
            i.set("/control/initial_error/position", json!(10.0));
        },
        "control.initial_error.position",
        &["is 10", "hold only up to 0.2 of joint 1", "take a smaller initial error"],
    ),
    case(
        "one joint that may start outside the tube",
        |i| {
            ask(i, json!({ "convergence_time": 1.5 }));
            i.set("/control/initial_error/position", json!([0.01, 0.3, 0.01]));
        },
        "control.initial_error.position[1]",
        &["is 0.3", "hold only up to 0.2 of joint 2"],
    ),
    case(
        "a period that no gains bear",
        |i| {
            ask(i, json!({ "convergence_time": 1.5, "period": 0.1 }));
            i.set("/control/initial_error/position", json!(0.02));
        },
        "control.design.period",
        &["0.1 s is too long", "there are gains at", "shorten it"],
    ),
];

#[test]
fn design() {
    judge(CASES);
}
