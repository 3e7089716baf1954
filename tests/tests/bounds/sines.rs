//! Approximate sines in the generated code: bounds that count them hold, and do not without that part.

use gramforge::Generation;
use gramforge::internals::arm::Arm;
use gramforge::internals::bounds::{Bounds, recursion};
use gramforge::internals::dynamics::{coriolis, gravity, mass_matrix};
use gramforge::internals::graph::Graph;
use gramforge::internals::torque::{Form, recursive};
use gramforge::internals::trig::{Kind, Trig};
use gramforge::load::{Loaded, parse, spec_hash};
use gramforge_tests::random::Random;
use gramforge_tests::{arm, motion, spec};
use serde_json::{Value, json};

fn loaded(name: &str, change: impl Fn(&mut Value)) -> Loaded {
    let path = spec(name);
    let mut value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    change(&mut value);
    parse(&value.to_string(), &path).unwrap_or_else(|error| panic!("{error}"))
}

fn with_trig(name: &str, trig: Value) -> Generation {
    let loaded = loaded(name, |spec| spec["emit"] = json!({ "trig": trig }));
    Generation::new(loaded).unwrap_or_else(|error| panic!("{error}"))
}

/// D, h and G by entries.
struct Entries {
    d: Vec<Vec<f64>>,
    h: Vec<Vec<Vec<f64>>>,
    g: Vec<f64>,
}

fn unit(n: usize, j: usize) -> Vec<f64> {
    (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect()
}

impl Entries {
    fn of(arm: &Arm, q: &[f64]) -> Self {
        let n = arm.dof();
        let c: Vec<_> = (0..n).map(|k| coriolis(arm, q, &unit(n, k))).collect();
        let h = |i: usize, j: usize| (0..n).map(|k| c[k][i][j]).collect();
        Self {
            d: mass_matrix(arm, q),
            h: (0..n).map(|i| (0..n).map(|j| h(i, j)).collect()).collect(),
            g: gravity(arm, q),
        }
    }

    /// What the code computes, by linearity.
    fn computed(code: &Graph, q: &[f64]) -> Self {
        let n = q.len();
        let zero = vec![0.0; n];
        let g = code.interpret(q, &zero, &zero, &zero);
        let less = |x: Vec<f64>| -> Vec<f64> { x.iter().zip(&g).map(|(x, g)| x - g).collect() };
        let mut d = vec![vec![0.0; n]; n];
        let mut h = vec![vec![vec![0.0; n]; n]; n];
        for j in 0..n {
            let column = less(code.interpret(q, &zero, &zero, &unit(n, j)));
            (0..n).for_each(|i| d[i][j] = column[i]);
            for k in 0..n {
                let column = less(code.interpret(q, &unit(n, j), &unit(n, k), &zero));
                (0..n).for_each(|i| h[i][j][k] = column[i]);
            }
        }
        Self { d, h, g }
    }

    fn flat(&self) -> Vec<f64> {
        flat(&self.d, &self.h, &self.g)
    }
}

fn flat(d: &[Vec<f64>], h: &[Vec<Vec<f64>>], g: &[f64]) -> Vec<f64> {
    d.concat().into_iter().chain(h.concat().concat()).chain(g.iter().copied()).collect()
}

/// Largest error/bound over all entries at `q`; entries with the bound 0 may differ by the rounding of the differences.
fn ratio(arm: &Arm, code: &Graph, bounds: &Bounds, q: &[f64]) -> f64 {
    let (exact, computed) = (Entries::of(arm, q).flat(), Entries::computed(code, q).flat());
    let bounds = flat(&bounds.d, &bounds.h, &bounds.g);
    exact.iter().zip(computed).zip(bounds).fold(0.0, |most: f64, ((x, y), bound)| {
        let error = (x - y).abs();
        assert!(
            error.is_finite() && (bound > 0.0 || error < 1e-11),
            "{error} at {q:?}, an entry that counts as exact"
        );
        if bound > 0.0 { most.max(error / bound) } else { most }
    })
}

/// Sine and cosine off by ±`error`, for each joint as the bits of `pattern` say.
fn off(error: f64, q: &[f64], pattern: usize) -> Trig {
    let q = q.to_vec();
    Trig::own(Kind::Polynomial, error, move |x| {
        let joint = q.iter().position(|&q| q == x).unwrap_or(0);
        let sign = |bit: usize| if pattern >> bit & 1 == 1 { error } else { -error };
        let (sin, cos) = gramforge_runtime::Real::sin_cos(x);
        (sin + sign(2 * joint), cos + sign(2 * joint + 1))
    })
}

/// A position of the generation's tube.
fn position(generation: &Generation, random: &mut Random, half_width: f64) -> Vec<f64> {
    let motion = generation.motion().unwrap();
    let t = motion.duration() * (0.5 + 0.5 * random.signed());
    motion.at(t).q.iter().map(|q| q + half_width * random.signed()).collect()
}

#[test]
fn bounds_of_a_reduced_model_hold_for_a_coarse_table() {
    let made = with_trig("arm3_xi2", json!({ "table": { "error": 2e-3 } }));
    assert_eq!(made.code().sines.kind, Kind::Table(16));
    let mut random = Random::new(1);
    let worst = (0..3000).fold(0.0, |most: f64, _| {
        most.max(ratio(made.arm(), made.code(), made.bounds(), &position(&made, &mut random, 0.2)))
    });
    println!("reduced, 16 pairs: largest error/bound {worst:.4}");
    assert!(worst <= 1.0 && worst > 0.5, "{worst}");
    let simplified = made.certificates().iter().zip(&made.reduced().simplified);
    for (certificate, simplified) in simplified {
        assert!(certificate.sines > 0.0 || certificate.bound == 0.0);
        assert!(*simplified || certificate.bound == certificate.sines.next_up() || certificate.bound == 0.0);
    }
}

/// At the states where the residual is largest, with the worst errors that the sines may have.
#[test]
fn the_sines_part_of_the_bounds_is_needed() {
    let made = with_trig("arm3_xi2", json!({ "table": { "error": 0.02 } }));
    let mut code = made.code().clone();
    let (error, whole) = (made.code().sines.error, made.bounds().clone());
    let deltas: Vec<f64> = made.certificates().iter().map(|c| c.bound - c.sines).collect();
    let without = Bounds::new(made.lagrangian(), &deltas);
    let witnesses: Vec<_> = made.certificates().iter().map(|c| c.witness.clone()).collect();
    let (mut most, mut exceeded) = (0.0_f64, 0);
    for q in witnesses.iter().filter(|q| !q.is_empty()) {
        // Equal angles would share their errors.
        let q: Vec<f64> = q.iter().enumerate().map(|(j, q)| q + 1e-12 * j as f64).collect();
        for pattern in 0..64 {
            code.sines = off(error, &q, pattern);
            most = most.max(ratio(made.arm(), &code, &whole, &q));
            let (exact, computed) = (Entries::of(made.arm(), &q).flat(), Entries::computed(&code, &q).flat());
            let bounds = flat(&without.d, &without.h, &without.g);
            let beyond = |((x, y), bound): ((&f64, f64), f64)| bound > 0.0 && (x - y).abs() > bound;
            exceeded += exact.iter().zip(computed).zip(bounds).filter(|entry| beyond(*entry)).count();
        }
    }
    println!(
        "worst errors: largest error/bound {most:.4}; without the sines' part {exceeded} entries exceed it"
    );
    assert!(most <= 1.0 && most > 0.6 && exceeded > 0);
}

#[test]
fn an_exact_expanded_body_has_the_bounds_of_its_sines() {
    let made = with_trig("arm3_exact", json!({ "table": { "error": 1e-3 } }));
    assert_eq!(made.form(), Form::Expanded);
    let mut random = Random::new(2);
    let mut worst = 0.0_f64;
    let (mut adversary, error) = (made.code().clone(), made.code().sines.error);
    for index in 0..500 {
        let q = position(&made, &mut random, 0.2);
        worst = worst.max(ratio(made.arm(), made.code(), made.bounds(), &q));
        adversary.sines = off(error, &q, index % 64);
        worst = worst.max(ratio(made.arm(), &adversary, made.bounds(), &q));
    }
    println!("exact, expanded: largest error/bound {worst:.4}");
    assert!(worst <= 1.0 && worst > 0.3, "{worst}");
    let zero = with_trig("arm3_exact", json!("polynomial"));
    assert!(zero.bounds().d.iter().flatten().chain(&zero.bounds().g).all(|&bound| bound == 0.0));
}

#[test]
fn an_exact_recursive_body_has_the_bounds_of_its_sines() {
    for name in ["ur5", "stanford", "puma3"] {
        let (arm, motion) = (arm(name), motion(name));
        let mut code = recursive(&arm);
        let mut random = Random::new(3);
        for error in [1e-2, 1e-6] {
            let n = arm.dof();
            let mut worst = 0.0_f64;
            for _ in 0..300 {
                let t = motion.duration() * (0.5 + 0.5 * random.signed());
                let q: Vec<f64> = motion.at(t).q.iter().map(|q| q + random.signed()).collect();
                let position_bound: Vec<f64> = q.iter().map(|q| q.abs()).collect();
                let bounds = recursion(&arm, &position_bound, error);
                code.sines = off(error, &q, (random.signed().to_bits() >> 8) as usize % (1 << (2 * n)));
                worst = worst.max(ratio(&arm, &code, &bounds, &q));
            }
            println!("{name}, recursive, sines off by {error:e}: largest error/bound {worst:.4}");
            assert!(worst <= 1.0 && worst > 1e-3, "{name}: {worst}");
        }
    }
}

#[test]
fn an_exact_model_in_recursive_form_is_given_those_bounds() {
    let table = loaded("ur5", |spec| {
        spec["model"] = json!("exact");
        spec["emit"] = json!({ "trig": { "table": { "error": 1e-5 } } });
    });
    let made = Generation::new(table).unwrap();
    assert_eq!(made.form(), Form::Recursive);
    let mut random = Random::new(4);
    for _ in 0..100 {
        let q = position(&made, &mut random, 0.02);
        let worst = ratio(made.arm(), made.code(), made.bounds(), &q);
        assert!(worst <= 1.0, "{worst} at {q:?}");
    }
    assert!(made.certificates().iter().any(|certificate| certificate.bound > 0.0));
    let text = made.module().unwrap();
    assert!(
        text.contains("pub static SINES") && text.contains("The bounds come from the error of the sines")
    );
}

#[test]
fn an_absent_choice_is_libm() {
    let [absent, written] = [None, Some("libm")].map(|trig| {
        let loaded = loaded("arm3_xi1", |spec| {
            if let Some(trig) = trig {
                spec["emit"] = json!({ "trig": trig });
            }
        });
        spec_hash(&loaded).unwrap()
    });
    assert_eq!(absent, written);
    let hash =
        |emit: serde_json::Value| spec_hash(&loaded("arm3_xi1", |spec| spec["emit"] = emit.clone())).unwrap();
    let single = hash(json!({ "scalar": "f32" }));
    assert_eq!(single, hash(json!({ "scalar": "f32", "trig": "polynomial" })));
    assert_ne!(single, hash(json!({ "scalar": "f32", "trig": "libm" })));
}

#[test]
fn what_a_table_cannot_do_is_refused() {
    let refused = |change: &dyn Fn(&mut Value)| {
        Generation::new(loaded("arm3_exact", change)).map(|_| ()).unwrap_err().to_string()
    };
    for error in [0.0, 1e-11, 0.5, -1e-3] {
        let message = refused(&|spec| spec["emit"] = json!({ "trig": { "table": { "error": error } } }));
        assert!(message.contains("emit.trig.table.error") && message.contains("1e-10 to 0.1"), "{message}");
    }
    let message = refused(&|spec| {
        spec["emit"] = json!({ "trig": { "table": { "error": 1e-10 } } });
        spec["motion"]["quintic"]["to"] = json!([5000.0, 1.2, -2.2]);
    });
    println!("{message}");
    assert!(
        message.contains("emit.trig") && message.contains("joint1") && message.contains("libm"),
        "{message}"
    );
}
