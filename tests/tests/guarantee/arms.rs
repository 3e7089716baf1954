//! Cases: arms of `data/truth/` with drives and gains like those of their makers, along a quintic about a home position.

use std::path::PathBuf;

use gramforge::Generation;
use gramforge::load::parse;
use gramforge_tests::chain::{Chain, Link};
use nalgebra::DMatrix;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
struct File {
    joints: Vec<JointFile>,
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "the keys of the files")]
struct JointFile {
    r#type: String,
    axis: [f64; 3],
    parent: usize,
    R: [[f64; 3]; 3],
    p: [f64; 3],
    mass: f64,
    com: [f64; 3],
    I_com: [[f64; 3]; 3],
}

/// An arm, its home position and the inertia of its rotors.
struct Drives {
    home: &'static [f64],
    armature: &'static [f64],
}

/// A loop whose guarantee is attacked.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub name: &'static str,
    pub arm: &'static str,
    pub armature: bool,
    pub law: &'static str,
    /// Tolerance of the model's torque, as a part of the largest; 0 for the exact model.
    pub tolerance: f64,
    /// Largest initial position error of each joint, rad; m for a sliding joint.
    pub initial: f64,
    pub period: f64,
    pub duration: f64,
    pub amplitude: f64,
    pub tube: f64,
    pub settle: f64,
    /// The uncertain part of the last link's mass.
    pub payload: f64,
}

/// The three-link arm with its exact model, from which other cases differ in some fields.
pub const PLAIN: Case = Case {
    name: "threedof exact",
    arm: "threedof",
    armature: true,
    law: "exact",
    tolerance: 0.0,
    initial: 0.01,
    period: 1e-3,
    duration: 3.0,
    amplitude: 0.5,
    tube: 0.05,
    settle: 2.0,
    payload: 0.0,
};

/// A motion three times as fast, twice as far.
pub const FAST: Case = Case { duration: 1.0, amplitude: 1.0, tube: 0.1, settle: 1.5, ..PLAIN };

fn drives(arm: &str) -> Drives {
    let (home, armature): (&[f64], &[f64]) = match arm {
        "threedof" => (&[0.0, 0.3, -1.2], &[0.8, 0.8, 0.3]),
        "puma560" => (&[0.0, 0.6, -0.6, 0.0, 0.6, 0.0], &[1.14, 4.7, 0.83, 0.20, 0.18, 0.19]),
        "stanford" => (&[0.0, -0.9, 0.5, 0.0, 0.8, 0.0], &[0.95, 2.2, 0.8, 0.1, 0.1, 0.05]),
        "ur5" => (&[0.0, -1.2, 1.4, -1.6, -1.5, 0.0], &[1.0, 1.0, 0.6, 0.1, 0.1, 0.1]),
        "panda" => (&[0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.5], &[0.6, 0.6, 0.5, 0.5, 0.2, 0.2, 0.15]),
        other => panic!("no arm {other}"),
    };
    Drives { home, armature }
}

/// The chain of an arm of `data/truth/`, with rotors or without.
pub fn chain(arm: &str, armature: bool) -> Chain {
    let path = gramforge_tests::spec("arm").with_file_name("truth").join(format!("{arm}.json"));
    let text = std::fs::read_to_string(&path).unwrap();
    let file: File = serde_json::from_str(&text).unwrap();
    let rotors = drives(arm).armature;
    let link = |(i, joint): (usize, &JointFile)| {
        assert_eq!(joint.parent, i, "{arm} is a chain");
        let [x, y, z] = joint.I_com;
        Link {
            prismatic: joint.r#type == "P",
            xyz: joint.p,
            rpy: angles(&joint.R),
            axis: joint.axis,
            mass: joint.mass,
            com: joint.com,
            com_rpy: [0.0; 3],
            inertia: [x[0], y[1], z[2], x[1], x[2], y[2]],
            armature: if armature { rotors[i] } else { 0.0 },
            follows: (i, 1.0, 0.0),
        }
    };
    Chain { links: file.joints.iter().enumerate().map(link).collect(), gravity: [0.0, 0.0, -9.81] }
}

/// Roll, pitch and yaw of a rotation.
fn angles(r: &[[f64; 3]; 3]) -> [f64; 3] {
    let pitch = (-r[2][0]).clamp(-1.0, 1.0).asin();
    if pitch.cos() > 1e-9 {
        [r[2][1].atan2(r[2][2]), pitch, r[1][0].atan2(r[0][0])]
    } else {
        [(-r[1][2]).atan2(r[1][1]), pitch, 0.0]
    }
}

impl Case {
    pub fn chain(&self) -> Chain {
        chain(self.arm, self.armature)
    }

    /// The arms at the ends of the uncertain mass; one if there is none.
    pub fn family(&self) -> Vec<Chain> {
        let ends: &[f64] = if self.payload == 0.0 { &[0.0] } else { &[-1.0, 1.0] };
        let with = |end: &f64| {
            let mut chain = self.chain();
            if let Some(last) = chain.links.last_mut() {
                last.mass *= 1.0 + end * self.payload;
            }
            chain
        };
        ends.iter().map(with).collect()
    }

    /// The specification. K is 100/s times the inertia that a joint moves at home while the others are free.
    pub fn spec(&self) -> Value {
        let (chain, home) = (self.chain(), drives(self.arm).home);
        let n = home.len();
        let rows = chain.mass_matrix(home);
        let mobility = DMatrix::from_fn(n, n, |i, j| rows[i][j]).try_inverse().unwrap();
        let damping: Vec<f64> = (0..n).map(|i| 100.0 / mobility[(i, i)]).collect();
        let scaled = |by: f64| damping.iter().map(|k| by * k).collect::<Vec<f64>>();
        let away = |i: usize| {
            let most = self.amplitude * if chain.links[i].prismatic { 0.3 } else { 1.0 };
            if i.is_multiple_of(2) { 0.5 * most } else { -0.5 * most }
        };
        let [from, to] = [-1.0, 1.0].map(|s| (0..n).map(|i| home[i] + s * away(i)).collect::<Vec<f64>>());
        let joints: serde_json::Map<String, Value> = chain
            .links
            .iter()
            .enumerate()
            .map(|(i, link)| {
                let limits = json!({ "velocity": 50.0, "acceleration": 500.0 });
                (format!("j{}", i + 1), json!({ "armature": link.armature, "limits": limits }))
            })
            .collect();
        let model = match self.tolerance {
            0.0 => json!("exact"),
            tolerance => json!({ "tolerance": { "torque": tolerance } }),
        };
        let mut spec = json!({
            "name": "attacked",
            "arm": { "urdf": "arm.urdf", "joints": joints },
            "motion": { "quintic": { "from": from, "to": to, "duration": self.duration } },
            "measure": { "tube": { "position_error": self.tube } },
            "model": model,
            "control": {
                "law": self.law, "period": self.period, "settle": self.settle,
                "W": scaled(0.75), "Pqq": scaled(1.25), "Omega": scaled(6.25),
                "initial_error": { "position": self.initial }
            }
        });
        if self.law != "exact" {
            spec["control"]["boundary_layer"] = json!(0.05);
        }
        if self.payload != 0.0 {
            let (mass, com) = (chain.links[n - 1].mass, chain.links[n - 1].com);
            let range = [mass * (1.0 - self.payload), mass * (1.0 + self.payload)];
            let link = json!({ "joint": format!("j{n}"), "mass": range, "at": com });
            spec["control"]["uncertainty"] = json!({ "links": [link] });
        }
        spec
    }

    /// A folder with the arm, and all stages of the specification after `edit`, or the message that refuses it.
    pub fn made(&self, edit: impl FnOnce(&mut Value)) -> Result<Generation, String> {
        let (_folder, path, value) = self.written(edit);
        let loaded = parse(&value.to_string(), &path).map_err(|error| error.to_string())?;
        Generation::new(loaded).map_err(|error| error.to_string())
    }

    /// The files of the specification after `edit`, in a folder that lives as long as the first part of the answer.
    pub fn written(&self, edit: impl FnOnce(&mut Value)) -> (tempfile::TempDir, PathBuf, Value) {
        let folder = tempfile::tempdir().unwrap();
        let wide = "lower=\"-7\" upper=\"7\" effort=\"100000\" velocity=\"50\"";
        let urdf = self.chain().urdf();
        let narrow = "lower=\"-2\" upper=\"2\" effort=\"500\" velocity=\"3\"";
        assert!(urdf.contains(narrow));
        std::fs::write(folder.path().join("arm.urdf"), urdf.replace(narrow, wide)).unwrap();
        let mut value = self.spec();
        edit(&mut value);
        let path = folder.path().join("attacked.json");
        std::fs::write(&path, value.to_string()).unwrap();
        (folder, path, value)
    }
}
