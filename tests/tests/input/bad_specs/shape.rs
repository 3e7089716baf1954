//! Mistakes of JSON and of structure.

use serde_json::json;

use super::case::{Case, case, judge};

const CASES: &[Case] = &[
    case(
        "missing field",
        |i| {
            i.remove("/arm/dh/links/1/mass");
        },
        "arm.dh.links[1].mass",
        &["is missing", "write a number", "kg"],
    ),
    case(
        "missing section",
        |i| {
            i.remove("/arm");
        },
        "arm",
        &["is missing", "write an object"],
    ),
    case(
        "unknown field",
        |i| {
            i.set("/colour", json!("red"));
        },
        "colour",
        &["is not a field", "remove it", "`name`"],
    ),
    case(
        "misspelt field",
        |i| {
            i.link(0, "alhpa", json!(0.0)).remove("/arm/dh/links/0/alpha");
        },
        "arm.dh.links[0].alhpa",
        &["is not a field", "did you mean `alpha`?"],
    ),
    case(
        "wrong type: text for number",
        |i| {
            i.link(2, "mass", json!("heavy"));
        },
        "arm.dh.links[2].mass",
        &["is \"heavy\"", "write a number"],
    ),
    case(
        "wrong type: null",
        |i| {
            i.link(2, "a", json!(null));
        },
        "arm.dh.links[2].a",
        &["is null", "write a number"],
    ),
    case(
        "wrong type: list for object",
        |i| {
            i.set("/arm", json!([1]));
        },
        "arm",
        &["is [1]", "write"],
    ),
    case(
        "wrong type: fraction for count",
        |i| {
            i.set("/model/shared/functions", json!(1.5));
        },
        "model.shared.functions",
        &["is 1.5", "write a whole number"],
    ),
    case(
        "count out of range",
        |i| {
            i.set("/model/shared/functions", json!(-1));
        },
        "model.shared.functions",
        &["is -1", "at least 0"],
    ),
    case("whole file is a list", |i| i.text = Some(b"[]".to_vec()), "", &["is []", "write an object"]),
    case(
        "wrong length of a fixed vector",
        |i| {
            i.set("/arm/gravity", json!([0.0, -9.81]));
        },
        "arm.gravity",
        &["has 2 entries", "a list of 3 numbers"],
    ),
    case(
        "repeated key",
        |i| {
            i.replace("\"period\":0.01", "\"period\":0.01,\"period\":0.02");
        },
        "control.period",
        &["occurs twice", "keep one"],
    ),
    case(
        "syntax: trailing comma",
        |i| {
            i.replace("\"law\":\"report\",", "\"law\":\"report\",,");
        },
        "",
        &["is not JSON that can be read", "correct the JSON"],
    ),
    case(
        "syntax: file breaks off",
        |i| {
            let text = i.spec.to_string();
            i.text = Some(text.as_bytes()[..text.len() / 2].to_vec());
        },
        "",
        &["is not JSON that can be read", "complete the file"],
    ),
    case(
        "syntax: a second value",
        |i| i.text = Some(format!("{} {{}}", i.spec).into_bytes()),
        "",
        &["is not JSON that can be read", "trailing", "correct the JSON"],
    ),
    case(
        "a key without end",
        |i| {
            i.spec["arm"]["k".repeat(5_000_000)] = json!(1);
        },
        "arm.kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk…",
        &["is a key of 5000000 characters", "write at most 1000"],
    ),
    case(
        "empty file",
        |i| i.text = Some(Vec::new()),
        "",
        &["is not JSON that can be read", "complete the file"],
    ),
    case(
        "number out of range",
        |i| {
            i.replace("\"mass\":5.5", "\"mass\":1e999");
        },
        "",
        &["number out of range", "write a finite number"],
    ),
    case(
        "too deep",
        |i| i.text = Some("[".repeat(100_000).into_bytes()),
        "",
        &["recursion limit", "correct the JSON"],
    ),
    case(
        "NaN",
        |i| {
            i.replace("\"mass\":5.5", "\"mass\":NaN");
        },
        "",
        &["is not JSON that can be read", "correct the JSON"],
    ),
    case(
        "unknown joint type",
        |i| {
            i.link(1, "joint", json!("helical"));
        },
        "arm.dh.links[1].joint",
        &["is \"helical\"", "\"revolute\" or \"prismatic\""],
    ),
    case(
        "unknown convention",
        |i| {
            i.set("/arm/dh/convention", json!("khalil"));
        },
        "arm.dh.convention",
        &["is \"khalil\"", "\"standard\" or \"modified\""],
    ),
    case(
        "unknown law",
        |i| {
            i.control("law", json!("pid"));
        },
        "control.law",
        &["is \"pid\"", "\"exact\"", "\"report\""],
    ),
    case(
        "unknown motion",
        |i| {
            i.set("/motion", json!({ "cubic": {} }));
        },
        "motion",
        &["is {\"cubic\":{}}", "quintic"],
    ),
    case(
        "two motions",
        |i| {
            i.set("/motion/csv", json!({ "file": "x.csv" }));
        },
        "motion",
        &["`quintic`, `csv` at once", "keep one"],
    ),
    case(
        "name is a keyword",
        |i| {
            i.set("/name", json!("loop"));
        },
        "name",
        &["\"loop\"", "choose another"],
    ),
    case(
        "name is upper case",
        |i| {
            i.set("/name", json!("Arm"));
        },
        "name",
        &["\"Arm\"", "lower-case"],
    ),
    case(
        "name is a path",
        |i| {
            i.set("/name", json!("../arm"));
        },
        "name",
        &["\"../arm\"", "lower-case"],
    ),
];

#[test]
fn shape() {
    judge(CASES);
}
