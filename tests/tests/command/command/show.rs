//! `gramforge inspect` and `gramforge simulate`: the keys that others read, with the right numbers.

use std::fs;

use serde_json::{Value, json};

use crate::common::{committed, finish, gramforge, run, text, value};

#[test]
fn inspect_knows_the_three_link_arm() {
    let view = run(["inspect", &text(&committed("arm3_xi2")), "--json"]).json();
    assert_eq!(view["name"], "arm3_xi2");
    assert_eq!(view["joints"], 3);
    assert_eq!(view["functions"], 11);
    assert_eq!(view["coefficients"], 9);
    assert_eq!(view["terms"], 20);
    assert_eq!(view["selected"].as_array().map(Vec::len), Some(2));
    let lengths = |key: &str| view["bounds"][key].as_array().map(Vec::len);
    assert!(["D", "H", "G", "C"].iter().all(|key| lengths(key) == Some(3)), "{}", view["bounds"]);
    for kind in ["reduced", "exact"] {
        for operation in ["mul", "add", "trig_pairs"] {
            assert!(view["operations"][kind][operation].is_u64(), "{kind} {operation}");
        }
    }
    assert_eq!(view["operations"]["exact"]["trig_pairs"], 2);
}

#[test]
fn inspect_of_the_exact_model_leaves_nothing_out() {
    let view = run(["inspect", &text(&committed("arm3_exact")), "--json"]).json();
    assert_eq!(view["selected"], json!([]));
    assert_eq!(view["bounds"]["G"], json!([0.0, 0.0, 0.0]));
    assert_eq!(view["bounds"]["D"], json!([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]));
    assert_eq!(view["operations"]["reduced"], view["operations"]["exact"]);
}

/// A committed specification, what is changed of it, and words of the verdict.
type Judged = (&'static str, fn(&mut Value), &'static str);

#[test]
fn the_verdict_follows_from_the_operations() {
    // Reduced and cheaper, reduced and dearer, cheaper without a controller, exact, exact because nothing cheaper keeps within
    // the tolerance, and exact because what does saves too little.
    let strict = |spec: &mut Value| spec["model"] = json!({ "tolerance": { "torque": 1e-6 } });
    let loose = |spec: &mut Value| spec["model"] = json!({ "tolerance": { "torque": 0.03 } });
    let alone = |spec: &mut Value| drop(spec.as_object_mut().expect("an object").remove("control"));
    let cases: [Judged; 6] = [
        ("puma560_one_percent", |_| {}, "The reduction pays"),
        ("arm3_xi1", alone, "The reduction pays"),
        ("arm3_xi2", loose, "saves less than 5 %"),
        (
            "arm3_xi2",
            |spec| spec["model"] = json!({ "shared": { "functions": 4 } }),
            "The reduction does not pay",
        ),
        ("arm3_exact", |_| {}, "This is the exact model."),
        ("arm3_xi2", strict, "No sparse model is sought for tolerances below 0.31 %"),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    for (index, (name, edit, words)) in cases.into_iter().enumerate() {
        let mut spec = value(name);
        edit(&mut spec);
        let path = folder.path().join(format!("arm{index}.json"));
        fs::write(&path, spec.to_string()).expect("written");
        let view = run(["inspect", &text(&path), "--json"]).json();
        let verdict = view["verdict"].as_str().expect("a sentence");
        assert!(verdict.contains(words), "{name}: {verdict}");
        assert!(verdict.ends_with('.') && verdict.matches(". ").count() == 0, "one sentence: {verdict}");
        let controlled = !view["step_operations"].is_null();
        let counted = &view[if controlled { "step_operations" } else { "operations" }];
        let cost = |kind: &str| {
            let count = |key: &str| counted[kind][key].as_u64().expect("a count");
            count("mul") + count("add") + 2 * count("other") + 5 * count("div") + 12 * count("trig_pairs")
        };
        // A step must save a twentieth.
        let (ours, theirs) = if controlled { (20, 19) } else { (20, 20) };
        let pays = ours * cost("reduced") <= theirs * cost("exact") && cost("reduced") < cost("exact");
        assert_eq!(verdict.contains("reduction pays"), pays, "{verdict}");
        let error = view["torque_error"].as_array().expect("a list");
        let joints = view["joints"].as_u64().expect("a count") as usize;
        assert_eq!((error.len(), view["peak_torque"].as_array().map(Vec::len)), (joints, Some(joints)));
        // The same sentences wherever it is spoken of.
        let out = folder.path().join("out");
        let mut command = gramforge();
        let told = finish(command.arg("generate").arg(&path).arg("--out").arg(&out)).expect(0).stdout;
        let module = fs::read_to_string(out.join(format!("{name}.rs"))).expect("generated");
        let shown = run(["inspect", &text(&path)]).expect(0).stdout;
        for sayer in [&told, &module, &shown] {
            assert!(sayer.contains(verdict), "{verdict}: {sayer}");
            assert!(sayer.contains("Certified torque error"), "{sayer}");
        }
        assert_eq!(view["size"], module.len());
        assert!(
            told.contains(&format!("{} bytes", module.len()))
                && shown.contains(&format!("{} bytes", module.len()))
        );
        for kind in ["reduced", "exact"] {
            let costs = &view["operations"][kind];
            let short =
                format!("{} mul, {} add, {} sin-cos pairs", costs["mul"], costs["add"], costs["trig_pairs"]);
            assert!(told.contains(&short) && shown.contains(&short), "{short}: {told}{shown}");
            let long = format!(
                "{} multiplications, {} additions, {} sine-cosine pairs",
                costs["mul"], costs["add"], costs["trig_pairs"]
            );
            assert!(module.contains(&long), "{long}: {module}");
        }
    }
}

#[test]
fn inspect_in_words() {
    let shown = run(["inspect", &text(&committed("arm3_xi2"))]).expect(0).stdout;
    assert!(shown.contains("11 functions, 9 distinct coefficients, 20 terms"), "{shown}");
}

/// `%` after a power of ten, or a word for what is no number.
fn is_unreadable(line: &str) -> bool {
    let words: Vec<&str> = line.split(|c: char| c.is_whitespace() || "(),;:[]".contains(c)).collect();
    let power = |pair: &[&str]| pair[1] == "%" && pair[0].contains('e');
    words.windows(2).any(power) || words.iter().any(|word| ["inf", "-inf", "NaN"].contains(word))
}

#[test]
fn numbers_are_for_people() {
    // Two links that hang and stay at rest: no torque at all, so that no error is a part of it.
    let link = json!({ "joint": "revolute", "alpha": 0.0, "a": 1.0, "d": 0.0, "theta": 0.0, "mass": 1.0,
        "com": [-0.4, 0.0, 0.0], "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 } });
    let hanging = json!({
        "name": "hanging",
        "arm": { "gravity": [9.81, 0.0, 0.0], "dh": { "convention": "standard", "links": [link, link] } },
        "motion": { "quintic": { "from": [0.0, 0.0], "to": [0.0, 0.0], "duration": 1.0 } },
        "model": { "shared": { "functions": 1 } }
    });
    let folder = tempfile::tempdir().expect("a folder");
    for (name, spec, words) in [
        ("hanging", hanging, "a percentage is not available, since a joint takes no torque."),
        ("arm3_xi2", value("arm3_xi2"), "that is 56.67 % in the worst joint."),
        ("arm3_exact", value("arm3_exact"), "This is the exact model."),
        ("arm3_adaptive", value("arm3_adaptive"), " % in the worst joint."),
    ] {
        let path = folder.path().join("arm.json");
        fs::write(&path, spec.to_string()).expect("written");
        let shown = run(["inspect", &text(&path)]).expect(0).stdout;
        let out = text(folder.path());
        let told = run(["generate", &text(&path), "--out", &out]).expect(0).stdout;
        let module = fs::read_to_string(folder.path().join(format!("{name}.rs"))).expect("generated");
        for sayer in [&shown, &told, &module] {
            assert!(sayer.contains(words), "{words}: {sayer}");
            let unreadable: Vec<&str> = sayer.lines().filter(|line| is_unreadable(line)).collect();
            assert!(unreadable.is_empty(), "{name}: {unreadable:#?}");
        }
    }
    assert!(is_unreadable("that is inf % of it") && is_unreadable("5.667e1 % in"));
}

fn simulated(edit: impl Fn(&mut Value)) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let mut spec = value("arm3_xi2");
    edit(&mut spec);
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    finish(gramforge().arg("simulate").arg(path).arg("--json")).json()
}

#[test]
fn simulate_sums_up_both_laws() {
    let summary = simulated(|spec| spec["simulation"] = json!({ "duration": 1.0, "substeps": 4 }));
    assert_eq!(summary["law_kind"], "report");
    for law in ["exact", "law"] {
        let metrics = &summary[law];
        for key in ["rms_error", "torque_total_variation", "peak_torque", "final_error"] {
            let list = metrics[key].as_array().expect("a list");
            assert_eq!(list.len(), 3, "{law} {key}");
            assert!(list.iter().all(|v| v.as_f64().is_some_and(|v| v >= 0.0)), "{law} {key}");
        }
        assert!(metrics.get("convergence_time").is_some_and(|v| v.is_null() || v.is_f64()));
    }
}

/// What more runs find is no smaller, and the table and the JSON say the same.
#[test]
fn simulate_seeks_the_worst_in_many_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut spec = value("arm3_robust");
    spec["motion"]["quintic"]["duration"] = json!(1.0);
    spec["control"]["settle"] = json!(2.0);
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    let sought = |runs: &str| {
        finish(gramforge().arg("simulate").arg(&path).args(["--json", "--runs", runs])).json()["monte_carlo"]
            .clone()
    };
    let (few, many) = (sought("1"), sought("40"));
    assert_eq!((&few["runs"], &many["runs"]), (&json!(1), &json!(40)));
    let mut grown = 0;
    for key in ["reach", "settled_error", "end_error", "torque_max"] {
        let list = |found: &Value| -> Vec<f64> {
            let list = found[key].as_array().expect("a list");
            list.iter().map(|value| value.as_f64().expect("a number")).collect()
        };
        let (few, many) = (list(&few), list(&many));
        assert_eq!(many.len(), 3, "{key}");
        assert!(
            few.iter().zip(&many).all(|(few, many)| 0.0 < *few && few <= many),
            "{key}: {few:?} {many:?}"
        );
        grown += usize::from(few != many);
    }
    assert!(grown >= 3, "{few} {many}");
    // The corners of the initial error are among the starts.
    assert!(many["reach"].as_array().expect("a list").iter().all(|reach| reach.as_f64() > Some(0.2 - 1e-9)));
    let table = finish(gramforge().arg("simulate").arg(&path).args(["--runs", "40"])).expect(0).stdout;
    assert!(table.contains("40 runs of 3.000 s, found and not proved."), "{table}");
    let plain = finish(gramforge().arg("simulate").arg(&path).arg("--json")).json();
    assert!(plain.get("monte_carlo").is_none(), "only on request");
    let refused = finish(gramforge().arg("simulate").arg(&path).args(["--runs", "0"])).expect(2);
    assert!(refused.stderr.contains("--runs"), "{refused:?}");
}

/// Each robust gain is measured, whichever the law has; what the law has is measured in the run that is shown.
#[test]
fn simulate_measures_the_chatter_of_each_robust_gain() {
    let with = |gain: &str| {
        simulated(|spec| {
            spec["simulation"] = json!({ "duration": 0.5 });
            spec["control"]["robust_gain"] = json!(gain);
        })
    };
    let measured = |summary: &Value| -> Vec<(String, bool, f64)> {
        let of = |one: &Value| {
            let step = one["relative_step"].as_f64().expect("a number");
            (one["robust_gain"].as_str().expect("a name").to_string(), one["used"] == true, step)
        };
        summary["measured_chatter"].as_array().expect("a list").iter().map(of).collect()
    };
    let summaries = ["state", "constant"].map(with);
    let [state, constant] = summaries.each_ref().map(measured);
    for (index, name) in ["state", "constant"].into_iter().enumerate() {
        assert_eq!(state[index], (name.to_string(), index == 0, state[index].2));
        assert_eq!(constant[index], (name.to_string(), index == 1, state[index].2));
    }
    // The sign function switches by the whole gain in every period, and the constant one is never smaller.
    assert!(state[1].2 > state[0].2 && state[0].2 > 0.0, "{state:?}");
    for (summary, (_, _, step)) in summaries.iter().zip([&state[0], &state[1]]) {
        let list = |key: &str| -> Vec<f64> {
            let values = summary["law"][key].as_array().expect("a list");
            values.iter().map(|value| value.as_f64().expect("a number")).collect()
        };
        let (variation, peak) = (list("torque_total_variation"), list("peak_torque"));
        // Periods of 10 ms.
        let largest = variation.iter().zip(&peak).map(|(variation, peak)| variation / 50.0 / peak);
        assert!((largest.fold(0.0, f64::max) / step - 1.0).abs() < 1e-9, "{step}");
    }
    let exact = simulated(|spec| {
        spec["simulation"] = json!({ "duration": 0.1 });
        spec["control"]["law"] = json!("exact");
    });
    assert_eq!(exact["measured_chatter"], json!([]), "it switches nothing");
}

#[test]
fn convergence_is_the_last_instant_outside() {
    let short = simulated(|spec| spec["simulation"] = json!({ "duration": 0.05 }));
    assert_eq!(short["exact"]["convergence_time"], Value::Null, "still 0.2 rad away");
    let quiet = simulated(|spec| {
        spec["simulation"] = json!({ "duration": 0.5 });
        spec["control"]["initial_error"] = json!({});
    });
    assert_eq!(quiet["exact"]["convergence_time"], 0.0, "never away");
    let whole = simulated(|_| {});
    let time = whole["exact"]["convergence_time"].as_f64().expect("it converges");
    assert!(
        time > 0.1 && (time / 0.01 - (time / 0.01).round()).abs() < 1e-9,
        "an instant of control: {time}"
    );
    // One more period and the run ends inside; none and it still ends outside.
    let ended = |duration: f64| simulated(|spec| spec["simulation"] = json!({ "duration": duration }));
    assert_eq!(ended(time)["exact"]["convergence_time"], Value::Null);
    assert_eq!(ended(time + 0.01)["exact"]["convergence_time"], time);
}

#[test]
fn simulate_needs_a_law_and_draws_a_plot() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut spec = value("arm3_xi2");
    spec["simulation"] = json!({ "duration": 0.2 });
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    let plot = folder.path().join("plots/arm.svg");
    let mut command = gramforge();
    finish(command.arg("simulate").arg(&path).arg("--plot").arg(&plot)).expect(0);
    assert!(fs::read_to_string(&plot).expect("a plot").starts_with("<svg"));
    spec.as_object_mut().expect("an object").remove("control");
    fs::write(&path, spec.to_string()).expect("written");
    let refused = run(["simulate", &text(&path)]).expect(2);
    assert!(refused.stderr.contains("control: is missing") && refused.stderr.contains("; add `control`"));
}

#[test]
fn the_demonstration_runs_where_it_may_write() {
    let folder = tempfile::tempdir().expect("a folder");
    let shown = finish(gramforge().current_dir(&folder)).expect(0);
    assert!(shown.stdout.contains("The report's claims"), "{shown:#?}");
    assert_eq!(shown.stderr, "");
    assert!(folder.path().join("target/gramforge/arm3.rs").exists());
}
