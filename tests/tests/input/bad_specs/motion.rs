//! Mistakes in motions and measures.

use serde_json::json;

use super::case::{Case, case, judge};
use super::input::Input;

fn waypoints(i: &mut Input, times: serde_json::Value) {
    let positions = json!([[0.0, 0.0, 0.0], [0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]);
    i.set("/motion", json!({ "waypoints": { "times": times, "positions": positions } }));
}

const CASES: &[Case] = &[
    case(
        "wrong length",
        |i| {
            i.set("/motion/quintic/to", json!([1.5, 1.2]));
        },
        "motion.quintic.to",
        &["has 2 entries", "write 3, one for each joint"],
    ),
    case(
        "negative duration",
        |i| {
            i.set("/motion/quintic/duration", json!(-5.0));
        },
        "motion.quintic.duration",
        &["is -5", "above 0, in s"],
    ),
    case(
        "a motion beyond all measure",
        |i| {
            i.link(0, "limits", json!({ "position": [-3, 3] })).set("/motion/quintic/to/0", json!(1e300));
        },
        "motion",
        &["position of joint 1 (joint1) is ", "e", "s, outside its limits [-3, 3]"],
    ),
    case(
        "a waypoint without end",
        |i| {
            let positions = vec![vec![0.0, 0.3, -1.2]; 3];
            i.set("/motion", json!({ "waypoints": { "times": [0.0, 1.0, 2e7], "positions": positions } }));
        },
        "motion.waypoints.times[2]",
        &["is 2e7", "at most 1e7, in s"],
    ),
    case(
        "outside the position limits",
        |i| {
            i.link(1, "limits", json!({ "position": [-1.0, 1.0] }));
        },
        "motion",
        &["position of joint 2", "t = 5.000 s", "[-1, 1]", "keep the motion inside"],
    ),
    case(
        "outside the velocity limits",
        |i| {
            i.link(0, "limits", json!({ "velocity": 0.1 }));
        },
        "motion",
        &["velocity of joint 1", "[-0.1, 0.1]", "keep the motion inside"],
    ),
    case(
        "outside the acceleration limits",
        |i| {
            i.link(0, "limits", json!({ "acceleration": 0.1 }));
        },
        "motion",
        &["acceleration of joint 1", "[-0.1, 0.1]", "keep the motion inside"],
    ),
    case(
        "times that fall",
        |i| waypoints(i, json!([0.0, 2.0, 1.0])),
        "motion.waypoints.times[2]",
        &["is 1, after 2", "write the times in increasing order"],
    ),
    case(
        "times that start late",
        |i| waypoints(i, json!([0.5, 1.0, 2.0])),
        "motion.waypoints.times[0]",
        &["is 0.5", "start at 0"],
    ),
    case(
        "as many positions as times",
        |i| waypoints(i, json!([0.0, 1.0])),
        "motion.waypoints.positions",
        &["has 3 entries", "write 2, one for each time"],
    ),
    case(
        "sinusoids of two joints",
        |i| {
            let terms = json!([[], [{ "amplitude": 0.1, "frequency": 1.0 }]]);
            let offset = json!([0.0, 0.0, 0.0]);
            i.set("/motion", json!({ "sinusoids": { "offset": offset, "terms": terms, "duration": 2.0 } }));
        },
        "motion.sinusoids.terms",
        &["has 2 entries", "write 3"],
    ),
    case(
        "table is missing",
        |i| {
            i.set("/motion", json!({ "csv": { "file": "nowhere.csv" } }));
        },
        "motion.csv.file",
        &["cannot read", "nowhere.csv", "name a readable CSV file"],
    ),
    case(
        "table with NaN",
        |i| {
            i.csv("0,0,0,0\n1,NaN,0,0\n2,0,0,0\n");
        },
        "",
        &["column 2 is `NaN`", "write a finite number"],
    )
    .inside("motion.csv")
    .line(2),
    case(
        "table with a word",
        |i| {
            i.csv("t,a,b,c\n0,0,0,0\n1,0,zero,0\n2,0,0,0\n");
        },
        "",
        &["column 3 is `zero`", "write a finite number"],
    )
    .inside("motion.csv")
    .line(3),
    case(
        "table with a column too few",
        |i| {
            i.csv("0,0,0,0\n1,0,0\n2,0,0,0\n");
        },
        "",
        &["has 3 columns", "write 4 columns"],
    )
    .inside("motion.csv")
    .line(2),
    case(
        "table whose times fall",
        |i| {
            i.csv("0,0,0,0\n1,0,0,0\n1,0,0,0\n2,0,0,0\n");
        },
        "",
        &["time 1 is not later than 1", "increasing times"],
    )
    .inside("motion.csv")
    .line(3),
    case(
        "table of two rows",
        |i| {
            i.csv("0,0,0,0\n1,0,0,0\n");
        },
        "",
        &["has 2 rows", "at least three rows"],
    )
    .inside("motion.csv"),
    case(
        "empty table",
        |i| {
            i.csv("");
        },
        "",
        &["has 0 rows", "at least three rows"],
    )
    .inside("motion.csv"),
    case(
        "tube without motion",
        |i| {
            i.remove("/motion");
        },
        "motion",
        &["is missing", "`tube`", "add a motion"],
    ),
    case(
        "trajectory without motion",
        |i| {
            i.remove("/motion").set("/measure", json!("trajectory"));
        },
        "motion",
        &["is missing", "`trajectory`", "add a motion"],
    ),
    case(
        "workspace without limits",
        |i| {
            i.set("/measure", json!("workspace"));
        },
        "measure",
        &["joint1 lacks position and velocity and acceleration", "add the limits"],
    ),
    case(
        "negative tube",
        |i| {
            i.set("/measure/tube/position_error", json!(-0.2));
        },
        "measure.tube.position_error",
        &["is -0.2", "at least 0"],
    ),
    case(
        "tube of two joints",
        |i| {
            i.set("/measure/tube/position_error", json!([0.2, 0.2]));
        },
        "measure.tube.position_error",
        &["has 2 entries", "write 3"],
    ),
    case(
        "simulation without time",
        |i| {
            i.set("/simulation", json!({ "duration": 0.0 }));
        },
        "simulation.duration",
        &["is 0", "above 0, in s"],
    ),
    case(
        "simulation without substeps",
        |i| {
            i.set("/simulation", json!({ "substeps": 0 }));
        },
        "simulation.substeps",
        &["is 0", "at least 1"],
    ),
    case(
        "a motion without end",
        |i| {
            i.set("/motion/quintic/duration", json!(1e300));
        },
        "motion.quintic.duration",
        &["is 1e300", "at most 1e7, in s"],
    ),
    case(
        "more rows than a module should hold",
        |i| {
            i.csv(&(0..30_000).map(|k| format!("{}.0,0.1,0.2,-1.2\n", k)).collect::<String>());
        },
        "",
        &["is row 20001 of numbers", "at most 20000 are read", "keep every second row"],
    )
    .inside("motion.csv")
    .line(20001),
    case(
        "more waypoints than a module should hold",
        |i| {
            let times: Vec<f64> = (0..20_001).map(f64::from).collect();
            let positions = vec![[0.1, 0.2, -1.2]; 20_001];
            i.set("/motion", json!({ "waypoints": { "times": times, "positions": positions } }));
        },
        "motion.waypoints.times",
        &["has 20001 entries", "write at most 20000"],
    ),
];

#[test]
fn motion() {
    judge(CASES);
}
