//! No member of the family exceeds a bound, anywhere in the domain.

use gramforge::Generation;
use gramforge::internals::bounds::at_vertices;
use gramforge::internals::dynamics::{coriolis, gravity, mass_matrix};
use gramforge::internals::lagrangian::{Combination, Lagrangian, evaluate};
use gramforge::internals::reduction::{Reduced, plus};
use gramforge_tests::random::Random;
use gramforge_tests::{edited, largest};
use serde_json::{Value, json};

fn value(lagrangian: &Lagrangian, terms: &Combination, q: &[f64]) -> f64 {
    evaluate(terms, &lagrangian.evaluate_functions(q)).abs()
}

/// What is left out of coefficient `m` of the arm at `u`.
fn residual(lagrangian: &Lagrangian, reduced: &Reduced, m: usize, u: &[f64]) -> Combination {
    let varied = |sum: Combination, (k, u): (usize, &f64)| {
        plus(&sum, *u, &reduced.residual_variation(lagrangian, m, k))
    };
    u.iter().enumerate().fold(reduced.residual(lagrangian, m), varied)
}

fn uncertain(law: &str, functions: usize, intervals: &Value) -> Generation {
    edited("arm3_xi2", |v| {
        v["model"]["shared"]["functions"] = json!(functions);
        v["control"]["law"] = json!(law);
        v["control"]["boundary_layer"] = json!(0.1);
        v["control"]["allow_long_period"] = json!(true);
        v["control"]["uncertainty"] = intervals.clone();
    })
    .unwrap_or_else(|message| panic!("{message}"))
}

fn four_numbers() -> Value {
    json!({ "links": [
        { "joint": "joint2", "mass": [3.5, 4.2] },
        { "joint": "joint3", "mass": [2.8, 4.2], "first_moment": [[-0.35, -0.25], null, null], "pseudo_inertia": { "xx": [0.12, 0.14] } }
    ], "viscous_friction": [[0.0, 0.5], null, [0.0, 0.2]] })
}

#[test]
fn vertices_hold_the_whole_box() {
    for law in ["report", "adaptive"] {
        let made = uncertain(law, 2, &four_numbers());
        let (lagrangian, reduced) = (made.lagrangian(), made.reduced());
        let mut random = Random::new(11);
        let grid: Vec<Vec<f64>> = (0..5_usize.pow(4))
            .map(|index| {
                (0..4)
                    .map(|k| {
                        let [low, high] = lagrangian.ranges[k];
                        low + (high - low) * ((index / 5_usize.pow(k as u32)) % 5) as f64 / 4.0
                    })
                    .collect()
            })
            .collect();
        let mut compared = 0;
        for m in 0..lagrangian.coefficients.len() {
            let vertices = at_vertices(lagrangian, reduced, m);
            let members: Vec<Combination> =
                grid.iter().map(|u| residual(lagrangian, reduced, m, u)).collect();
            for _ in 0..5 {
                let q = random.vector(3, 3.0);
                let most = |of: &[Combination]| {
                    of.iter().map(|terms| value(lagrangian, terms, &q)).fold(0.0, f64::max)
                };
                let (vertex, brute) = (most(&vertices), most(&members));
                assert!(
                    (vertex - brute).abs() <= 1e-9 * brute.max(1e-6),
                    "{law}, coefficient {m}: {vertex} {brute}"
                );
                compared += usize::from(brute > 0.0);
            }
        }
        assert!(compared > 10, "{law}: {compared}");
    }
}

/// Walks (position error, time, u) to larger |r_m| from `x`, all in units of their box.
fn walk(mut x: Vec<f64>, f: impl Fn(&[f64]) -> f64) -> (f64, Vec<f64>) {
    let (mut best, mut step) = (f(&x), 0.3);
    while step > 2e-3 {
        let mut moved = false;
        for i in 0..x.len() {
            for by in [step, -step] {
                let mut next = x.clone();
                next[i] = (x[i] + by).clamp(0.0, 1.0);
                let there = f(&next);
                if there > best {
                    (best, x, moved) = (there, next, true);
                }
            }
        }
        step *= if moved { 1.0 } else { 0.4 };
    }
    (best, x)
}

/// q and u at `x`: three errors within the tube of 0.2 rad, time, then u.
fn place(generation: &Generation, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let motion = generation.motion().unwrap();
    let q =
        motion.at(x[3] * motion.duration()).q.iter().zip(x).map(|(q, e)| q + 0.2 * (2.0 * e - 1.0)).collect();
    let ranges = &generation.lagrangian().ranges;
    (q, ranges.iter().zip(&x[4..]).map(|([low, high], x)| low + x * (high - low)).collect())
}

#[test]
fn no_member_exceeds_a_bound_in_torque() {
    for law in ["report", "adaptive"] {
        let generation = uncertain(law, 2, &four_numbers());
        let (arm, lagrangian, reduced, certificates, bounds) = (
            generation.arm(),
            generation.lagrangian(),
            generation.reduced(),
            generation.certificates(),
            generation.bounds(),
        );
        assert_eq!(bounds.b, [0.5, 0.0, 0.2]);
        let mut random = Random::new(5);
        let mut nearest = f64::INFINITY;
        for (m, certificate) in certificates.iter().enumerate().filter(|(_, c)| c.bound > 0.0) {
            let f = |x: &[f64]| {
                let (q, u) = place(&generation, x);
                value(lagrangian, &residual(lagrangian, reduced, m, &u), &q)
            };
            let start =
                |random: &mut Random| (0..8).map(|_| 0.5 + 0.5 * random.signed()).collect::<Vec<f64>>();
            let walks: Vec<_> = (0..24).map(|_| walk(start(&mut random), f)).collect();
            let (most, x) = walks.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a }).unwrap();
            assert!(most <= certificate.bound, "{law}, {m}: {most} > {}", certificate.bound);
            assert!(certificate.ratio() < 1.02);
            assert!(
                (value(
                    lagrangian,
                    &residual(lagrangian, reduced, m, &certificate.parameters),
                    &certificate.witness
                ) - certificate.found)
                    .abs()
                    < 1e-9 * most
            );
            nearest = nearest.min(most / certificate.bound);
            // There the torque of the law's model misses that of the member by no more than the bounds say.
            let (q, u) = place(&generation, &x);
            let member = generation.uncertainty().at(arm, &u);
            let [qd, v_r, a_r] = [(); 3].map(|()| random.vector(3, 3.0));
            let exact = plus_all(&[
                matvec(&mass_matrix(&member, &q), &a_r),
                matvec(&coriolis(&member, &q, &qd), &v_r),
                gravity(&member, &q),
            ]);
            let mine = model(&generation, &q, &[&qd, &v_r, &a_r], &u);
            for i in 0..3 {
                let allowed: f64 = (0..3)
                    .map(|j| {
                        bounds.d[i][j] * a_r[j].abs()
                            + (0..3).map(|k| bounds.h[i][j][k] * (v_r[j] * qd[k]).abs()).sum::<f64>()
                    })
                    .sum();
                let off = (exact[i] - mine[i]).abs();
                assert!(
                    off <= allowed + bounds.g[i] + 1e-12 * largest(&exact),
                    "{law}, {m}, joint {i}: {off}"
                );
            }
        }
        println!("{law}: the walks reach {nearest:.4} of each bound at least");
        assert!(nearest > 0.9, "{law}: {nearest}");
    }
}

/// The torque of the law's model: for a law that learns, at the θ that stands for `u`, which is in its box.
fn model(generation: &Generation, q: &[f64], [qd, v_r, a_r]: &[&[f64]; 3], u: &[f64]) -> Vec<f64> {
    let (Some(regressor), Some(design)) = (&generation.regressor(), &generation.design()) else {
        return generation.code().interpret(q, qd, v_r, a_r);
    };
    let adaptation = design.adaptation.as_ref().unwrap();
    let outputs = regressor.code.interpret(q, qd, v_r, a_r);
    let mut rows = outputs.chunks(3).map(<[f64]>::to_vec);
    let mut sum =
        if regressor.own_base { generation.code().interpret(q, qd, v_r, a_r) } else { rows.next().unwrap() };
    for (k, column) in rows.enumerate() {
        assert!(adaptation.low[k] <= u[k] && u[k] <= adaptation.high[k]);
        sum.iter_mut().zip(column).for_each(|(sum, y)| *sum += u[k] * y);
    }
    sum
}

fn matvec(m: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    m.iter().map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum()).collect()
}

fn plus_all(rows: &[Vec<f64>]) -> Vec<f64> {
    (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).sum()).collect()
}
