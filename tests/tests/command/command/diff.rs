//! `gramforge diff`: specifications, modules and sizes, exit codes and refusals.

use std::fs;

use crate::common::{Outcome, committed, finish, gramforge, root, text};

fn diff(arguments: &[&str]) -> Outcome {
    finish(gramforge().arg("diff").args(arguments))
}

/// A committed module.
fn module(name: &str) -> String {
    text(&root().join("generated/src").join(name).with_extension("rs"))
}

#[test]
fn specifications_and_their_modules_differ_alike() {
    let names = ["arm3_xi1", "arm3_xi2"];
    let specs = names.map(|name| text(&committed(name)));
    let modules = names.map(module);
    let [mut of_specs, mut of_modules] = [&specs, &modules].map(|[a, b]| diff(&[a, b, "--json"]).json());
    assert_eq!(of_specs["psi_added"].as_array().map(Vec::len), Some(1));
    for view in [&mut of_specs, &mut of_modules] {
        // The files are called otherwise, and the header of the difference names them.
        view["names"].take();
        let source = view["source"].as_str().expect("a text").to_string();
        view["source"] = source.split_once("@@").expect("a change").1.into();
    }
    assert_eq!(of_specs, of_modules);
}

#[test]
fn sizes_of_one_specification_differ_in_functions_numbers_and_source() {
    let spec = text(&committed("arm3_xi2"));
    let view = diff(&[&spec, "--sizes", "xi2,xi3", "--json"]).json();
    assert_eq!(view["psi_removed"].as_array().map(Vec::len), Some(0));
    let share = view["psi_added"][0][1].as_f64().expect("a share");
    assert!(share > 0.0 && share < 1.0, "{share}");
    let groups: Vec<&str> =
        view["numbers"].as_array().expect("groups").iter().filter_map(|g| g["group"].as_str()).collect();
    assert!(groups.starts_with(&["parameters", "bounds"]), "{groups:?}");
    let inspected = finish(gramforge().args(["inspect", &spec, "--json"])).json();
    assert_eq!(view["torque_error"][0], inspected["torque_error"]);
    assert_eq!(view["guarantee"][0], inspected["guarantee"]["kind"]);
    assert_eq!(view["operations"][0], inspected["step_operations"]["reduced"]);

    let shown = diff(&[&spec, "--sizes", "xi2,xi3"]).expect(0).stdout;
    let source = shown.find("\n--- xi 2\n+++ xi 3\n@@").expect("the source");
    assert!(shown[..source].lines().all(|line| line.chars().count() <= 80), "{shown}");
}

#[test]
fn the_exit_code_says_whether_they_differ_where_that_is_asked() {
    let [one, two] = ["arm3_xi1", "arm3_xi2"].map(module);
    diff(&[&one, &two]).expect(0);
    let differ = diff(&[&one, &two, "--exit-code"]);
    assert!(differ.code == Some(1) && differ.stdout.contains("+++ "), "{differ:#?}");
    let same = diff(&[&one, &one, "--exit-code"]).expect(0);
    assert_eq!(same.stdout, "The modules are the same, byte for byte.\n");
}

#[test]
fn what_is_no_module_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("main.rs");
    fs::write(&file, "fn main() {}\n").expect("written");
    let (file, spec) = (text(&file), text(&committed("arm3_xi2")));
    let cases: [(&[&str], &str); 6] = [
        (&[&file, &spec], "has no line `// gramforge: …`"),
        (&["nowhere.rs", "nowhere.json"], "nowhere.json: cannot be read"),
        (&["nowhere.rs", "nowhere.json"], "nowhere.rs: cannot be read"),
        (&[&spec], "name one module to compare; name a second one"),
        (&[&spec, "--sizes", "exact"], "names 1 sizes"),
        (&[&spec, "--sizes", "exact,xi99"], "has 11 functions"),
    ];
    for (arguments, words) in cases {
        let refused = diff(arguments).expect(2);
        assert!(refused.stderr.contains(words), "{words}: {refused:#?}");
    }
}
