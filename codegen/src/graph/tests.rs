//! Folding keeps values and keeps the promises of [`Graph`](super::Graph).

use super::{Builder, Expr, Graph, Node, Tape, Variable};
use crate::dynamics::Scalar;

/// The graph of f(q1, q2) and its value at two numbers.
fn graph(f: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> Graph {
    let builder = Builder::new();
    let output = f(builder.input(Variable::Q(0)), builder.input(Variable::Q(1))).id();
    builder.finish(&[output])
}

fn value(graph: &Graph) -> f64 {
    graph.interpret(&[1.7, -0.3], &[], &[], &[])[0]
}

#[test]
fn neutral_elements_vanish() {
    for (g, expected) in [
        (graph(|x, _| x + x.constant(0.0)), 1.7),
        (graph(|x, _| x.constant(0.0) + x), 1.7),
        (graph(|x, _| x * x.constant(1.0)), 1.7),
        (graph(|x, _| -(-x)), 1.7),
        (graph(|x, y| (x + y) * x.constant(0.0)), 0.0),
        (graph(|x, _| x - x), 0.0),
        (graph(|x, _| x.constant(2.0) * x.constant(3.0)), 6.0),
    ] {
        assert_eq!(g.nodes.len(), 1, "{g:?}");
        assert_eq!(value(&g), expected);
    }
}

#[test]
fn signs_move_into_sums() {
    let cases = [
        graph(|x, y| x + -y),
        graph(|x, y| x - y * y.constant(1.0)),
        graph(|x, y| -(y - x)),
        graph(|x, y| x.constant(-1.0) * y + x),
        graph(|x, y| -y + x),
    ];
    for g in cases {
        assert_eq!(g.operations().arithmetic(), 1, "{g:?}");
        assert_eq!(value(&g).to_bits(), (1.7_f64 - -0.3).to_bits());
    }
    // −c·x and c·x share their product; −(a + b) costs its sign once.
    let shared = graph(|x, y| (x * x.constant(-3.0)) * (y + x.constant(3.0) * x));
    assert_eq!(shared.operations().mul, 2);
    let constants = graph(|x, _| x + x.constant(-2.5));
    assert!(matches!(constants.nodes.last(), Some(Node::Sub(..))));
}

#[test]
fn equal_expressions_are_one_node() {
    let g = graph(|x, y| (x * y + y) * (y * x + y));
    assert_eq!(g.operations().mul, 2);
    assert_eq!(g.operations().add, 1);
    assert_eq!(g.uses().iter().filter(|&&uses| uses == 2).count(), 2, "y and the sum");
}

#[test]
fn what_no_output_needs_is_dropped() {
    let builder = Builder::new();
    let x = builder.input(Variable::Qd(1));
    let _unused = builder.sin_cos(0).0 * x;
    let output = (x + x).id();
    let g = builder.finish(&[output]);
    assert_eq!((g.nodes.len(), g.operations().trig_pairs), (2, 0));
}

#[test]
fn sign_kept_in_a_literal_stays_there() {
    let g = graph(|x, y| x.scaled(-3.0) - y);
    assert_eq!((g.operations().mul, g.operations().add), (1, 1));
    assert_eq!(value(&g), -3.0 * 1.7 + 0.3);
}

#[test]
fn common_factors_and_partial_sums_are_computed_once() {
    let cases = [
        // 3y·(x + y)
        (graph(|x, y| x.constant(3.0) * x * y + x.constant(3.0) * y * y), 3),
        // with x + y shared
        (graph(|x, y| (x + (y + x.constant(1.0))) * x - ((x + x.constant(2.0)) + y) * y), 6),
    ];
    for (g, operations) in cases {
        let factored = g.factored();
        assert_eq!(factored.operations().arithmetic(), operations, "{factored:?}");
        assert!((value(&factored) - value(&g)).abs() < 1e-14);
    }
}

/// Random trees: the folded graph agrees with plain arithmetic, up to the rounding that folding constants and moving
/// signs leaves alone: none.
#[test]
fn random_trees_keep_their_bits() {
    fn tree<S: Scalar>(state: &mut u32, depth: u32, x: S, y: S) -> S {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let choice = *state >> 28;
        if depth == 0 {
            return match choice % 4 {
                0 => x,
                1 => y,
                2 => x.constant(f64::from(*state >> 20 & 7) - 3.0),
                _ => x * y,
            };
        }
        let a = tree(state, depth - 1, x, y);
        let b = tree(state, depth - 1, x, y);
        match choice % 4 {
            0 => a + b,
            1 => a - b,
            2 => a * b,
            _ => -a,
        }
    }
    for seed in 0..500 {
        let builder = Builder::new();
        let (x, y) = (builder.input(Variable::Q(0)), builder.input(Variable::Q(1)));
        let output = tree(&mut { seed }, 5, x, y).id();
        let folded = value(&builder.finish(&[output]));
        let plain = tree(&mut { seed }, 5, 1.7, -0.3);
        // Only the sign of a zero may differ.
        assert!(folded == plain || (folded.is_nan() && plain.is_nan()), "seed {seed}: {folded} {plain}");
    }
}

#[test]
fn a_tape_gives_the_bits_of_the_graph() {
    let builder = Builder::new();
    let input = |variable| builder.input(variable);
    let (x, y, z) = (input(Variable::Q(0)), input(Variable::Qd(1)), input(Variable::Theta(0)));
    let (sin, cos) = builder.sin_cos(1);
    let sum = (x * y + sin).abs();
    let cut = (sum - z * cos).clamp(-x.constant(0.25), y * y);
    let chosen = (x - y).select(cut, -sum * z, x.constant(0.5) + cos);
    let last = input(Variable::DesiredQ(0)) - input(Variable::DesiredQdd(0));
    let outputs = [chosen * cut, sum, last + chosen, x].map(Expr::id);
    let graph = builder.finish(&outputs);
    let (double, single) = (Tape::<f64>::new(&graph), Tape::<f32>::new(&graph));
    for (x, y) in [(0.3, -1.2), (-0.7, 0.4), (0.1, 0.1), (f64::NAN, 1.0), (2.0, f64::INFINITY)] {
        let (q, qd, desired, theta) = ([x, 0.9], [0.2, y], [[0.4; 2], [0.1; 2], [x * y; 2]], [1.5]);
        let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        let rows = desired.each_ref().map(|row| row.as_slice());
        let plain = graph.interpret_step(&q, &qd, rows, &theta);
        assert_eq!(bits(double.interpret_step(&q, &qd, rows, &theta)), bits(plain));
        assert_eq!(bits(double.interpret(&q, &qd, &q, &qd)), bits(graph.interpret(&q, &qd, &q, &qd)));
        let (q, qd, theta) = (q.map(|x| x as f32), qd.map(|x| x as f32), theta.map(|x| x as f32));
        let desired = desired.map(|row| row.map(|x| x as f32));
        let rows = desired.each_ref().map(|row| row.as_slice());
        let bits = |values: Vec<f32>| values.into_iter().map(f32::to_bits).collect::<Vec<_>>();
        let plain = graph.interpret_step(&q, &qd, rows, &theta);
        assert_eq!(bits(single.interpret_step(&q, &qd, rows, &theta)), bits(plain));
    }
}
