//! Damaged specifications.

use serde_json::Value;

/// A small arm with every section, so that most of a mutant's time goes into checks.
const SPEC: &str = r#"{
  "name": "arm",
  "arm": { "gravity": [0.0, 0.0, -9.81], "dh": { "convention": "modified", "links": [
    { "joint": "revolute", "alpha": 1.5, "a": 0.1, "d": 0.5, "theta": 0.2, "mass": 5.5,
      "first_moment": [0.0, -0.6, 0.0], "pseudo_inertia": { "xx": 0.1, "yy": 0.2, "zz": 0.1, "xy": 0.01 },
      "motor": { "inertia": 0.001, "gear_ratio": 50.0, "coulomb_friction": [0.4, -0.3] },
      "limits": { "position": [-3.0, 3.0], "velocity": 4.0, "acceleration": 9.0, "torque": 900.0 } },
    { "joint": "prismatic", "alpha": 0.3, "a": 0.5, "d": 0.1, "mass": 4.0, "com": [-0.1, 0.0, 0.2],
      "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 }, "armature": 0.3, "viscous_friction": 1.0,
      "coulomb_friction": 0.2, "limits": { "position": [-2.0, 2.0], "velocity": 3.0, "acceleration": 6.0 } } ] },
    "payload": { "mass": 1.0, "com": [0.0, 0.0, 0.1], "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 } } },
  "motion": MOTION,
  "measure": { "tube": { "position_error": [0.2, 0.1] } },
  "model": { "shared": { "functions": 2 } },
  "control": { "law": "report", "period": 0.005, "W": [[40.0, 1.0], [1.0, 30.0]], "Pqq": [0.5, 0.25], "Omega": 1.0,
    "boundary_layer": 0.05, "initial_error": { "position": 0.2, "velocity": [0.0, 0.1] },
    "compensate_coulomb": true, "on_fault": "gravity" },
  "simulation": { "duration": 1.0, "substeps": 4 }
}"#;

const MOTIONS: [&str; 3] = [
    r#"{ "quintic": { "from": [0.0, 0.3], "to": [1.5, 1.2], "duration": 5.0 } }"#,
    r#"{ "waypoints": { "times": [0.0, 1.0, 2.5], "positions": [[0.0, 0.3], [0.5, 0.4], [0.2, 0.1]] } }"#,
    r#"{ "sinusoids": { "offset": [0.1, 0.2], "duration": 3.0,
      "terms": [[{ "amplitude": 0.5, "frequency": 2.0, "phase": 0.1 }], []] } }"#,
];

/// Another arm in the other convention, of three joints, with a motion from a file.
const THREE: &str = r#"{
  "name": "three",
  "arm": { "dh": { "convention": "standard", "links": [
    { "joint": "revolute", "alpha": 1.5707963267948966, "a": 0.0, "d": 0.5, "mass": 5.5, "com": [0.0, -0.1, 0.0],
      "inertia": { "xx": 0.2, "yy": 0.1, "zz": 0.2 }, "armature": 0.8,
      "limits": { "position": [-3.0, 3.0], "velocity": 4.0, "acceleration": 9.0 } },
    { "joint": "revolute", "alpha": 0.0, "a": 0.5, "d": 0.0, "mass": 4.0, "com": [-0.2, 0.0, 0.0],
      "inertia": { "xx": 0.01, "yy": 0.1, "zz": 0.1 }, "armature": 0.8,
      "limits": { "position": [-3.0, 3.0], "velocity": 4.0, "acceleration": 9.0 } },
    { "joint": "revolute", "alpha": 0.0, "a": 0.4, "d": 0.0, "mass": 2.0, "com": [-0.2, 0.0, 0.0],
      "inertia": { "xx": 0.01, "yy": 0.05, "zz": 0.05 }, "armature": 0.3,
      "limits": { "position": [-3.0, 3.0], "velocity": 4.0, "acceleration": 9.0 } } ] } },
  "motion": { "csv": { "file": "motion.csv" } },
  "measure": { "tube": { "position_error": 0.1 } },
  "model": { "shared": { "functions": 3 } },
  "control": { "law": "report", "period": 0.001, "W": 40.0, "Pqq": 1.0, "Omega": 4.0, "boundary_layer": 0.05,
    "initial_error": { "position": 0.001 } }
}"#;

/// The file that it names.
pub const CSV: &str = "t,q1,q2,q3\n0,0,0.3,-1.2\n0.5,0.1,0.35,-1.25\n1.2,0.3,0.4,-1.3\n2,0.35,0.4,-1.3\n";

/// Other values of the fields of any of them, of which a mutant takes some before it is damaged: what belongs together.
const VARIANTS: [&[(&str, &str)]; 24] = [
    &[("/model", r#""exact""#)],
    &[("/model", r#""auto""#)],
    &[("/model", r#"{ "tolerance": { "torque": 0.05 } }"#)],
    &[("/model", r#"{ "separate": { "functions": 2 } }"#)],
    &[("/dictionary", r#""product""#)],
    &[("/dictionary", r#""union""#)],
    &[("/refit", r#""least_squares""#)],
    &[("/measure", r#""workspace""#)],
    &[("/measure", r#""trajectory""#)],
    &[("/arm/round_angles", "0.01")],
    &[("/emit", r#"{ "trig": "polynomial" }"#)],
    &[("/emit", r#"{ "trig": "std" }"#)],
    &[("/emit", r#"{ "trig": { "table": { "error": 1e-4 } } }"#)],
    &[("/control/law", r#""tight""#)],
    &[("/control/law", r#""exact""#)],
    &[("/control/uncertainty", UNCERTAIN), ("/control/law", r#""adaptive""#)],
    &[("/control/uncertainty", UNCERTAIN)],
    &[
        ("/control/uncertainty", UNCERTAIN),
        ("/control/law", r#""adaptive""#),
        ("/control/adaptation", r#"{ "parameters": "all", "Ptheta": 2.0 }"#),
    ],
    &[("/control/uncertainty", r#"{ "viscous_friction": [null, [0.0, 1.1]] }"#)],
    &[("/control/coriolis_term", r#""switching""#)],
    &[("/control/boundary_layer", "null")],
    &[
        ("/control/period", "null"),
        ("/control/W", "null"),
        ("/control/Pqq", "null"),
        ("/control/Omega", "null"),
        ("/control/boundary_layer", "null"),
        ("/control/initial_error", r#"{ "position": 0.001 }"#),
        ("/control/design", r#"{ "convergence_time": 2.0, "period": 0.001 }"#),
    ],
    &[("/control/on_fault", r#""zero""#), ("/simulation", r#"{ "duration": 0.5 }"#)],
    &[("/arm/payload", r#"{ "mass": 0.5 }"#)],
];

/// About the second joint, whatever its arm carries.
const UNCERTAIN: &str = r#"{ "links": [{ "joint": "joint2", "mass": [3.9, 5.1] }] }"#;

/// What a token is replaced with.
const REPLACEMENTS: [&str; 24] = [
    "0.5",
    "2",
    "0.01",
    "1e-3",
    "3.14159",
    "1.5707963267948966",
    "10",
    "-0.3",
    "0",
    "-1",
    "1e300",
    "-1e300",
    "1e-300",
    "1e154",
    "1e40",
    "1e18",
    "1e-18",
    "4294967295",
    "null",
    "true",
    "\"x\"",
    "[]",
    "{}",
    "[1, 2]",
];

/// Steele and Vigna's splitmix64: the same mutants everywhere.
pub struct Dice(pub u64);

impl Dice {
    /// Less than `sides`.
    pub fn below(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % sides as u64) as usize
    }
}

/// Names, numbers, words and punctuation of a JSON text.
pub fn tokens(text: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut inside = false;
    let mut fresh = true;
    for c in text.chars() {
        let quote = c == '"';
        let alone = !inside && (c.is_whitespace() || "{}[]:,".contains(c));
        if alone || fresh || (quote && !inside) {
            out.push(String::new());
        }
        if let Some(last) = out.last_mut() {
            last.push(c);
        }
        fresh = alone || (quote && inside);
        inside ^= quote;
    }
    out.retain(|token| !token.trim().is_empty());
    out
}

fn is_value(token: &str) -> bool {
    token.parse::<f64>().is_ok() || token == "true"
}

/// Base number `number`: the arm of two joints with each of the motions, and the arm of three.
pub fn base(number: usize) -> Value {
    let text = match MOTIONS.get(number % (MOTIONS.len() + 1)) {
        Some(motion) => SPEC.replace("MOTION", motion),
        None => THREE.to_string(),
    };
    serde_json::from_str(&text).expect("JSON")
}

/// Number of bases.
pub const BASES: usize = MOTIONS.len() + 1;

/// The variants.
pub fn variants() -> usize {
    VARIANTS.len()
}

/// `spec` with the values of variant `number`.
pub fn varied(mut spec: Value, number: usize) -> Value {
    for (pointer, text) in VARIANTS[number] {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = spec.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
        match serde_json::from_str(text).expect("JSON") {
            Value::Null => drop(parent.remove(key)),
            value => drop(parent.insert(key.to_string(), value)),
        }
    }
    spec
}

/// A base with some of its other values.
fn variant(dice: &mut Dice, number: usize) -> String {
    let count = dice.below(3);
    (0..count).fold(base(number), |spec, _| varied(spec, dice.below(VARIANTS.len()))).to_string()
}

/// Specification number `number`, damaged.
pub fn mutant(number: usize) -> String {
    let mut dice = Dice(number as u64);
    let mut tokens = tokens(&variant(&mut dice, number));
    for _ in 0..=dice.below(2) {
        let at = dice.below(tokens.len());
        let values: Vec<usize> = (0..tokens.len()).filter(|&i| is_value(&tokens[i])).collect();
        match dice.below(24) {
            0 => drop(tokens.remove(at)),
            1 => tokens.insert(at, tokens[at].clone()),
            2 => tokens[at] = REPLACEMENTS[dice.below(REPLACEMENTS.len())].to_string(),
            // Most changes that get past the parser are of numbers.
            _ => {
                tokens[values[dice.below(values.len())]] = REPLACEMENTS[dice.below(REPLACEMENTS.len())].into()
            }
        }
    }
    tokens.join(" ")
}
