//! What a step in f64 rounds by, against the same step in some thirty digits.

use std::array::from_fn;

use gramforge::internals::graph::{Graph, Node, Variable};
use gramforge_generated::{arm3_xi2, puma560_exact, puma560_one_percent};
use gramforge_runtime::{ControlStep, Desired};
use gramforge_tests::double::{Double, sin_cos};
use gramforge_tests::generation;
use gramforge_tests::random::Random;

/// The step's graph in some thirty digits.
pub(super) fn thirty_digits(code: &Graph, q: &[f64], read: impl Fn(Variable) -> f64) -> Vec<Double> {
    let turned: Vec<(Double, Double)> =
        q.iter().enumerate().map(|(j, q)| sin_cos(q / f64::from(code.parts[j]))).collect();
    let mut all: Vec<Double> = Vec::with_capacity(code.nodes.len());
    for node in &code.nodes {
        let number = match *node {
            Node::Input(variable) => Double::from(read(variable)),
            Node::Sin(j) => turned[j].0,
            Node::Cos(j) => turned[j].1,
            Node::Constant(bits) => Double::from(f64::from_bits(bits)),
            Node::Add(a, b) => all[a] + all[b],
            Node::Sub(a, b) => all[a] - all[b],
            Node::Mul(a, b) => all[a] * all[b],
            Node::MulAdd(signs, a, b, c) => {
                let (first, added) = signs.given(all[a], all[c]);
                first * all[b] + added
            }
            Node::Neg(a) => -all[a],
            Node::Abs(a) if all[a].0 < 0.0 => -all[a],
            Node::Abs(a) => all[a],
            Node::Clamp(a, low, _) if all[a].0 < all[low].0 => all[low],
            Node::Clamp(a, _, high) if all[a].0 > all[high].0 => all[high],
            Node::Clamp(a, ..) => all[a],
            Node::Select(a, above, ..) if all[a].0 > 0.0 => all[above],
            Node::Select(a, _, below, _) if all[a].0 < 0.0 => all[below],
            Node::Select(_, _, _, otherwise) => all[otherwise],
        };
        all.push(number);
    }
    code.outputs.iter().map(|&output| all[output]).collect()
}

fn double_attacked<S, const N: usize>(name: &str, published: &[f64; N])
where
    S: ControlStep<N, 0, Scalar = f64>,
{
    let made = generation(name);
    let (step, rounding) = (made.step().expect("a controller"), made.rounding().expect("a controller"));
    let motion = made.motion().expect("a motion");
    let p12 = &made.design().expect("a controller").gains.p12;
    let mut code = step.code.clone();
    code.outputs = step.asked();
    let mut random = Random::new(74);
    let mut worst = [0.0_f64; N];
    for k in 0..2000 {
        let mut x = random.vector(1 + 2 * N, 1.0);
        if k % 2 == 0 {
            x[1..].iter_mut().for_each(|x| *x = x.signum());
        }
        let target = motion.at(0.5 * (x[0] + 1.0) * motion.duration());
        let near = 0.999_999_999;
        let q: [f64; N] = from_fn(|i| target.q[i] + near * x[1 + i] * rounding.states.position_error[i]);
        let qd: [f64; N] =
            from_fn(|i| target.qd[i] + near * x[1 + N + i] * rounding.states.velocity_error[i]);
        let [q_d, qd_d, qdd_d] = [&target.q, &target.qd, &target.qdd].map(|x| from_fn(|i| x[i]));
        let s = |i: usize| (0..N).fold(qd[i] - qd_d[i], |s, j| s + p12[i][j] * (q[j] - q_d[j]));
        if (0..N).any(|i| s(i).abs() <= rounding.sign) {
            continue;
        }
        let exact = thirty_digits(&code, &q, |variable| match variable {
            Variable::Q(j) => q[j],
            Variable::Qd(j) => qd[j],
            Variable::DesiredQ(j) => q_d[j],
            Variable::DesiredQd(j) => qd_d[j],
            Variable::DesiredQdd(j) => qdd_d[j],
            _ => 0.0,
        });
        let computed = S::step(&q, &qd, &Desired { q: q_d, qd: qd_d, qdd: qdd_d }, &[]).asked;
        for i in 0..N {
            let off = exact[i].off(computed[i]);
            assert!(off <= published[i], "{name}, joint {}: {off:e} above {:e}", i + 1, published[i]);
            worst[i] = worst[i].max(off / published[i]);
        }
    }
    println!("{name}: the step rounds by at most {worst:.3?} of what is published");
    assert!(worst.iter().all(|part| *part > 0.01), "{name}: {worst:?}");
}

#[test]
fn no_step_in_f64_rounds_by_more_than_published() {
    double_attacked::<arm3_xi2::Arm3Xi2, 3>("arm3_xi2", &arm3_xi2::ROUNDING);
    double_attacked::<puma560_exact::Puma560Exact, 6>("puma560_exact", &puma560_exact::ROUNDING);
    double_attacked::<puma560_one_percent::Puma560OnePercent, 6>(
        "puma560_one_percent",
        &puma560_one_percent::ROUNDING,
    );
}
