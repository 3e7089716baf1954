//! Models that cannot be, and what does not go with them.

use serde_json::json;

use super::case::{Case, case, judge};
use super::input::Input;

/// A table of sines, and the model as given; `None`: none is written.
fn table(i: &mut Input, model: Option<serde_json::Value>) -> &mut Input {
    i.set("/emit", json!({ "trig": { "table": { "error": 1e-3 } } }));
    match model {
        Some(model) => i.set("/model", model),
        None => i.remove("/model"),
    }
}

/// The same with a law that learns.
fn learning(i: &mut Input, model: Option<serde_json::Value>) -> &mut Input {
    i.control("law", json!("adaptive"))
        .control("uncertainty", json!({ "links": [{ "joint": "joint3", "mass": [2.8, 4.2] }] }));
    match model {
        Some(model) => i.set("/model", model),
        None => i.remove("/model"),
    }
}

const CASES: &[Case] = &[
    case(
        "no functions",
        |i| {
            i.set("/model/shared/functions", json!(0));
        },
        "model.shared.functions",
        &["is 0", "at least 1"],
    ),
    case(
        "no functions for each coefficient",
        |i| {
            i.set("/model", json!({ "separate": { "functions": 0 } }));
        },
        "model.separate.functions",
        &["is 0", "at least 1"],
    ),
    case(
        "more functions than there are",
        |i| {
            i.set("/model/shared/functions", json!(12));
        },
        "model.shared.functions",
        &["is 12", "exact model has 11 functions", "1 to 11"],
    ),
    case(
        "more functions for each coefficient than there are",
        |i| {
            i.set("/model", json!({ "separate": { "functions": 12 } }));
        },
        "model.separate.functions",
        &["is 12", "exact model has 11 functions", "1 to 11"],
    ),
    case(
        "more functions than there are products",
        |i| {
            i.set("/model/shared/functions", json!(100)).set("/dictionary", json!("product"));
        },
        "model.shared.functions",
        &["is 100", "dictionary `product` has ", "write a number from 1 to "],
    ),
    case(
        "more functions than both dictionaries hold",
        |i| {
            i.set("/model", json!({ "separate": { "functions": 100 } })).set("/dictionary", json!("union"));
        },
        "model.separate.functions",
        &["is 100", "dictionary `union` has ", "write a number from 1 to "],
    ),
    case(
        "no tolerance",
        |i| {
            i.set("/model", json!({ "tolerance": { "torque": 0.0 } }));
        },
        "model.tolerance.torque",
        &["is 0", "above 0 and below 1"],
    ),
    case(
        "negative tolerance",
        |i| {
            i.set("/model", json!({ "tolerance": { "torque": -0.01 } }));
        },
        "model.tolerance.torque",
        &["is -0.01", "above 0 and below 1"],
    ),
    case(
        "tolerance of everything",
        |i| {
            i.set("/model", json!({ "tolerance": { "torque": 1.0 } }));
        },
        "model.tolerance.torque",
        &["is 1", "above 0 and below 1"],
    ),
    case(
        "tolerance in percent",
        |i| {
            i.set("/model", json!({ "tolerance": { "torque": 5.0 } }));
        },
        "model.tolerance.torque",
        &["is 5", "a fraction", "such as 0.01"],
    ),
    case(
        "tolerance without a number",
        |i| {
            i.set("/model", json!({ "tolerance": {} }));
        },
        "model.tolerance.torque",
        &["is missing", "write a number"],
    ),
    case(
        "tolerance over a workspace without rates",
        |i| {
            i.set("/measure", json!("workspace")).set("/model", json!({ "tolerance": { "torque": 0.01 } }));
            for link in 0..3 {
                i.link(link, "limits", json!({ "position": [-3.0, 3.0] }));
            }
        },
        "measure",
        &["joint1 lacks velocity and acceleration", "joint3 lacks", "add the limits"],
    ),
    case(
        "no model over a workspace without accelerations",
        |i| {
            i.set("/measure", json!("workspace")).remove("/model");
            for link in 0..3 {
                i.link(link, "limits", json!({ "position": [-3.0, 3.0], "velocity": 2.0 }));
            }
        },
        "measure",
        &["joint1 lacks acceleration", "joint3 lacks", "add the limits"],
    ),
    case(
        "a dictionary for a tolerance",
        |i| {
            i.set("/dictionary", json!("product")).set("/model", json!({ "tolerance": { "torque": 0.01 } }));
        },
        "dictionary",
        &["`shared` and `separate`", "`model` is `tolerance`", "leave it out"],
    ),
    case(
        "a dictionary without a model",
        |i| {
            i.set("/dictionary", json!("union")).remove("/model");
        },
        "dictionary",
        &["`model` is `auto`, which is the default", "leave it out", "{\"shared\": "],
    ),
    case(
        "a dictionary for the exact model",
        |i| {
            i.set("/dictionary", json!("product")).set("/model", json!("exact"));
        },
        "dictionary",
        &["`model` is `exact`", "leave it out"],
    ),
    case(
        "a table of sines without a model",
        |i| {
            table(i, None);
        },
        "emit.trig",
        &["asks for a table", "`model` is `auto`, which is the default", "\"polynomial\"", "or \"exact\""],
    ),
    case(
        "a table of sines for a tolerance",
        |i| {
            table(i, Some(json!({ "tolerance": { "torque": 0.05 } })));
        },
        "emit.trig",
        &["asks for a table", "`model` is `tolerance`", "\"polynomial\"", "or \"exact\""],
    ),
    case(
        "a table of sines for products",
        |i| {
            table(i, Some(json!({ "separate": { "functions": 2 } }))).set("/dictionary", json!("product"));
        },
        "emit.trig",
        &["asks for a table", "`dictionary` is `product`", "\"polynomial\"", "leave out `dictionary`"],
    ),
    case(
        "a law that learns without a model",
        |i| {
            learning(i, None);
        },
        "control.law",
        &["is `adaptive`", "`model` is `auto`, which is the default", "{\"shared\": ", "`tight`"],
    ),
    case(
        "a law that learns for a tolerance",
        |i| {
            learning(i, Some(json!({ "tolerance": { "torque": 0.05 } })));
        },
        "control.law",
        &["is `adaptive`", "`model` is `tolerance`", "{\"shared\": ", "`tight`"],
    ),
    case(
        "a law that learns for separate functions",
        |i| {
            learning(i, Some(json!({ "separate": { "functions": 2 } })));
        },
        "control.law",
        &["is `adaptive`", "`model` is `separate`", "{\"shared\": ", "`tight`"],
    ),
    case(
        "a law that learns for products",
        |i| {
            learning(i, Some(json!({ "shared": { "functions": 2 } }))).set("/dictionary", json!("union"));
        },
        "control.law",
        &["is `adaptive`", "`dictionary` is `union`", "; leave out `dictionary`, or take law"],
    ),
    case(
        "a law that learns for separate products",
        |i| {
            learning(i, Some(json!({ "separate": { "functions": 2 } }))).set("/dictionary", json!("product"));
        },
        "control.law",
        &["is `adaptive`", "`dictionary` is `product`", "; leave out `dictionary` and write `model` as "],
    ),
];

#[test]
fn model() {
    judge(CASES);
}
