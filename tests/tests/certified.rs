//! No published bound is ever exceeded, and none is much larger than it must be.
//!
//! The full version takes a million states an arm, the Panda and a workspace:
//! `cargo test --release -p gramforge-tests --test certified -- --include-ignored --nocapture`

use std::path::{Path, PathBuf};

use gramforge::Generation;
use gramforge::bounds::{Effort, Rates, torque_error};
use gramforge::lagrangian::{Combination, Function, Lagrangian};
use gramforge::load::{load, parse};
use gramforge::measure::Domain;
use gramforge::spread::Spread;

/// What a certificate must live up to.
struct Demand {
    states: usize,
    median: f64,
    worst: f64,
}

const LIGHT: Demand = Demand { states: 20_000, median: 1.02, worst: 1.05 };

fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn generation(path: &str, effort: &Effort) -> Generation {
    Generation::with_effort(load(&file(path)).unwrap(), effort).unwrap()
}

/// A domain as a box: position errors and time, or positions.
struct Space<'a> {
    generation: &'a Generation,
    sides: Vec<[f64; 2]>,
}

impl<'a> Space<'a> {
    fn new(generation: &'a Generation) -> Self {
        let mut sides: Vec<[f64; 2]> = match &generation.domain {
            Domain::Workspace(limits) => limits.clone(),
            Domain::Tube(errors) => errors.iter().map(|e| [-e, *e]).collect(),
            Domain::Trajectory => vec![[0.0; 2]; generation.arm.dof()],
        };
        if let (Some(motion), false) = (&generation.motion, matches!(generation.domain, Domain::Workspace(_)))
        {
            sides.push([0.0, motion.duration()]);
        }
        Self { generation, sides }
    }

    /// The position at the variables `x`.
    fn position(&self, x: &[f64]) -> Vec<f64> {
        match (&self.generation.motion, x.get(self.generation.arm.dof())) {
            (Some(motion), Some(&t)) => motion.at(t).q.iter().zip(x).map(|(q, e)| q + e).collect(),
            _ => x.to_vec(),
        }
    }

    /// Point number `index`; every third one in a corner of the box of positions.
    fn point(&self, spread: &Spread, index: usize) -> Vec<f64> {
        let unit = spread.point(index);
        let n = self.generation.arm.dof();
        let push = |i: usize, u: f64| if index.is_multiple_of(3) && i < n { u.round() } else { u };
        let at = |(i, ([low, high], &u)): (usize, (&[f64; 2], &f64))| low + (high - low) * push(i, u);
        self.sides.iter().zip(&unit).enumerate().map(at).collect()
    }
}

fn value(lagrangian: &Lagrangian, terms: &Combination, q: &[f64]) -> f64 {
    let function = |l: usize| -> &Function { &lagrangian.functions[l] };
    terms.iter().map(|&(l, k)| k * function(l).evaluate(q)).sum::<f64>().abs()
}

/// Walks from `x` to larger |f| along single variables, with steps that shrink.
fn walk(space: &Space, mut x: Vec<f64>, f: impl Fn(&[f64]) -> f64) -> f64 {
    let mut best = f(&space.position(&x));
    let mut step = 0.25;
    while step > 1e-3 {
        let mut moved = false;
        for i in 0..x.len() {
            for direction in [step, -step] {
                let [low, high] = space.sides[i];
                let mut next = x.clone();
                next[i] = (x[i] + direction * (high - low)).clamp(low, high);
                let there = f(&space.position(&next));
                if there > best {
                    (x, best, moved) = (next, there, true);
                }
            }
        }
        if !moved {
            step *= 0.4;
        }
    }
    best
}

fn check(generation: &Generation, demand: &Demand) {
    let Generation { lagrangian, reduced, certificates, .. } = generation;
    let name = &generation.loaded.spec.name;
    let space = Space::new(generation);
    let simplified: Vec<usize> = (0..certificates.len()).filter(|&m| reduced.simplified[m]).collect();
    let residuals: Vec<Combination> =
        (0..certificates.len()).map(|m| reduced.residual(lagrangian, m)).collect();
    for (m, certificate) in certificates.iter().enumerate().filter(|(m, _)| !reduced.simplified[*m]) {
        assert_eq!(certificate.bound, 0.0, "{name}: coefficient {m} is exact");
    }

    // No state of the domain exceeds a bound.
    let spread = Spread::new(space.sides.len());
    let mut largest = vec![(0.0, Vec::new()); certificates.len()];
    for index in 0..demand.states {
        let x = space.point(&spread, index);
        let psi = lagrangian.evaluate_functions(&space.position(&x));
        for &m in &simplified {
            let r = residuals[m].iter().map(|&(l, k)| k * psi[l]).sum::<f64>().abs();
            assert!(r <= certificates[m].bound, "{name}, coefficient {m}: {r} at {x:?}");
            if r > largest[m].0 {
                largest[m] = (r, x.clone());
            }
        }
    }

    println!("{name}\n  coefficient    bound        found        found here   ratio   boxes");
    let mut ratios = Vec::new();
    let mut again = 0;
    for &m in &simplified {
        let certificate = &certificates[m];
        let (bound, found) = (certificate.bound, certificate.found);
        let f = |q: &[f64]| value(lagrangian, &residuals[m], q);
        let here = if largest[m].1.is_empty() { 0.0 } else { walk(&space, largest[m].1.clone(), f) };
        assert!(here <= bound, "{name}, coefficient {m}: {here} > {bound}");
        again += usize::from(here > 0.98 * found);

        // The witness is in the domain and attains what the certificate says.
        let witness = &certificate.witness;
        assert!((f(witness) - found).abs() <= 1e-9 * bound, "{name}, coefficient {m}: {found} not attained");
        let centre = match (&generation.motion, certificate.time) {
            (Some(motion), Some(t)) => motion.at(t).q,
            _ => vec![0.0; witness.len()],
        };
        for ((q, c), [low, high]) in witness.iter().zip(&centre).zip(&space.sides) {
            // A joint on which the residual does not depend stands at 0, which is in every box of errors.
            assert!(*low - 1e-12 <= q - c && q - c <= *high + 1e-12 || *q == 0.0);
        }
        // A bound that is 2 % smaller is exceeded there.
        let ratio = certificate.ratio();
        assert!(ratio >= 1.02 || f(witness) > 0.98 * bound, "{name}, coefficient {m}");
        let coefficient = lagrangian.coefficients[m].name();
        let boxes = certificate.boxes;
        println!("  {coefficient:12} {bound:12.4e} {found:12.4e} {here:12.4e} {ratio:7.4} {boxes:7}");
        ratios.push(ratio);
    }
    ratios.sort_by(f64::total_cmp);
    let (Some(worst), Some(median)) = (ratios.last(), ratios.get(ratios.len() / 2)) else { return };
    println!("  median {median:.4}, worst {worst:.4}; found again {again} of {}", ratios.len());
    assert!(*median <= demand.median, "{name}: median ratio {median}");
    assert!(*worst <= demand.worst, "{name}: worst ratio {worst}");
}

#[test]
fn three_link_arm() {
    for functions in 1..=3 {
        let spec = format!("generated/specs/arm3_xi{functions}.json");
        check(&generation(&spec, &Effort::default()), &LIGHT);
    }
}

#[test]
fn puma() {
    for spec in ["generated/specs/puma560_xi6.json", "generated/specs/puma560_xi12.json"] {
        check(&generation(spec, &Effort::default()), &LIGHT);
    }
}

#[test]
fn arms_with_offset_wrist_and_prismatic_joint() {
    for spec in ["tests/data/ur5.json", "tests/data/stanford.json"] {
        check(&generation(spec, &Effort::default()), &LIGHT);
    }
}

/// The Panda with its last two joints locked.
#[test]
fn five_joints_of_a_panda() {
    let text = r#"{
      "name": "panda5",
      "arm": { "urdf": "panda.urdf", "lock": { "panda_joint6": 1.6, "panda_joint7": 0.6 } },
      "motion": { "quintic": { "from": [-0.4, -0.6, -0.3, -2.2, -0.4], "to": [0.5, 0.3, 0.5, -1.4, 0.5], "duration": 2.5 } },
      "measure": { "tube": { "position_error": 0.05 } },
      "model": { "shared": { "functions": 20 } }
    }"#;
    let loaded = parse(text, &file("tests/data/panda5.json")).unwrap();
    let generation = Generation::with_effort(loaded, &Effort::default()).unwrap();
    check(&generation, &Demand { states: 2_000, ..LIGHT });
}

/// What the model leaves out of D a_r + C v_r + G, at positions of the tube and rates in corners of their box.
#[test]
fn no_state_exceeds_the_torque_error() {
    for spec in
        ["generated/specs/puma560_xi6.json", "tests/data/stanford.json", "generated/specs/arm3_xi1.json"]
    {
        let generation = generation(spec, &Effort::default());
        let Generation { arm, lagrangian, reduced, domain, motion, certificates, .. } = &generation;
        let motion = motion.as_ref().unwrap();
        let rates = Rates::of(motion);
        let most = torque_error(lagrangian, reduced, domain, Some(motion), certificates, &rates);
        let space = Space::new(&generation);
        let (n, spread) = (arm.dof(), Spread::new(space.sides.len()));
        let mut seen = vec![0.0_f64; n];
        for index in 0..2_000 {
            let q = space.position(&space.point(&spread, index));
            let signs = |rate: &[f64], salt: usize| -> Vec<f64> {
                let bits = (index + 1).wrapping_mul(0x9e37_79b9) >> salt;
                rate.iter().enumerate().map(|(i, r)| if bits >> i & 1 == 1 { -r } else { *r }).collect()
            };
            let (v, w) = (signs(&rates.speed, 5), signs(&rates.reference_speed, 11));
            let a = signs(&rates.reference_acceleration, 17);
            let (exact, model) = (lagrangian.at(&q), lagrangian.at_with(&reduced.combinations, &q));
            let (c, d) = (exact.coriolis(&v), model.coriolis(&v));
            for i in 0..n {
                let terms = (0..n).map(|j| {
                    (exact.mass_matrix[i][j] - model.mass_matrix[i][j]) * a[j] + (c[i][j] - d[i][j]) * w[j]
                });
                let error = (terms.sum::<f64>() + exact.gravity[i] - model.gravity[i]).abs();
                // Joints without simplified coefficients have the bound 0; the difference above still rounds.
                assert!(error <= most[i] + 1e-12, "{spec}, joint {}: {error} > {}", i + 1, most[i]);
                seen[i] = seen[i].max(error);
            }
        }
        println!("{spec}: largest torque error seen {seen:.4?}, bound {most:.4?}");
    }
}

#[test]
fn the_bounds_do_not_depend_on_the_number_of_threads() {
    let spec = "generated/specs/puma560_xi12.json";
    let several = generation(spec, &Effort::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let one = pool.install(|| generation(spec, &Effort::default()));
    assert_eq!(several.certificates, one.certificates);
}

#[test]
fn a_spent_budget_still_leaves_a_certificate() {
    let hasty = generation("generated/specs/puma560_xi6.json", &Effort { boxes: 8, ..Effort::default() });
    check(&hasty, &Demand { states: 2_000, median: f64::INFINITY, worst: f64::INFINITY });
}

#[test]
#[ignore = "minutes; see the command above"]
fn full_workspace() {
    let effort = Effort { tolerance: 0.02, boxes: 1_000_000, ..Effort::default() };
    let demand = Demand { states: 1_000_000, median: 1.03, worst: 1.05 };
    check(&generation("tests/data/puma560_workspace.json", &effort), &demand);
}

#[test]
#[ignore = "minutes; see the command above"]
fn full_tubes() {
    let demand = Demand { states: 1_000_000, ..LIGHT };
    for spec in [
        "generated/specs/arm3_xi1.json",
        "generated/specs/puma560_xi12.json",
        "tests/data/ur5.json",
        "tests/data/stanford.json",
    ] {
        check(&generation(spec, &Effort::default()), &demand);
    }
}

#[test]
#[ignore = "minutes; see the command above"]
fn full_panda() {
    let demand = Demand { states: 20_000, median: 1.02, worst: 1.5 };
    check(&generation("tests/data/panda.json", &Effort::default()), &demand);
}
