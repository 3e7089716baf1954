//! What a law learns in one period: one Euler step of θ̂̇ = −Pθθ⁻¹ Yᵀ s. The loop takes it off θ̂ and keeps θ̂ inside its box.

use super::{StepParts, Tracking};
use crate::graph::{Builder, Expr};

impl StepParts<'_> {
    /// What the period takes off the parameters; nothing for a law that does not learn.
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
        let correction = |(k, column): (usize, &Vec<Expr<'g>>)| {
            let gradient = column.iter().zip(&lesson).fold(zero, |sum, (&y, &s)| sum + y * s);
            let rate = builder.constant(self.period * adaptation.rate[k]);
            (rate * gradient).named(&format!("correction{}", k + 1), true)
        };
        columns.iter().enumerate().map(correction).collect()
    }
}
