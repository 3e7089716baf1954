//! `gramforge evaluate`: D, C, G, h and τ at given states.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

use super::progress::modelled;
use super::{json, show_warnings};
use crate::arm::Arm;
use crate::error::{Diagnostics, Error};
use crate::graph::Graph;
use crate::load::read_text;
use crate::pipeline::Generation;
use crate::torque::matrices;

/// Evaluates the model at states from a file.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: gramforge evaluate ur5.jsonc --states states.json --model reduced\nwith states.json: [{ \"q\": [0, 0, 0, 0, 0, 0], \"qd\": [0, 0, 0, 0, 0, 0] }]"
)]
pub(super) struct Evaluate {
    /// The specification file.
    spec: PathBuf,
    /// A JSON array of objects {q, qd, qdd}: rad, rad/s, rad/s² (m, m/s, m/s² for prismatic joints).
    #[arg(long)]
    states: PathBuf,
    /// Which model.
    #[arg(long, value_enum, default_value_t = Which::Exact)]
    model: Which,
    /// Add viscous and Coulomb friction to tau.
    #[arg(long)]
    friction: bool,
    /// Print JSON.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    Exact,
    Reduced,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    q: Vec<f64>,
    #[serde(default)]
    qd: Vec<f64>,
    #[serde(default)]
    qdd: Vec<f64>,
}

#[derive(Debug, Serialize)]
#[allow(non_snake_case, reason = "the report's letters are the keys")]
struct Evaluation {
    D: Vec<Vec<f64>>,
    C: Vec<Vec<f64>>,
    G: Vec<f64>,
    H: Vec<Vec<Vec<f64>>>,
    tau: Vec<f64>,
}

impl Evaluation {
    fn is_finite(&self) -> bool {
        let rows = self.D.iter().chain(&self.C).chain(self.H.iter().flatten()).chain([&self.G, &self.tau]);
        rows.flatten().all(|v| v.is_finite())
    }
}

impl Evaluate {
    pub(super) fn run(&self) -> Result<String, Error> {
        let generation = modelled(&self.spec)?;
        show_warnings(generation.warnings());
        let states = read(&self.states, generation.arm().dof())?;
        let evaluations: Vec<Evaluation> =
            states.iter().map(|state| self.evaluate(&generation, state)).collect();
        let mut faults = Diagnostics::of(&self.states);
        for (index, _) in evaluations.iter().enumerate().filter(|(_, e)| !e.is_finite()) {
            faults.push(
                format!("[{index}]"),
                "overflows",
                "write positions, speeds and accelerations in SI units",
            );
        }
        let evaluations = faults.finish(evaluations)?;
        if self.json { json(&evaluations) } else { Ok(text(&evaluations)) }
    }

    fn evaluate(&self, generation: &Generation, state: &State) -> Evaluation {
        let code = match self.model {
            Which::Exact => generation.exact_code(),
            Which::Reduced => generation.code(),
        };
        evaluation(generation.arm(), code, state, self.friction)
    }
}

/// Everything comes from the graph `code` that is emitted, or would be for the exact model.
fn evaluation(arm: &Arm, code: &Graph, state: &State, friction: bool) -> Evaluation {
    let values = matrices(code, arm.dof(), &state.q);
    let coriolis = values.coriolis(&state.qd);
    let mut tau = code.interpret(&state.q, &state.qd, &state.qd, &state.qdd);
    if friction {
        for ((tau, joint), &qd) in tau.iter_mut().zip(&arm.joints).zip(&state.qd) {
            let [forwards, backwards] = joint.coulomb_friction;
            let coulomb = if qd > 0.0 {
                forwards
            } else if qd < 0.0 {
                backwards
            } else {
                0.0
            };
            *tau += joint.viscous_friction * qd + coulomb;
        }
    }
    Evaluation { D: values.mass_matrix, C: coriolis, G: values.gravity, H: values.christoffel, tau }
}

fn read(path: &Path, dof: usize) -> Result<Vec<State>, Error> {
    let wanted = "give a JSON array of objects {\"q\": […], \"qd\": […], \"qdd\": […]}";
    let text = read_text(path)
        .map_err(|error| Error::input(path, "", format!("cannot be read ({error})"), wanted))?;
    let mut states: Vec<State> = serde_json::from_str(&text)
        .map_err(|error| Error::input(path, "", format!("is not a list of states ({error})"), wanted))?;
    let mut faults = Diagnostics::of(path);
    for (index, state) in states.iter_mut().enumerate() {
        for (name, list) in [("q", &mut state.q), ("qd", &mut state.qd), ("qdd", &mut state.qdd)] {
            // Velocities and accelerations left out are zero.
            if list.is_empty() && name != "q" {
                *list = vec![0.0; dof];
            }
            if list.len() != dof {
                let problem = format!("has {} entries", list.len());
                faults.push(format!("[{index}].{name}"), problem, format!("write {dof}, one for each joint"));
            }
        }
    }
    faults.finish(states)
}

fn text(evaluations: &[Evaluation]) -> String {
    let row = |row: &Vec<f64>| row.iter().map(|x| format!("{x:>14.6e}")).collect::<Vec<_>>().join(" ");
    let mut out = String::new();
    for (index, e) in evaluations.iter().enumerate() {
        out.push_str(&format!("state {index}\n"));
        for (name, matrix) in [("D", &e.D), ("C", &e.C)] {
            for (i, entries) in (1..).zip(matrix) {
                out.push_str(&format!("  {name}{i:<3} {}\n", row(entries)));
            }
        }
        out.push_str(&format!("  G    {}\n  tau  {}\n", row(&e.G), row(&e.tau)));
    }
    out
}
