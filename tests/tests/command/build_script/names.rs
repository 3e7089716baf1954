//! Names that collide with something, and modules of every kind: refused with a clear message, or accepted by the
//! compiler and by clippy without a warning.

use gramforge::internals::check::{Extent, checked};
use gramforge::load::parse;
use serde_json::{Value, json};

use super::package::{Package, urdf, value};

/// Constants that modules hold, words of the prelude, devices of Windows, keywords, and what looks like them.
const NAMES: [&str; 44] = [
    "none",
    "some",
    "ok",
    "err",
    "option",
    "result",
    "self_",
    "self",
    "default",
    "clone",
    "copy",
    "debug",
    "eq",
    "partial_eq",
    "box",
    "vec",
    "model",
    "bounds",
    "core",
    "std",
    "alloc",
    "gramforge_runtime",
    "f64",
    "usize",
    "str",
    "l_a_w",
    "p_s_i",
    "b_o_u_n_d_s",
    "j_o_i_n_t_s",
    "s_i_n_e_s",
    "s_e_t_t_i_n_g_s",
    "r_e_f_e_r_e_n_c_e",
    "f_u_n_c_t_i_o_n_s",
    "g_u_a_r_a_n_t_e_e_d",
    "p_a_r_a_m_e_t_e_r_s",
    "controller",
    "con",
    "nul",
    "com1",
    "lib",
    "main",
    "union",
    "a__b",
    "a_",
];

/// A module of the user's, in which everything is called like something that generated code needs.
const SHADOWED: &str = r#"
#[allow(dead_code, unused_imports, clippy::all)]
mod shadowed {
    pub enum Option { Some, None }
    pub use Option::{None, Some};
    pub struct Result;
    pub struct Default;
    pub trait Model {}
    pub trait Real {}
    pub mod core {}
    pub mod gramforge_runtime {}
    include!(concat!(env!("OUT_DIR"), "/adaptive.rs"));
}
"#;

/// Two revolute joints whose torque and other limits clippy could take for a bad π.
fn arm(name: &str) -> Value {
    let link = json!({
        "joint": "revolute", "alpha": 0.3, "a": 0.314, "d": 0.0, "theta": 0.0, "mass": 3.14, "com": [0.1, 0.02, 0.03],
        "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 }, "viscous_friction": 3.14, "coulomb_friction": 2.718,
        "limits": { "position": [-3.14, 3.14], "velocity": 3.14, "acceleration": 31.4, "torque": 3.14 }
    });
    json!({
        "name": name,
        "arm": { "dh": { "convention": "standard", "links": [link, link] } },
        "motion": { "quintic": { "from": [0.1, 0.3], "to": [0.6, 0.3183], "duration": 3.14 } },
        "model": { "shared": { "functions": 2 } },
        "control": { "law": "report", "period": 0.001, "W": 31.4, "Pqq": 3.14, "Omega": 16.0, "boundary_layer": 0.0314 }
    })
}

/// Every way to take a sine, every law, motion and form of model.
fn kinds() -> Vec<Value> {
    let table = json!({ "table": { "error": 1e-3 } });
    let changes: [(&str, &[(&str, Value)]); 11] = [
        ("polynomial", &[("/emit", json!({ "trig": "polynomial" }))]),
        ("std_trig", &[("/emit", json!({ "trig": "std" }))]),
        ("table", &[("/emit", json!({ "trig": table }))]),
        ("exact_table", &[("/emit", json!({ "trig": table })), ("/model", json!("exact"))]),
        ("tight", &[("/control/law", json!("tight"))]),
        ("exact_law", &[("/control/law", json!("exact")), ("/model", json!("exact"))]),
        ("sign", &[("/control/boundary_layer", Value::Null), ("/control/coriolis_term", json!("switching"))]),
        (
            "adaptive",
            &[
                ("/control/law", json!("adaptive")),
                ("/control/uncertainty", json!({ "links": [{ "joint": "joint2", "mass": [3.0, 3.14159] }] })),
                ("/control/adaptation", json!({ "parameters": "uncertain", "Ptheta": 3.14 })),
            ],
        ),
        (
            "sinusoids",
            &[(
                "/motion",
                json!({ "sinusoids": { "offset": [0.314, 0.1], "duration": 3.14, "terms": [
                    [{ "amplitude": 0.314, "frequency": 3.14, "phase": 3.14 }], [] ] } }),
            )],
        ),
        (
            "waypoints",
            &[(
                "/motion",
                json!({ "waypoints": { "times": [0.0, 1.0, 3.14], "positions": [[0.0, 0.3], [0.314, 0.4], [0.2, 0.1]] } }),
            )],
        ),
        ("tolerance", &[("/model", json!({ "tolerance": { "torque": 0.05 } }))]),
    ];
    let mut out = Vec::new();
    for (name, edits) in changes {
        let mut spec = arm(name);
        for (pointer, new) in edits {
            let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
            let parent = spec.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
            match new {
                Value::Null => drop(parent.remove(key)),
                new => drop(parent.insert(key.to_string(), new.clone())),
            }
        }
        out.push(spec);
    }
    out
}

/// The message where the name is refused.
fn refusal(spec: &Value) -> Option<String> {
    let loaded = parse(&spec.to_string(), std::path::Path::new("arm.json"));
    loaded.and_then(|loaded| checked(loaded, Extent::Whole)).err().map(|error| error.to_string())
}

#[test]
fn every_name_is_refused_clearly_or_compiles_without_a_warning() {
    let package = Package::new("gramforge-scratch-names");
    package.write("specs/arm.urdf", &urdf("joint1", "link1", 1.0));
    let (mut specs, mut modules) = (Vec::new(), Vec::new());
    let mut refused = Vec::new();
    for name in NAMES {
        let mut spec = arm(name);
        // The quickest; the other kinds follow below.
        spec["model"] = json!("exact");
        spec["control"]["law"] = json!("exact");
        if let Some(message) = refusal(&spec) {
            let clear = message.lines().count() == 1 && message.contains(&format!("name: is {name:?}"));
            assert!(clear && message.contains("; "), "{name}: {message}");
            refused.push(name);
        } else {
            modules.push(name.to_string());
            specs.push(spec);
        }
    }
    assert_eq!(refused, ["self", "box", "con", "nul", "com1", "lib", "main", "a__b"]);
    for spec in kinds() {
        modules.push(spec["name"].as_str().expect("a name").to_string());
        specs.push(spec);
    }
    specs.push(value("urdf_arm", "arm.urdf", 0.00314));
    modules.push("urdf_arm".to_string());
    let files: Vec<String> = modules.iter().map(|name| format!("specs/{name}.json")).collect();
    for (file, spec) in files.iter().zip(&specs) {
        package.write(file, &spec.to_string());
    }
    package.specs(&files.iter().map(String::as_str).collect::<Vec<_>>());
    // Each in a module of its own name, as users do, of which nothing is used.
    let names: Vec<&str> = modules.iter().map(String::as_str).collect();
    package.modules(&names);
    let main = std::fs::read_to_string(package.path("src/main.rs")).expect("readable");
    let (head, _) = main.split_once("fn main").expect("a main");
    package.write(
        "src/main.rs",
        &format!("{}{SHADOWED}fn main() {{}}\n", head.replace("include!", "::core::include!")),
    );
    package.cargo(&["clippy", "--quiet", "--", "-D", "warnings"]).good();
}
