//! What the rounding of every operation does to a result: derivatives of the result by each node, backwards over the graph.
//!
//! Forwards, a bound on an error forgets its sign, so that the errors of a vector grow by up to √2 at each joint that turns it.
//! Backwards, the slopes of a result along the components of a vector turn as the vector itself, and do not grow.
//!
//! Let every node be what its operation makes of the computed operands, plus an error δ_k of its own, |δ_k| ≤ d_k. On the way from all δ
//! zero (exact) to all δ as they are (computed) every number stays within its forward bound of the exact one. So a result changes by
//! at most Σ_k max|∂result/∂δ_k| d_k, the slopes taken over the intervals widened by these bounds.

use super::{Graph, Node, NodeId};
use crate::numerics::interval::Interval;
use crate::numerics::rounded::Rounded;

/// More than what the sum over all nodes is itself rounded by.
const SPARE: f64 = 1.0 + 1e-11;

/// Slope of |x|, and of a choice between two numbers.
const EITHER_SIGN: Interval = Interval { low: -1.0, high: 1.0 };
const PART: Interval = Interval { low: 0.0, high: 1.0 };
const WHOLE: Interval = Interval { low: 1.0, high: 1.0 };

impl Graph {
    /// Bound on |computed − exact| of the node `result` from the slopes, by `all` nodes' intervals and own errors; NaN where there
    /// is none. As in [`Graph::rounding`], a choice by a sign that may be the wrong one is not counted.
    pub(super) fn by_slopes(&self, all: &[Rounded], result: NodeId) -> f64 {
        let mut slopes = vec![Interval::ZERO; result + 1];
        slopes[result] = WHOLE;
        let mut total = 0.0;
        for id in (0..=result).rev() {
            let slope = slopes[id];
            if slope == Interval::ZERO {
                continue;
            }
            total += slope.magnitude() * all[id].own;
            let mut add = |operand: NodeId, slope: Interval| slopes[operand] = slopes[operand] + slope;
            match self.nodes[id] {
                Node::Input(_) | Node::Sin(_) | Node::Cos(_) | Node::Constant(_) => {}
                Node::Add(a, b) => {
                    add(a, slope);
                    add(b, slope);
                }
                Node::Sub(a, b) => {
                    add(a, slope);
                    add(b, -slope);
                }
                Node::Mul(a, b) => {
                    add(a, slope * all[b].widened());
                    add(b, slope * all[a].widened());
                }
                Node::MulAdd(signs, a, b, c) => {
                    let (product, added) = signs.given(slope, slope);
                    add(a, product * all[b].widened());
                    add(b, product * all[a].widened());
                    add(c, added);
                }
                Node::Neg(a) => add(a, -slope),
                Node::Abs(a) => add(a, slope * sign(all[a].widened())),
                Node::Clamp(a, low, high) => {
                    let of = |may: bool, must: bool| match (must, may) {
                        (true, _) => slope,
                        (_, true) => slope * PART,
                        _ => Interval::ZERO,
                    };
                    let [x, least, most] = [a, low, high].map(|id| all[id].widened());
                    let (inside, below, above) =
                        (x.low > least.high && x.high < most.low, x.low <= least.high, x.high >= most.low);
                    add(a, of(true, inside));
                    add(low, of(below, false));
                    add(high, of(above, false));
                }
                Node::Select(by, above, below, otherwise) => {
                    let Interval { low, high } = all[by].value;
                    let may = [high > 0.0, low < 0.0, low <= 0.0 && high >= 0.0];
                    let alone = may.iter().filter(|may| **may).count() == 1;
                    for (choice, _) in [above, below, otherwise].into_iter().zip(may).filter(|(_, may)| *may)
                    {
                        add(choice, if alone { slope } else { slope * PART });
                    }
                }
            }
        }
        total * SPARE
    }
}

/// Slopes of |x| over an interval.
fn sign(x: Interval) -> Interval {
    match (x.low > 0.0, x.high < 0.0) {
        (true, _) => WHOLE,
        (_, true) => -WHOLE,
        _ => EITHER_SIGN,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Builder, Expr, Inputs, Variable};
    use crate::dynamics::Scalar;
    use crate::numerics::interval::Interval;
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use crate::numerics::rounded::Format;

    /// q1 turns and all else is a component of a vector.
    struct Turning;

    impl Inputs for Turning {
        fn input(&self, variable: Variable) -> Interval {
            match variable {
                Variable::Q(0) => Interval::about(0.785, 0.001),
                _ => Interval::about(0.0, 1.0),
            }
        }

        fn error(&self, _measured: Variable) -> Option<Interval> {
            None
        }
    }

    const LINKS: usize = 12;

    /// A vector that is turned by q1 again and again, with a bit of everything else at the end.
    fn turned<'g>(builder: &'g Builder) -> [Expr<'g>; 2] {
        let (sin, cos) = builder.sin_cos(0);
        let input = |k: usize| builder.input(Variable::Q(k));
        let mut vector = [input(1), input(2)];
        for _ in 0..LINKS {
            let [x, y] = vector;
            vector = [cos * x - sin * y, sin * x + cos * y];
        }
        let [x, y] = vector;
        let limit = x.constant(0.9);
        let side = input(1).select(x * x, y * limit, x);
        [x, (x.abs() * limit - y).clamp(-limit, limit) + side]
    }

    #[test]
    fn errors_of_a_turned_vector_do_not_grow_and_no_state_exceeds_the_bound() {
        let builder = Builder::new();
        let outputs = turned(&builder).map(Expr::id);
        let plain = builder.finish(&outputs);
        for graph in [plain.fused(), plain] {
            let bound = graph.rounding(&Turning, Format::SINGLE).outputs;
            let forwards: Vec<f64> = {
                let all = graph.rounded_nodes(&Turning, Format::SINGLE);
                graph.outputs.iter().map(|&output| all[output].error).collect()
            };
            assert!(5.0 * bound[0] < forwards[0], "{bound:?} {forwards:?}");
            let points = LowDiscrepancy::new(3);
            let mut most = [0.0_f64; 2];
            for index in 0..20_000 {
                let u = points.point(index);
                // A hair inside, so that rounding to f32 does not leave the states.
                let q = [0.784_01 + 0.001_98 * u[0], 2.0 * u[1] - 1.0, 2.0 * u[2] - 1.0].map(|x| x as f32);
                let exact = graph.interpret(&q.map(f64::from), &[], &[], &[]);
                let computed = graph.interpret(&q, &[], &[], &[]);
                for (i, (computed, exact)) in computed.iter().zip(&exact).enumerate() {
                    let off = (f64::from(*computed) - exact).abs();
                    assert!(off <= bound[i], "{q:?}: {off:e} above {:e}", bound[i]);
                    most[i] = most[i].max(off / bound[i]);
                }
            }
            // The second result counts every choice and both slopes of |x|.
            assert!(most[0] > 0.1 && most[1] > 0.005, "{most:?}");
        }
    }
}
