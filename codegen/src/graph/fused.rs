//! Products computed together with the sums that they stand in: fused multiply-add.

use super::{Graph, Node, NodeId, Signs};

impl Graph {
    /// The same function with one operation, rounded once, for every sum or difference of a product that nothing else uses. Of two
    /// such products the second one goes with the sum.
    ///
    /// Values change by rounding alone, and each is rounded less often.
    pub fn fused(&self) -> Graph {
        let uses = self.uses();
        let mut gone = vec![false; self.nodes.len()];
        let nodes: Vec<Node> = self
            .nodes
            .iter()
            .map(|&node| match self.with_product(node, &uses) {
                Some((product, fused)) => {
                    gone[product] = true;
                    fused
                }
                None => node,
            })
            .collect();
        let mut new = vec![0; nodes.len()];
        let mut out = Graph { nodes: Vec::new(), names: Vec::new(), fma: true, ..self.clone() };
        for (id, (node, name)) in nodes.into_iter().zip(&self.names).enumerate() {
            if !gone[id] {
                new[id] = out.nodes.len();
                out.nodes.push(node.renumbered(|operand| new[operand]));
                out.names.push(name.clone());
            }
        }
        out.outputs.iter_mut().for_each(|output| *output = new[*output]);
        out
    }

    /// `other` with the sines of this graph, and fused where this one is.
    pub(crate) fn alike(&self, other: Graph) -> Graph {
        let other = Graph { sines: self.sines.clone(), ..other };
        if self.fma { other.fused() } else { other }
    }

    /// The product in a sum that can be fused with it, and the operation in place of both.
    fn with_product(&self, node: Node, uses: &[usize]) -> Option<(NodeId, Node)> {
        let product = |id: NodeId, signs: Signs, other: NodeId| match self.nodes[id] {
            Node::Mul(a, b) if uses[id] == 1 => Some((id, Node::MulAdd(signs, a, b, other))),
            _ => None,
        };
        match node {
            Node::Add(a, b) => product(b, Signs::Plus, a).or_else(|| product(a, Signs::Plus, b)),
            Node::Sub(a, b) => product(b, Signs::From, a).or_else(|| product(a, Signs::Minus, b)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Builder, Expr, Graph, Inputs, Variable};
    use crate::check::prepare;
    use crate::dynamics::Scalar;
    use crate::numerics::interval::Interval;
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use crate::numerics::rounded::Format;
    use crate::torque::recursive;

    const AT: [f64; 2] = [1.7, -0.3];

    fn fused(f: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> Graph {
        let builder = Builder::new();
        let output = f(builder.input(Variable::Q(0)), builder.input(Variable::Q(1))).id();
        builder.finish(&[output]).fused()
    }

    #[test]
    fn a_product_of_one_sum_is_rounded_with_it() {
        let [x, y] = AT;
        let cases = [
            (fused(|x, y| x * y + y), x.mul_add(y, y)),
            (fused(|x, y| x * y - y), x.mul_add(y, -y)),
            (fused(|x, y| y - x * y), (-x).mul_add(y, y)),
            (fused(|x, y| y - x.constant(0.1) * x), (-0.1_f64).mul_add(x, y)),
            // Of two products the second.
            (fused(|x, y| x * x + y * y), y.mul_add(y, x * x)),
            (fused(|x, y| x * x - y * y), (-y).mul_add(y, x * x)),
        ];
        for (graph, expected) in cases {
            assert_eq!(graph.operations().fused, 1, "{graph:?}");
            assert_eq!(graph.interpret(&AT, &[], &[], &[])[0].to_bits(), expected.to_bits(), "{graph:?}");
        }
        // Another reader needs the product itself, rounded.
        let shared = fused(|x, y| (x * y + y) * (x * y));
        assert_eq!((shared.operations().fused, shared.operations().arithmetic()), (0, 3));
    }

    struct Around;

    impl Inputs for Around {
        fn input(&self, _variable: Variable) -> Interval {
            Interval::about(0.4, 0.3)
        }

        fn error(&self, _measured: Variable) -> Option<Interval> {
            None
        }
    }

    #[test]
    fn a_whole_torque_is_the_same_with_fewer_operations_and_smaller_rounding() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/ur5.json");
        let arm = prepare(&path).expect("a sound specification").built.arm;
        let (plain, n) = (recursive(&arm), arm.dof());
        let fused = plain.fused();
        assert!(10 * fused.operations().arithmetic() < 7 * plain.operations().arithmetic());
        let [own, other] = [&fused, &plain].map(|graph| graph.rounding(&Around, Format::SINGLE).outputs);
        assert!(own.iter().zip(&other).all(|(own, other)| own < other), "{own:?} {other:?}");
        let points = LowDiscrepancy::new(4 * n);
        for index in 0..100 {
            let x: Vec<f64> = points.point(index).iter().map(|u| 0.1 + 0.6 * u).collect();
            let part = |k: usize| &x[k * n..(k + 1) * n];
            let values = |graph: &Graph| graph.interpret(part(0), part(1), part(2), part(3));
            let slopes = |graph: &Graph| graph.slopes(part(0), part(1), part(2), part(3), Variable::Vr(1));
            for (fused, plain) in [(values(&fused), values(&plain)), (slopes(&fused), slopes(&plain))] {
                assert!(fused.iter().zip(&plain).all(|(a, b)| (a - b).abs() < 1e-12), "{fused:?} {plain:?}");
            }
            let single: Vec<f32> = x.iter().map(|&x| x as f32).collect();
            let part = |k: usize| &single[k * n..(k + 1) * n];
            let computed = fused.interpret(part(0), part(1), part(2), part(3));
            let real: Vec<f64> = single.iter().copied().map(f64::from).collect();
            let part = |k: usize| &real[k * n..(k + 1) * n];
            let exact = plain.interpret(part(0), part(1), part(2), part(3));
            for ((computed, exact), bound) in computed.iter().zip(exact).zip(&own) {
                assert!((f64::from(*computed) - exact).abs() <= *bound);
            }
        }
    }

    #[test]
    fn taken_into_another_graph_products_are_free_again() {
        let graph = fused(|x, y| (x * y + y) * (y - x * x) - x.constant(2.0));
        let builder = Builder::new();
        let leaf = |leaf| match leaf {
            super::super::Leaf::Input(variable) => builder.input(variable),
            _ => builder.constant(0.0),
        };
        let made = builder.embed(&graph, leaf, |name| Some(name.to_string()));
        let output = made[graph.outputs[0]].id();
        let plain = builder.finish(&[output]);
        assert_eq!((plain.operations().fused, plain.fma), (0, false));
        let (factored, again) = (graph.factored(), graph.alike(plain.clone()));
        assert_eq!(again.operations(), graph.operations());
        let [x, y] = AT;
        let expected = (x * y + y) * (y - x * x) - 2.0;
        for graph in [graph, plain, factored, again] {
            assert!((graph.interpret(&AT, &[], &[], &[])[0] - expected).abs() < 1e-15);
        }
    }
}
