//! The torque as an affine function of the parameters that a law learns, equations (46) and (50).

use super::Form;
use super::expanded::{alpha, functions, torque};
use crate::arm::Arm;
use crate::graph::{Builder, Expr, Graph};
use crate::lagrangian::{Combination, Lagrangian};
use crate::reduction::Regression;
use serde::{Deserialize, Serialize};

/// Code of base and Y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regressor {
    /// Outputs: base by row, unless it is the model's own torque; then Y column by column, each by row.
    pub code: Graph,
    /// Whether base is the model's own passivity torque, which other code computes.
    pub own_base: bool,
    /// Number of parameters.
    pub parameters: usize,
}

/// Base and Y from shared ψ functions. Where the model itself is a recursion and θ counts from the arm's own
/// parameters, base stays with it: the recursion is cheaper.
pub fn regressor(arm: &Arm, lagrangian: &Lagrangian, regression: &Regression, form: Form) -> Regressor {
    let n = arm.dof();
    let own_base = form == Form::Recursive && regression.parameters.iter().all(|p| p.initial == 0.0);
    let builder = Builder::new();
    let effects = regression.parameters.iter().flat_map(|p| &p.effects).map(|(_, terms)| terms);
    let base: &[Combination] = if own_base { &[] } else { &regression.base };
    let psi = functions(&builder, lagrangian, base.iter().chain(effects).flatten());
    let mut outputs: Vec<Expr> = Vec::new();
    if !own_base {
        let named = lagrangian.coefficients.iter().zip(base);
        let alphas: Vec<_> = named.map(|(c, terms)| alpha(&builder, &c.name(), terms, &psi)).collect();
        let rows = torque(&builder, n, lagrangian, &alphas);
        outputs.extend((1..).zip(rows).map(|(i, tau)| tau.named(&format!("base{i}"), true)));
    }
    for (number, parameter) in (1..).zip(&regression.parameters) {
        let mut alphas = vec![None; lagrangian.coefficients.len()];
        for (m, terms) in &parameter.effects {
            let name = format!("p{number}_{}", lagrangian.coefficients[*m].name());
            alphas[*m] = alpha(&builder, &name, terms, &psi);
        }
        let rows = torque(&builder, n, lagrangian, &alphas);
        outputs.extend((1..).zip(rows).map(|(i, y)| y.named(&format!("y{i}_{number}"), true)));
    }
    let outputs: Vec<_> = outputs.into_iter().map(|output| output.id()).collect();
    Regressor { code: builder.finish(&outputs), own_base, parameters: regression.parameters.len() }
}
