//! A C interface of what has none.

use serde_json::json;

use super::case::{Case, case, judge};
use super::input::Input;

fn asked(input: &mut Input) {
    input.set("/emit", json!({ "c_api": true }));
}

const CASES: &[Case] = &[
    case(
        "C interface without a controller",
        |i| {
            asked(i);
            i.remove("/control");
        },
        "emit.c_api",
        &["there is no `control`", "add `control`, or remove `emit.c_api`"],
    ),
    case(
        "C interface of a law of the runtime",
        |i| {
            asked(i);
            i.set("/emit/law", json!("runtime"));
        },
        "emit.c_api",
        &["needs a step that is written out, but `emit.law` is `runtime`", "remove `emit.law`"],
    ),
    case(
        "C interface with the sines of the platform",
        |i| {
            asked(i);
            i.set("/emit/trig", json!("std"));
        },
        "emit.trig",
        &["two of these do not link into one program", "write \"polynomial\""],
    ),
    case(
        "C interface called as a part of the C library",
        |i| {
            asked(i);
            i.set("/name", json!("sem"));
        },
        "name",
        &["is \"sem\", and `sem_init` in C may be", "choose another name"],
    ),
    case(
        "C interface called as one of a family of the C library",
        |i| {
            asked(i);
            i.set("/name", json!("pthread_mutex"));
        },
        "name",
        &["`pthread_mutex_init` in C may be", "choose another name"],
    ),
    case(
        "C interface neither asked for nor not",
        |i| {
            i.set("/emit", json!({ "c_api": "yes" }));
        },
        "emit.c_api",
        &["is \"yes\"", "true"],
    ),
];

#[test]
fn c_api() {
    judge(CASES);
}
