//! Damaged specifications.

use serde_json::Value;

/// A small arm with every section, so that most of a mutant's time goes into checks.
pub const SPEC: &str = r#"{
  "name": "arm",
  "arm": { "gravity": [0.0, 0.0, -9.81], "dh": { "convention": "modified", "links": [
    { "joint": "revolute", "alpha": 1.5, "a": 0.1, "d": 0.5, "theta": 0.2, "mass": 5.5,
      "first_moment": [0.0, -0.6, 0.0], "pseudo_inertia": { "xx": 0.1, "yy": 0.2, "zz": 0.1, "xy": 0.01 },
      "motor": { "inertia": 0.001, "gear_ratio": 50.0, "coulomb_friction": [0.4, -0.3] },
      "limits": { "position": [-3.0, 3.0], "velocity": 4.0, "acceleration": 9.0, "torque": 90.0 } },
    { "joint": "prismatic", "alpha": 0.3, "a": 0.5, "d": 0.1, "mass": 4.0, "com": [-0.1, 0.0, 0.2],
      "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 }, "armature": 0.3, "viscous_friction": 1.0,
      "coulomb_friction": 0.2, "limits": { "position": [-2.0, 2.0] } } ] },
    "payload": { "mass": 1.0, "com": [0.0, 0.0, 0.1], "inertia": { "xx": 0.1, "yy": 0.1, "zz": 0.1 } } },
  "motion": MOTION,
  "measure": { "tube": { "position_error": [0.2, 0.1] } },
  "model": { "shared": { "functions": 2 } },
  "control": { "law": "report", "period": 0.005, "W": [[40.0, 1.0], [1.0, 30.0]], "Pqq": [0.5, 0.25], "Omega": 1.0,
    "boundary_layer": 0.05, "initial_error": { "position": 0.2, "velocity": [0.0, 0.1] },
    "compensate_coulomb": true, "on_fault": "gravity" },
  "simulation": { "duration": 1.0, "substeps": 4 }
}"#;

pub const MOTIONS: [&str; 3] = [
    r#"{ "quintic": { "from": [0.0, 0.3], "to": [1.5, 1.2], "duration": 5.0 } }"#,
    r#"{ "waypoints": { "times": [0.0, 1.0, 2.5], "positions": [[0.0, 0.3], [0.5, 0.4], [0.2, 0.1]] } }"#,
    r#"{ "sinusoids": { "offset": [0.1, 0.2], "duration": 3.0,
      "terms": [[{ "amplitude": 0.5, "frequency": 2.0, "phase": 0.1 }], []] } }"#,
];

/// Other values of its fields, of which a mutant takes some before it is damaged.
const VARIANTS: [(&str, &str); 20] = [
    ("/model", r#""exact""#),
    ("/model", r#""auto""#),
    ("/model", r#"{ "tolerance": { "torque": 0.05 } }"#),
    ("/model", r#"{ "separate": { "functions": 2 } }"#),
    ("/dictionary", r#""product""#),
    ("/dictionary", r#""union""#),
    ("/refit", r#""least_squares""#),
    ("/measure", r#""workspace""#),
    ("/measure", r#""trajectory""#),
    ("/arm/round_angles", "0.01"),
    ("/emit", r#"{ "trig": "polynomial" }"#),
    ("/emit", r#"{ "trig": { "table": { "error": 1e-4 } } }"#),
    ("/control/law", r#""tight""#),
    ("/control/law", r#""exact""#),
    ("/control/law", r#""adaptive""#),
    ("/control/uncertainty", r#"{ "links": [{ "joint": "joint2", "mass": [3.9, 4.1] }] }"#),
    (
        "/control/uncertainty",
        r#"{ "payload": { "mass": [0.8, 1.2] }, "viscous_friction": { "joint2": [0.9, 1.1] } }"#,
    ),
    ("/control/coriolis_term", r#""switching""#),
    ("/control/boundary_layer", "null"),
    ("/control/require_guarantee", "true"),
];

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

/// The specification with `motion` and some of its other values.
fn variant(dice: &mut Dice, motion: &str) -> String {
    let mut spec: Value = serde_json::from_str(&SPEC.replace("MOTION", motion)).expect("JSON");
    for _ in 0..dice.below(4) {
        let (pointer, text) = VARIANTS[dice.below(VARIANTS.len())];
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = spec.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
        match serde_json::from_str(text).expect("JSON") {
            Value::Null => drop(parent.remove(key)),
            value => drop(parent.insert(key.to_string(), value)),
        }
    }
    spec.to_string()
}

/// Specification number `number`, damaged.
pub fn mutant(number: usize) -> String {
    let mut dice = Dice(number as u64);
    let mut tokens = tokens(&variant(&mut dice, MOTIONS[number % MOTIONS.len()]));
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
