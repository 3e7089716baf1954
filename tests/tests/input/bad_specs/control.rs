//! Mistakes in the numbers of the law.

use serde_json::json;

use super::case::{Case, case, judge};

const CASES: &[Case] = &[
    case(
        "gain of wrong length",
        |i| {
            i.control("W", json!([40.0, 40.0]));
        },
        "control.W",
        &["has 2 entries", "write one number, 3 numbers or 3 rows"],
    ),
    case(
        "gain matrix of wrong size",
        |i| {
            i.control("Pqq", json!([[1.0, 0.0], [0.0, 1.0]]));
        },
        "control.Pqq",
        &["has 2 rows", "3 rows of 3 numbers"],
    ),
    case(
        "gain not symmetric",
        |i| {
            i.control("W", json!([[40.0, 1.0, 0.0], [0.0, 40.0, 0.0], [0.0, 0.0, 40.0]]));
        },
        "control.W[0][1]",
        &["not symmetric: 1 and 0", "the same number on both sides"],
    ),
    case(
        "gain not positive definite",
        |i| {
            i.control("W", json!([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
        },
        "control.W",
        &["not positive definite", "write a positive number"],
    ),
    case(
        "gain of zero",
        |i| {
            i.control("Omega", json!(0.0));
        },
        "control.Omega",
        &["is 0", "positive number"],
    ),
    case(
        "negative gain of one joint",
        |i| {
            i.control("Pqq", json!([0.25, -0.25, 0.25]));
        },
        "control.Pqq[1]",
        &["is -0.25", "write a positive number"],
    ),
    case(
        "P12 with a negative entry",
        |i| {
            i.control("Omega", json!([[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 1.0]]));
        },
        "control.Omega",
        &["P12", "negative entry -4", "row 0, column 1", "choose Pqq and Omega"],
    ),
    case(
        "P12 not symmetric",
        |i| {
            i.control("Pqq", json!([1.0, 2.0, 1.0]));
            i.control("Omega", json!([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 1.0]]));
        },
        "control.Omega",
        &["P12", "not symmetric", "commute"],
    ),
    case(
        "period of zero",
        |i| {
            i.control("period", json!(0.0));
        },
        "control.period",
        &["is 0", "above 0, in s"],
    ),
    case(
        "boundary layer of zero",
        |i| {
            i.control("boundary_layer", json!(0.0));
        },
        "control.boundary_layer",
        &["is 0", "above 0, or leave the field out"],
    ),
    case(
        "boundary layer of two joints",
        |i| {
            i.control("boundary_layer", json!([0.1, 0.1]));
        },
        "control.boundary_layer",
        &["has 2 entries", "write 3"],
    ),
    case(
        "negative initial error",
        |i| {
            i.set("/control/initial_error/position", json!(-0.2));
        },
        "control.initial_error.position",
        &["is -0.2", "at least 0"],
    ),
    case(
        "gains that overflow",
        |i| {
            i.control("Pqq", json!(1e300));
        },
        "control",
        &["overflow", "SI units"],
    ),
];

#[test]
fn control() {
    judge(CASES);
}
