//! Rates and torques of a model in absolute angles, from and to those of the joints.

use super::expanded::{signed, velocity_product};
use crate::graph::{Builder, Expr, Variable};

/// Rates as the model has them: those of the joints, or each link's against the first of the links about parallel axes.
pub(super) struct RelativeTo<'g, 'a> {
    pub builder: &'g Builder,
    /// [`crate::lagrangian::Coordinates::onto`]; `None` in joint angles.
    pub onto: Option<&'a [i8]>,
}

impl<'g> RelativeTo<'g, '_> {
    fn sign(&self, j: usize) -> i8 {
        self.onto.and_then(|onto| onto.get(j)).copied().unwrap_or(0)
    }

    /// What the model calls something that is named after joints.
    pub fn name(&self, joint: String) -> String {
        if self.onto.is_some() { joint + "_abs" } else { joint }
    }

    /// The rate `j` of a kind: θ̇_j = q̇_j ± θ̇_{j−1}.
    pub fn of(&self, kind: fn(usize) -> Variable, j: usize) -> Expr<'g> {
        let own = self.builder.input(kind(j));
        if self.sign(j) == 0 || j == 0 {
            return own;
        }
        let before = self.of(kind, j - 1);
        let name = match kind(j) {
            Variable::Q(_) => "q",
            Variable::Qd(_) => "qd",
            Variable::Vr(_) => "v_r",
            Variable::Ar(_) => "a_r",
            // Laws alone read these.
            Variable::DesiredQ(_) | Variable::DesiredQd(_) | Variable::DesiredQdd(_) | Variable::Theta(_) => {
                "desired"
            }
        };
        let sum = own + signed(self.sign(j) < 0, before);
        sum.named(&self.name(format!("{name}{}", j + 1)), true)
    }

    /// v_jk.
    pub fn velocity_product(&self, j: usize, k: usize) -> Expr<'g> {
        if self.onto.is_none() {
            return velocity_product(self.builder, j, k);
        }
        let product = |a, b| self.of(Variable::Qd, a) * self.of(Variable::Vr, b);
        let value = if j == k { product(j, j) } else { product(j, k) + product(k, j) };
        value.named(&self.name(format!("v{}{}", j + 1, k + 1)), true)
    }

    /// The joints' torques: τ_i = τ'_i ± τ_{i+1}.
    pub fn torque(&self, rows: Vec<Vec<Expr<'g>>>) -> Vec<Expr<'g>> {
        let mut after: Option<Expr> = None;
        let mut out = Vec::new();
        for (i, row) in rows.into_iter().enumerate().rev() {
            let own = row.into_iter().reduce(|sum, term| sum + term);
            let carried = after.filter(|_| self.sign(i + 1) != 0);
            let carried = carried.map(|torque| signed(self.sign(i + 1) < 0, torque));
            after = match (own, carried) {
                (Some(own), Some(carried)) => Some(own + carried),
                (own, carried) => own.or(carried),
            };
            out.push(after.unwrap_or(self.builder.constant(0.0)));
        }
        out.reverse();
        out
    }
}
