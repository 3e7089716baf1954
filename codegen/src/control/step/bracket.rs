//! The switching terms of the robust laws, diag(sgn s) ρ.

use super::{RobustGain, StepParts, Tracking, weighed};
use crate::graph::{Builder, Expr, Variable};
use crate::spec::{CoriolisTermSpec, LawSpec};

impl StepParts<'_> {
    /// What each joint subtracts; `None` where ρ is 0.
    pub(super) fn switched<'g>(
        &self,
        builder: &'g Builder,
        tracking: &Tracking<'g>,
    ) -> Vec<Option<Expr<'g>>> {
        let n = tracking.s.len();
        if !self.law.is_robust() {
            return vec![None; n];
        }
        let rho = match self.robust_gain {
            RobustGain::Constant(rho) => rho.iter().map(|&rho| builder.constant(rho)).collect(),
            RobustGain::State if self.law == LawSpec::Tight => self.tight(builder, tracking),
            RobustGain::State => self.bracket(builder, tracking),
        };
        let zero = builder.constant(0.0);
        let switched = |i: usize| {
            let (rho, s) = (rho[i], tracking.s[i]);
            (rho != zero).then(|| {
                let switched = match self.boundary_layer {
                    // NaN stays NaN, so that the loop sees it.
                    None => s.select(rho, -rho, s),
                    // A constant ρ is folded into the slope.
                    Some(phi) => match rho.value() {
                        Some(number) => (builder.constant(number / phi[i]) * s).clamp(-rho, rho),
                        None => {
                            let one = builder.constant(1.0);
                            let side = (builder.constant(1.0 / phi[i]) * s).clamp(-one, one);
                            side.named(&format!("side{}", i + 1), true) * rho
                        }
                    },
                };
                switched.named(&format!("switched{}", i + 1), true)
            })
        };
        (0..n).map(switched).collect()
    }

    /// The bracket of (34): ΔD(|q̈_d| + P12|q̇_e|) + (ΔB + ΔC)|q̇| + ΔG + disturbance, with ΔC|s| in the variant without ΔC1.
    fn bracket<'g>(&self, builder: &'g Builder, tracking: &Tracking<'g>) -> Vec<Expr<'g>> {
        let n = tracking.s.len();
        let errors: Vec<Expr> = tracking.qd_e.iter().map(|e| e.abs()).collect();
        let acceleration: Vec<Expr> = (0..n)
            .map(|j| {
                let desired = builder.input(Variable::DesiredQdd(j)).abs();
                let sum = desired + weighed(builder, &self.gains.p12[j], &errors);
                sum.named(&format!("acceleration{}", j + 1), true)
            })
            .collect();
        let speed: Vec<Expr> = (0..n).map(|j| speed(builder, j)).collect();
        let switching = self.coriolis_term == CoriolisTermSpec::Switching;
        let turned: Vec<Expr> = match switching {
            true => (0..n).map(|j| speed[j] + tracking.s[j].abs()).collect(),
            false => speed.clone(),
        };
        let row = |i: usize| {
            let mut coriolis = self.delta_c[i].clone();
            let mut friction = builder.constant(0.0);
            match switching {
                // With |s| in the sum of ΔC, ΔB|q̇| is a term of its own.
                true => friction = builder.constant(self.bounds.b[i]) * speed[i],
                false => coriolis[i] += self.bounds.b[i],
            }
            let constant = builder.constant(self.bounds.g[i] + self.disturbance[i]);
            let rho = weighed(builder, &self.bounds.d[i], &acceleration)
                + weighed(builder, &coriolis, &turned)
                + friction
                + constant;
            named(rho, i)
        };
        (0..n).map(row).collect()
    }

    /// ρ_i = Σ_j ΔD_ij|a_r,j| + Σ_jk Δh_ijk|v_r,j||q̇_k| + ΔB_i|q̇_i| + ΔG_i + disturbance_i.
    fn tight<'g>(&self, builder: &'g Builder, tracking: &Tracking<'g>) -> Vec<Expr<'g>> {
        let n = tracking.s.len();
        let size = |x: &[Expr<'g>]| -> Vec<Expr<'g>> { x.iter().map(|x| x.abs()).collect() };
        let (v_r, a_r) = (size(&tracking.v_r), size(&tracking.a_r));
        let speed: Vec<Expr> = (0..n).map(|j| speed(builder, j)).collect();
        let row = |i: usize| {
            let h = &self.bounds.h[i];
            let mut coriolis = builder.constant(0.0);
            for j in 0..n {
                for k in j..n {
                    let (first, second) = (v_r[j] * speed[k], v_r[k] * speed[j]);
                    // Rows share the products of two joints, since Δh_ijk = Δh_ikj.
                    coriolis = coriolis
                        + if j == k || h[j][k] != h[k][j] {
                            let other = if j == k { 0.0 } else { h[k][j] };
                            builder.constant(h[j][k]) * first + builder.constant(other) * second
                        } else {
                            builder.constant(h[j][k]) * (first + second)
                        };
                }
            }
            let rho = weighed(builder, &self.bounds.d[i], &a_r)
                + coriolis
                + builder.constant(self.bounds.b[i]) * speed[i]
                + builder.constant(self.bounds.g[i] + self.disturbance[i]);
            named(rho, i)
        };
        (0..n).map(row).collect()
    }
}

/// |q̇_j|.
fn speed(builder: &Builder, j: usize) -> Expr<'_> {
    builder.input(Variable::Qd(j)).abs().named(&format!("speed{}", j + 1), false)
}

fn named<'g>(rho: Expr<'g>, i: usize) -> Expr<'g> {
    if rho.is_constant() { rho } else { rho.named(&format!("rho{}", i + 1), true) }
}
