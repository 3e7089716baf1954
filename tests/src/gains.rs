//! Gains that a test writes into a specification.

use serde_json::{Value, json};

/// A robust law with the same gains for every joint.
#[derive(Clone, Copy, Debug)]
pub struct RobustLaw {
    /// `report` or `tight`.
    pub law: &'static str,
    /// W of equation (16), N·m·s/rad.
    pub w: f64,
    /// Pqq of equation (12), N·m/rad.
    pub pqq: f64,
    /// Ω of equation (16), N·m/(rad·s).
    pub omega: f64,
    /// Width of the boundary layer, rad/s.
    pub boundary_layer: f64,
}

impl RobustLaw {
    /// The gains as one row of a table: law, W, Pqq, Ω, boundary layer.
    pub fn of(law: &'static str, w: f64, pqq: f64, omega: f64, boundary_layer: f64) -> Self {
        Self { law, w, pqq, omega, boundary_layer }
    }

    /// Writes the gains into the section `control` of `spec`, for a period of 1 ms and errors of `initial` in every joint
    /// at the start, rad or m.
    pub fn write(&self, spec: &mut Value, initial: f64) {
        let control = &mut spec["control"];
        control["W"] = json!(self.w);
        control["Pqq"] = json!(self.pqq);
        control["Omega"] = json!(self.omega);
        control["boundary_layer"] = json!(self.boundary_layer);
        control["law"] = json!(self.law);
        control["period"] = json!(0.001);
        control["initial_error"] = json!({ "position": initial });
    }
}
