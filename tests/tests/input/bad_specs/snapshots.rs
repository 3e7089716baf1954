//! The whole text of typical refusals, each in a file of its own under `refusals/`. `UPDATE=1` writes them anew.

use std::fs;
use std::path::Path;

use serde_json::json;

use super::input::{Input, refused, urdf_joint, urdf_link};

/// A name, and what is done to a good input.
type Refusal = (&'static str, fn(&mut Input));

const REFUSALS: &[Refusal] = &[
    ("wrong_type", |i| _ = i.link(1, "mass", json!("heavy"))),
    ("missing_field", |i| _ = i.remove("/arm/dh/links/1/mass")),
    ("misspelt_field", |i| _ = i.remove("/control/period").control("perriod", json!(0.002))),
    ("unknown_variant", |i| _ = i.set("/model", json!("shard"))),
    ("two_variants", |i| _ = i.set("/motion/csv", json!({ "file": "motion.csv" }))),
    ("wrong_length", |i| _ = i.link(0, "first_moment", json!([1.0, 2.0]))),
    ("broken_json", |i| _ = i.replace("\"name\":", "\"name\"")),
    ("repeated_key", |i| _ = i.replace("\"name\":", "\"name\":\"arm\",\"name\":")),
    ("hidden_character", |i| _ = i.set("/name", json!("arm\u{202e}"))),
    ("several_faults", |i| {
        i.set("/colour", json!("red")).link(0, "mass", json!(-1.0)).remove("/arm/dh/links/2/alpha");
        i.control("W", json!([[1.0, 0.0], [0.0, true]])).set("/motion/quintic/to", json!([1.0]));
    }),
    ("unphysical_body", |i| {
        let body = json!({ "xx": 1.0, "yy": 1.0, "zz": -1.0 });
        i.link(0, "pseudo_inertia", body);
    }),
    ("table_and_urdf", |i| _ = i.set("/arm/urdf", json!("arm.urdf"))),
    ("broken_urdf", |i| _ = i.urdf("<link name=\"base\">")),
    ("unknown_joint_type", |i| {
        let joint = urdf_joint("turn", "floating", "base", "arm", "");
        i.urdf(&[urdf_link("base"), urdf_link("arm"), joint].concat());
    }),
    ("motion_too_fast", |i| _ = i.link(0, "limits", json!({ "velocity": 0.1 }))),
    ("bad_table", |i| _ = i.csv("t,q1,q2,q3\n0,0,0,0\n1,0.1,x,0.1\n0.5,0.2,0.2\n")),
    ("gains_not_definite", |i| _ = i.control("W", json!([40.0, -40.0, 10.0]))),
];

#[test]
fn typical_refusals_read_as_they_were_judged() {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/input/bad_specs/refusals");
    let update = std::env::var_os("UPDATE").is_some();
    let mut changed = Vec::new();
    for (name, spoil) in REFUSALS {
        let folder = tempfile::tempdir().expect("a folder");
        let mut input = Input::good();
        spoil(&mut input);
        let spec = input.write(folder.path(), "spec.json");
        let outcome = refused(folder.path(), &[spec]);
        let text = outcome.stderr.replace(&format!("{}/", folder.path().display()), "");
        let path = kept.join(name).with_extension("txt");
        if update {
            fs::write(&path, text).expect("written");
        } else if fs::read_to_string(&path).unwrap_or_default() != text {
            changed.push(format!("{name}:\n{text}"));
        }
    }
    assert!(
        changed.is_empty(),
        "these refusals read otherwise than in {}; if they are better, run \
         `UPDATE=1 cargo test -p gramforge-tests --test input snapshots`\n\n{}",
        kept.display(),
        changed.join("\n")
    );
}

/// A text that no test compares with would stay when its refusal is gone.
#[test]
fn every_kept_text_has_its_refusal() {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/input/bad_specs/refusals");
    let mut names: Vec<String> = fs::read_dir(kept)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let mut wanted: Vec<String> = REFUSALS.iter().map(|(name, _)| format!("{name}.txt")).collect();
    wanted.sort();
    assert_eq!(names, wanted);
}
