//! f32 where nothing is proved of it.

use serde_json::json;

use super::case::{Case, case, judge};

const CASES: &[Case] = &[
    case(
        "f32 with a law of the runtime",
        |i| {
            i.set("/emit", json!({ "scalar": "f32", "law": "runtime" }));
        },
        "emit.law",
        &["is `runtime`, but `emit.scalar` is `f32`", "leave it out, or write `emit.scalar` as \"f64\""],
    ),
    case(
        "a motion of more periods than f32 counts",
        |i| {
            i.set("/emit", json!({ "scalar": "f32" }));
            i.set("/motion/quintic/duration", json!(200_000.0));
        },
        "emit.scalar",
        &["which counts 16777216 periods", "write \"f64\", or a shorter motion"],
    ),
    case(
        "a number that f32 cannot hold",
        |i| {
            i.set("/emit", json!({ "scalar": "f32" }));
            i.set("/control/boundary_layer", json!(1e39));
        },
        "emit.scalar",
        &["which f32 cannot hold", "write \"f64\""],
    ),
    case(
        "angles beyond the range of the sines in f32",
        |i| {
            i.set("/emit", json!({ "scalar": "f32" }));
            i.set("/motion/quintic/to", json!([7000.0, 1.2, -2.2]));
            i.set("/motion/quintic/duration", json!(10_000.0));
        },
        "emit.trig",
        &["takes angles up to 6400.0 rad"],
    ),
];

#[test]
fn single() {
    judge(CASES);
}
