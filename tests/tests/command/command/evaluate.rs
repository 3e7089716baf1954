//! `gramforge evaluate`: D, C, G, H and τ agree with each other, with the bounds, and with the PUMA's truth.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{Outcome, committed, finish, gramforge, root, run, text};

fn evaluate(spec: &str, states: &Value, more: &[&str]) -> Outcome {
    evaluate_text(spec, &states.to_string(), more)
}

fn evaluate_text(spec: &str, states: &str, more: &[&str]) -> Outcome {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("states.json");
    fs::write(&path, states).expect("written");
    finish(gramforge().arg("evaluate").arg(committed(spec)).arg("--states").arg(path).args(more))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

/// States of the three-link arm on its motion's start, middle and end, moved inside a tube of 0.2 rad.
fn states() -> Value {
    json!([
        { "q": [0.1, 0.2, -1.1], "qd": [0.3, -0.4, 0.5], "qdd": [1.0, -2.0, 0.7] },
        { "q": [0.75, 0.75, -1.7], "qd": [0.5625, 0.3, -0.4], "qdd": [0.0, 0.5, 0.2] },
        { "q": [1.4, 1.3, -2.1], "qd": [-0.2, 0.1, 0.9], "qdd": [0.3, 0.3, 0.3] },
        { "q": [0.0, 0.3, -1.2] }
    ])
}

#[test]
fn the_parts_make_the_torque() {
    for model in ["exact", "reduced"] {
        let states = states();
        let answers = evaluate("arm3_xi2", &states, &["--model", model, "--json"]).json();
        let answers = answers.as_array().expect("a list");
        assert_eq!(answers.len(), 4);
        for (state, answer) in states.as_array().expect("a list").iter().zip(answers) {
            let of = |key: &str| state.get(key).map_or(vec![0.0; 3], list);
            let (qd, qdd) = (of("qd"), of("qdd"));
            for i in 0..3 {
                let mut torque = number(&answer["G"][i]);
                for j in 0..3 {
                    let c: f64 = (0..3).map(|k| number(&answer["H"][i][j][k]) * qd[k]).sum();
                    assert!((c - number(&answer["C"][i][j])).abs() < 1e-14, "C{i}{j}");
                    assert_eq!(answer["D"][i][j], answer["D"][j][i]);
                    torque += number(&answer["D"][i][j]) * qdd[j] + c * qd[j];
                }
                assert!((torque - number(&answer["tau"][i])).abs() < 1e-12, "τ{i}");
            }
        }
    }
}

#[test]
fn the_reduced_model_keeps_its_bounds() {
    let view = run(["inspect", &text(&committed("arm3_xi2")), "--json"]).json();
    let bounds = &view["bounds"];
    let exact = evaluate("arm3_xi2", &states(), &["--json"]).json();
    let reduced = evaluate("arm3_xi2", &states(), &["--model", "reduced", "--json"]).json();
    let mut largest: f64 = 0.0;
    for (exact, reduced) in exact.as_array().expect("a list").iter().zip(reduced.as_array().expect("a list"))
    {
        let mut within = |a: &Value, b: &Value, bound: &Value| {
            let error = (number(a) - number(b)).abs();
            assert!(error <= number(bound) + 1e-12, "{error} > {bound}");
            largest = largest.max(error);
        };
        for i in 0..3 {
            within(&exact["G"][i], &reduced["G"][i], &bounds["G"][i]);
            for j in 0..3 {
                within(&exact["D"][i][j], &reduced["D"][i][j], &bounds["D"][i][j]);
                for k in 0..3 {
                    within(&exact["H"][i][j][k], &reduced["H"][i][j][k], &bounds["H"][i][j][k]);
                }
            }
        }
    }
    assert!(largest > 1e-3, "the models differ");
}

#[test]
fn the_puma_agrees_with_the_truth() {
    let file = root().join("tests/data/truth/puma560.json");
    let truth: Value = serde_json::from_str(&fs::read_to_string(file).expect("readable")).expect("JSON");
    let samples = truth["samples"].as_array().expect("a list");
    let pick = |s: &Value| json!({ "q": s["q"], "qd": s["qd"], "qdd": s["qdd"] });
    let states = Value::Array(samples.iter().map(pick).collect());
    let bare = evaluate("puma560_exact", &states, &["--json"]).json();
    let rubbing = evaluate("puma560_exact", &states, &["--friction", "--json"]).json();
    for (index, sample) in samples.iter().enumerate() {
        let close = |found: &Value, wanted: &Value| {
            let (found, wanted) = (list(found), list(wanted));
            let scale = wanted.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
            assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() <= 1e-9 * scale), "sample {index}");
        };
        close(&bare[index]["tau"], &sample["tau_with_motor_inertia"]);
        close(&rubbing[index]["tau"], &sample["tau_with_motor_inertia_and_friction"]);
        for row in 0..6 {
            close(&bare[index]["D"][row], &sample["D_with_motor_inertia"][row]);
        }
        close(&bare[index]["G"], &sample["G"]);
    }
}

#[test]
fn bad_states_are_bad_input() {
    let missing = run(["evaluate", &text(&committed("arm3_xi2")), "--states", "nowhere.json"]).expect(2);
    assert!(missing.stderr.starts_with("nowhere.json: cannot be read"));
    let cases = [
        ("", "is not a list of states"),
        ("{}", "is not a list of states"),
        ("[{\"q\": [1, 2, \"x\"]}]", "is not a list of states"),
        ("[{\"q\": [1, 2, 1e999]}]", "is not a list of states"),
        ("[{\"qd\": [1, 2, 3]}]", "is not a list of states"),
        ("[{\"q\": [1, 2, 3], \"v\": []}]", "is not a list of states"),
        ("[{\"q\": []}]", "[0].q: has 0 entries; write 3"),
        ("[{\"q\": [1, 2, 3]}, {\"q\": [1, 2, 3], \"qd\": [1]}]", "[1].qd: has 1 entr"),
    ];
    for (states, words) in cases {
        let refused = evaluate_text("arm3_xi2", states, &["--json"]).expect(2);
        assert!(refused.stderr.contains(words), "{states}: {}", refused.stderr);
        assert_eq!(refused.stderr.lines().count(), 1);
        assert!(Path::new(refused.stderr.split(':').next().expect("a file")).ends_with("states.json"));
    }
    let both = evaluate_text("arm3_xi2", "[{\"q\": [1]}, {\"q\": [1, 2, 3], \"qdd\": [1]}]", &[]).expect(2);
    assert_eq!(both.stderr.lines().count(), 2);
}

#[test]
fn states_out_of_range_are_bad_input() {
    let states = json!([{ "q": [0.1, 0.2, 0.3] }, { "q": [0.1, 0.2, 0.3], "qd": [1e200, 1e200, 1e200] }]);
    let refused = evaluate("arm3_xi2", &states, &["--json"]).expect(2);
    assert!(refused.stderr.contains("[1]: overflows; write "), "{}", refused.stderr);
    assert_eq!(refused.stderr.lines().count(), 1);
}

#[test]
fn the_loop_is_not_judged() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut spec = crate::common::value("arm3_xi2");
    spec["control"]["W"] = json!(-1.0);
    let path = folder.path().join("spec.json");
    fs::write(&path, spec.to_string()).expect("written");
    let file = folder.path().join("states.json");
    fs::write(&file, states().to_string()).expect("written");
    let run =
        |more: &[&str]| finish(gramforge().arg("evaluate").arg(&path).arg("--states").arg(&file).args(more));
    assert_eq!(run(&["--json"]).json(), evaluate("arm3_xi2", &states(), &["--json"]).json());
    let refused = finish(gramforge().arg("inspect").arg(&path)).expect(2);
    assert!(refused.stderr.contains("control.W: is -1"), "{refused:?}");
}

#[test]
fn absurd_numbers_of_threads_are_refused() {
    let spec = text(&committed("arm3_xi2"));
    let many = finish(gramforge().args(["inspect", &spec]).env("RAYON_NUM_THREADS", "99999999")).expect(2);
    assert!(
        many.stderr.contains("RAYON_NUM_THREADS: is 99999999; write a number of threads from 1"),
        "{many:?}"
    );
}
