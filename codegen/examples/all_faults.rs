//! A specification with several faults: all of them are told at once, each with its field and help.

use std::path::Path;

use gramforge::load::parse;
use gramforge::{Error, Generation};

/// A mass below zero, a joint too many in the motion, and a period of no length.
const SPEC: &str = r#"{
    "name": "arm",
    "arm": { "dh": { "convention": "standard", "links": [
        { "joint": "revolute", "alpha": 0.0, "a": 0.5, "d": 0.0, "mass": -4.0, "com": [0.0, 0.0, 0.0],
          "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 } }
    ] } },
    "motion": { "quintic": { "from": [0.0], "to": [1.0, 2.0], "duration": 2.0 } },
    "control": { "law": "exact", "period": 0.0, "W": 40.0, "Pqq": 0.25, "Omega": 1.0 }
}"#;

fn main() {
    match parse(SPEC, Path::new("arm.json")).and_then(Generation::new) {
        Err(Error::Input(faults)) => {
            for fault in faults {
                println!("{}: {}\n    help: {}", fault.field, fault.problem, fault.help);
            }
        }
        Err(error) => println!("{error}"),
        Ok(_) => println!("nothing is wrong"),
    }
}
