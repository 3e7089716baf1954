//! What a law learns in one period: one Euler step of θ̂̇ = −Pθθ⁻¹ Yᵀ s inside its box.

use super::{StepParts, Tracking};
use crate::graph::{Builder, Expr, Variable};

impl StepParts<'_> {
    /// The parameters after the period; nothing for a law that does not learn.
    pub(super) fn learnt<'g>(
        &self,
        builder: &'g Builder,
        tracking: &Tracking<'g>,
        columns: &[Vec<Expr<'g>>],
    ) -> Vec<Expr<'g>> {
        let Some(adaptation) = self.adaptation else { return Vec::new() };
        let zero = builder.constant(0.0);
        // A joint inside its layer teaches nothing: what s does there is ripple and noise.
        let lesson: Vec<Expr> = (tracking.s.iter().enumerate())
            .map(|(i, &s)| match self.boundary_layer {
                None => s,
                Some(phi) => {
                    let outside = s.abs() - builder.constant(phi[i]);
                    outside.select(s, zero, zero).named(&format!("lesson{}", i + 1), true)
                }
            })
            .collect();
        let next = |(k, column): (usize, &Vec<Expr<'g>>)| {
            let gradient = column.iter().zip(&lesson).fold(zero, |sum, (&y, &s)| sum + y * s);
            let rate = builder.constant(self.period * adaptation.rate[k]);
            let theta = builder.input(Variable::Theta(k)) - rate * gradient;
            let [low, high] = [adaptation.low[k], adaptation.high[k]].map(|x| builder.constant(x));
            theta.clamp(low, high).named(&format!("theta{}", k + 1), true)
        };
        columns.iter().enumerate().map(next).collect()
    }
}
