//! Plain inverse dynamics: the torque along the joints' own velocities.

use super::{Builder, Graph, Leaf, Variable};

impl Graph {
    /// The graph with q̇ in place of v_r: D(q) a_r + C(q, q̇) q̇ + G(q), which other generators call inverse dynamics.
    ///
    /// Everything is folded, shared and factored anew: products that differ in v_r and q̇ alone are computed once. Values
    /// change by rounding alone.
    pub fn inverse_dynamics(&self) -> Graph {
        let builder = Builder::new();
        builder.divide(self.parts);
        let leaf = |leaf| match leaf {
            Leaf::Input(Variable::Vr(joint)) => builder.input(Variable::Qd(joint)),
            Leaf::Input(variable) => builder.input(variable),
            Leaf::Sin(joint) => builder.sin_cos(joint).0,
            Leaf::Cos(joint) => builder.sin_cos(joint).1,
        };
        let new = builder.embed(self, leaf, |name| Some(name.to_string()));
        let outputs: Vec<_> = self.outputs.iter().map(|&output| new[output].id()).collect();
        self.alike(builder.finish(&outputs).factored())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Graph, Node, Variable};
    use crate::check::prepare;
    use crate::lagrangian::expand;
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use crate::torque::{exact, expanded, recursive};
    use crate::{arm::Arm, reduction};

    fn arm(file: &str) -> Arm {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
        prepare(&path).expect("a sound specification").built.arm
    }

    /// Checks the values of `plain` against `code` at v_r = q̇, and that no v_r is left.
    fn same_torque(code: &Graph, plain: &Graph, n: usize) {
        let is_reference = |node: &Node| matches!(node, Node::Input(Variable::Vr(_)));
        assert!(code.nodes.iter().any(is_reference) && !plain.nodes.iter().any(is_reference));
        let points = LowDiscrepancy::new(3 * n);
        for index in 0..100 {
            let x: Vec<f64> = points.point(index).iter().map(|u| 6.0 * u - 3.0).collect();
            let (q, qd, qdd) = (&x[..n], &x[n..2 * n], &x[2 * n..]);
            // Other reference velocities must not matter.
            let (wanted, torque) = (code.interpret(q, qd, qd, qdd), plain.interpret(q, qd, qdd, qdd));
            let scale = wanted.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
            for (torque, wanted) in torque.iter().zip(&wanted) {
                assert!((torque - wanted).abs() <= 1e-12 * scale, "{torque} {wanted}");
            }
        }
    }

    #[test]
    fn it_is_the_passivity_torque_at_the_joints_velocity() {
        for (file, most) in [
            ("generated/specs/arm3_exact.json", 74),
            ("generated/specs/puma560_exact.json", 287),
            ("tests/data/stanford.json", 246),
            ("tests/data/ur5.json", 233),
            ("tests/data/panda.json", 532),
        ] {
            let arm = arm(file);
            let code = recursive(&arm);
            let plain = code.inverse_dynamics();
            same_torque(&code, &plain, arm.dof());
            let operations = plain.operations();
            println!("{file}: {operations:?}, {}", operations.arithmetic());
            assert!(operations.arithmetic() <= most, "{file}: {operations:?}");
        }
        // Written out in products of sines.
        let arm = arm("generated/specs/arm3_exact.json");
        let lagrangian = expand(&arm);
        for code in [exact(&arm, &lagrangian).1, expanded(&arm, &lagrangian, &reduction::exact(&lagrangian))]
        {
            same_torque(&code, &code.inverse_dynamics(), arm.dof());
        }
    }
}
