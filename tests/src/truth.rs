//! Reference values made by an independent program; see the `source` of each file in `data/truth/`.

use std::path::Path;

use serde::Deserialize;

/// An arm's reference values at random states.
#[derive(Clone, Debug, Deserialize)]
pub struct Truth {
    /// The states.
    pub samples: Vec<State>,
}

/// One state of an arm and what equation (1) makes of it.
#[derive(Clone, Debug, Deserialize)]
#[allow(non_snake_case, reason = "the keys of the files")]
pub struct State {
    /// q, rad or m.
    pub q: Vec<f64>,
    /// q̇.
    pub qd: Vec<f64>,
    /// q̈.
    pub qdd: Vec<f64>,
    D: Vec<Vec<f64>>,
    D_with_motor_inertia: Option<Vec<Vec<f64>>>,
    /// C in Christoffel form.
    pub C: Vec<Vec<f64>>,
    /// G.
    pub G: Vec<f64>,
    tau: Vec<f64>,
    tau_with_motor_inertia: Option<Vec<f64>>,
}

impl State {
    /// D, with rotor inertia where the arm's file gives motors, as the specifications do.
    pub fn mass_matrix(&self) -> &[Vec<f64>] {
        self.D_with_motor_inertia.as_ref().unwrap_or(&self.D)
    }

    /// D q̈ + C q̇ + G, with rotor inertia where there are motors.
    pub fn torque(&self) -> &[f64] {
        self.tau_with_motor_inertia.as_ref().unwrap_or(&self.tau)
    }
}

impl Truth {
    /// The values of `threedof`, `puma560`, `stanford`, `ur5` or `panda`.
    pub fn of(arm: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/truth").join(format!("{arm}.json"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }
}
