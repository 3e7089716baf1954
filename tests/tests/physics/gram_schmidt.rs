//! The selection (3)–(8) against dense QR factorisations made anew at every step, and what follows from its theory.

use std::sync::Arc;

use gramforge::internals::arm::Arm;
use gramforge::internals::domain::{Domain, Measure};
use gramforge::internals::lagrangian::{Lagrangian, evaluate, expand};
use gramforge::internals::motion::Motion;
use gramforge::internals::reduction::{GramSchmidt, Reduced, Samples, shared, weight};
use gramforge_tests::random::Random;
use gramforge_tests::{arm, difference, largest, motion};
use nalgebra::{DMatrix, DVector};

/// An arm with its expansion and motion.
struct Case {
    arm: Arm,
    lagrangian: Lagrangian,
    motion: Arc<Motion>,
}

impl Case {
    fn of(spec: &str) -> Self {
        let arm = arm(spec);
        Self { lagrangian: expand(&arm), motion: Arc::new(motion(spec)), arm }
    }

    fn measure(&self, domain: &Domain) -> Measure {
        Measure::new(domain, &self.arm)
    }

    fn tube(&self, error: f64) -> Measure {
        self.measure(&Domain::Tube(self.motion.clone(), vec![error; self.arm.dof()]))
    }
}

/// ξ functions in the order of choice and, by coefficient, their least-squares parameters: all by QR, nothing updated.
fn by_qr(lagrangian: &Lagrangian, measure: &Measure, functions: usize) -> (Vec<usize>, Vec<Vec<f64>>) {
    let rows = measure.points.len();
    let column = |value: &dyn Fn(&[f64]) -> f64| {
        DVector::from_fn(rows, |r, _| measure.weights[r].sqrt() * value(&measure.points[r]))
    };
    let psi: Vec<DVector<f64>> =
        lagrangian.functions.iter().map(|f| column(&|q: &[f64]| f.evaluate(q))).collect();
    let alpha: Vec<DVector<f64>> = lagrangian
        .coefficients
        .iter()
        .map(|c| c.terms.iter().fold(DVector::zeros(rows), |sum, &(l, k)| sum + &psi[l] * k))
        .collect();
    let matrix = |chosen: &[usize]| DMatrix::from_fn(rows, chosen.len(), |r, c| psi[chosen[c]][r]);
    let mut chosen: Vec<usize> = Vec::new();
    for j in 1..=functions {
        let counting: Vec<usize> =
            (0..alpha.len()).filter(|&m| lagrangian.coefficients[m].terms.len() > j).collect();
        if counting.is_empty() {
            break;
        }
        let q = matrix(&chosen).qr().q();
        let score = |l: usize| {
            let mut residual = psi[l].clone();
            for _ in 0..2 {
                let along = q.tr_mul(&residual);
                residual -= &q * along;
            }
            let norm = residual.norm_squared();
            if chosen.contains(&l) || norm <= 1e-18 * psi[l].norm_squared() {
                return -1.0;
            }
            let explained = |&m: &usize| {
                let along = residual.dot(&alpha[m]);
                weight(&lagrangian.coefficients[m], measure) * along * along / norm
            };
            counting.iter().map(explained).sum::<f64>()
        };
        let scores: Vec<f64> = (0..psi.len()).map(score).collect();
        let best = scores.iter().copied().fold(-1.0, f64::max);
        // Of equal functions the first.
        chosen.extend(scores.iter().position(|&s| s >= 0.0 && s >= best * (1.0 - 1e-9)));
    }
    let factors = matrix(&chosen).qr();
    let (q, r) = (factors.q(), factors.r());
    let solve = |a: &DVector<f64>| r.solve_upper_triangular(&q.tr_mul(a)).unwrap().as_slice().to_vec();
    (chosen, alpha.iter().map(solve).collect())
}

/// Parameters of coefficient `m` over the kept functions in the order of choice.
fn parameters(reduced: &Reduced, m: usize) -> Vec<f64> {
    let terms = &reduced.combinations[m];
    let of = |l: &usize| terms.iter().find(|(at, _)| at == l).map_or(0.0, |&(_, k)| k);
    reduced.selected.iter().map(of).collect()
}

/// Largest |coefficient| of the expansion.
fn scale(lagrangian: &Lagrangian) -> f64 {
    largest(lagrangian.coefficients.iter().flat_map(|c| c.terms.iter().map(|(_, k)| k)))
}

/// Largest difference of the simplified parameters of two models, as a fraction of the largest coefficient.
fn apart(lagrangian: &Lagrangian, a: &Reduced, b: &Reduced) -> f64 {
    assert_eq!(a.selected, b.selected);
    let simplified = (0..lagrangian.coefficients.len()).filter(|&m| a.simplified[m]);
    let worst = simplified.map(|m| difference(&parameters(a, m), &parameters(b, m))).fold(0.0, f64::max);
    worst / scale(lagrangian)
}

fn compare(name: &str, case: &Case, measure: &Measure, functions: usize) {
    let reduced = shared(&case.lagrangian, measure, functions);
    let (chosen, right) = by_qr(&case.lagrangian, measure, functions);
    assert_eq!(reduced.selected, chosen, "{name}, {functions} functions");
    let simplified = (0..right.len()).filter(|&m| reduced.simplified[m]);
    let worst = simplified.map(|m| difference(&parameters(&reduced, m), &right[m])).fold(0.0, f64::max);
    let worst = worst / scale(&case.lagrangian);
    println!("{name}, {functions} functions: same choice as QR, parameters apart by {worst:.1e}");
    assert!(worst < 1e-9, "{name}, {functions} functions: {worst:e}");
}

#[test]
fn selection_and_parameters_are_those_of_qr() {
    let case = Case::of("arm3_xi2");
    for functions in 1..=6 {
        compare("arm3, tube", &case, &case.tube(0.2), functions);
        compare("arm3, workspace", &case, &case.measure(&Domain::Workspace(case.arm.joint_box())), functions);
    }
    let case = Case::of("puma560_xi12");
    compare("puma560, tube", &case, &case.tube(0.1), 12);
    let case = Case::of("stanford");
    compare("stanford, tube", &case, &case.tube(0.05), 12);
}

#[test]
fn selection_is_nested() {
    for (spec, error) in [("arm3_xi2", 0.2), ("puma560_xi12", 0.1)] {
        let case = Case::of(spec);
        let measure = case.tube(error);
        let choose = |functions| shared(&case.lagrangian, &measure, functions).selected;
        let all = choose(12);
        // No coefficient of the small arm counts at all twelve steps.
        for functions in 1..12 {
            assert_eq!(choose(functions), all[..functions.min(all.len())], "{spec}, {functions} functions");
        }
    }
}

#[test]
fn all_functions_reproduce_the_model() {
    let mut random = Random::new(1);
    for spec in ["arm3_exact", "puma560_exact"] {
        let case = Case::of(spec);
        let (lagrangian, limits) = (&case.lagrangian, case.arm.joint_box());
        let measure = case.measure(&Domain::Workspace(limits.clone()));
        let p = lagrangian.functions.len();
        assert_eq!(
            shared(lagrangian, &measure, p).combinations,
            gramforge::internals::reduction::exact(lagrangian).combinations
        );

        let samples = Samples::new(lagrangian, &measure);
        let mut selection = GramSchmidt::new(&samples);
        while selection.step(&vec![1.0; lagrangian.coefficients.len()]).is_some() {}
        assert_eq!(selection.picks().len(), p, "{spec}: all functions are independent over the workspace");
        let parameters = selection.parameters();
        let (mut worst, mut most) = (0.0_f64, 0.0_f64);
        for _ in 0..200 {
            let q: Vec<f64> =
                limits.iter().map(|[low, high]| low + (high - low) * (0.5 + 0.5 * random.signed())).collect();
            let psi = lagrangian.evaluate_functions(&q);
            for (coefficient, k) in lagrangian.coefficients.iter().zip(&parameters) {
                let picks = selection.picks().iter().zip(k);
                let fitted: f64 = picks.map(|(pick, k)| k * psi[pick.function]).sum();
                let exact = evaluate(&coefficient.terms, &psi);
                worst = worst.max((fitted - exact).abs());
                most = most.max(exact.abs());
            }
        }
        println!("{spec}: {p} of {p} functions reproduce the coefficients to {:.1e}", worst / most);
        assert!(worst <= 1e-9 * most, "{spec}: {worst:e}");
    }
}

#[test]
fn dependent_functions_are_skipped() {
    let mut case = Case::of("arm3_exact");
    // Along a path on which joint 3 rests, cos q3 is a constant.
    case.motion =
        Arc::new(Motion::Quintic { from: vec![0.0, 0.3, -1.2], to: vec![1.5, 1.2, -1.2], duration: 5.0 });
    for case in [case, Case::of("puma560_exact")] {
        let measure = case.measure(&Domain::Path(case.motion.clone()));
        let samples = Samples::new(&case.lagrangian, &measure);
        let mut selection = GramSchmidt::new(&samples);
        while selection.step(&vec![1.0; case.lagrangian.coefficients.len()]).is_some() {}
        let (picks, p) = (selection.picks().len(), case.lagrangian.functions.len());
        println!("{} joints: {picks} of {p} functions are independent along the trajectory", case.arm.dof());
        assert!(picks < p);
        assert!(selection.parameters().iter().flatten().all(|k| k.is_finite()));
        let reduced = shared(&case.lagrangian, &measure, p.min(40));
        assert!(reduced.combinations.iter().flatten().all(|(_, k)| k.is_finite()));
    }
}

#[test]
fn a_thin_tube_is_the_trajectory() {
    let case = Case::of("arm3_xi2");
    for functions in 1..=3 {
        let path = shared(&case.lagrangian, &case.measure(&Domain::Path(case.motion.clone())), functions);
        assert_eq!(shared(&case.lagrangian, &case.tube(0.0), functions), path);
        let thin = apart(&case.lagrangian, &path, &shared(&case.lagrangian, &case.tube(1e-12), functions));
        println!("{functions} functions: a tube of 1e-12 rad is {thin:.1e} from the trajectory");
        assert!(thin < 1e-9, "{thin:e}");
    }
}

#[test]
fn a_tube_as_wide_as_the_joint_box_is_the_workspace() {
    let mut case = Case::of("arm3_xi2");
    let limits = [[-1.0, 2.0], [-0.5, 1.5], [-2.5, -0.3]];
    let middle: Vec<f64> = limits.iter().map(|[low, high]| 0.5 * (low + high)).collect();
    case.motion = Arc::new(Motion::Quintic { from: middle.clone(), to: middle, duration: 1.0 });
    let half = limits.iter().map(|[low, high]| 0.5 * (high - low)).collect();
    let workspace = case.measure(&Domain::Workspace(limits.to_vec()));
    // An arm at rest has no accelerations to weigh with: both forms get the workspace's.
    let tube = Measure {
        acceleration_square: workspace.acceleration_square.clone(),
        velocity_square: workspace.velocity_square.clone(),
        ..case.measure(&Domain::Tube(case.motion.clone(), half))
    };
    for functions in 1..=3 {
        let reduce = |measure| shared(&case.lagrangian, measure, functions);
        let apart = apart(&case.lagrangian, &reduce(&workspace), &reduce(&tube));
        println!("{functions} functions: widest tube {apart:.1e} from the workspace");
        // 3216 points against 4096: the two sums differ by their sampling errors, not by rounding.
        assert!(apart < 0.01, "{apart}");
    }
}

#[test]
fn weights_are_those_of_equation_2() {
    let case = Case::of("arm3_xi2");
    let Motion::Quintic { from, to, duration } = &*case.motion else { panic!("the motion is a quintic") };
    let n = from.len();
    let measure = case.measure(&Domain::Path(case.motion.clone()));
    // By the midpoint rule on the closed form 10 s³ − 15 s⁴ + 6 s⁵, over all places of the full matrices.
    let steps = 20_000;
    let mean = |u: &dyn Fn(f64) -> f64| {
        let at = |k: i32| u((f64::from(k) + 0.5) / f64::from(steps));
        (0..steps).map(|k| at(k) * at(k)).sum::<f64>() / f64::from(steps)
    };
    let speed = |j: usize, s: f64| (to[j] - from[j]) / duration * 30.0 * s * s * (1.0 - s) * (1.0 - s);
    let acceleration =
        |j: usize, s: f64| (to[j] - from[j]) / (duration * duration) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
    let mut worst = 0.0_f64;
    for coefficient in &case.lagrangian.coefficients {
        use gramforge::internals::lagrangian::Entry;
        let stands = |entry: Entry| coefficient.places.iter().any(|place| place.entry == entry);
        let mut right = 0.0;
        for i in 0..n {
            for j in 0..n {
                if stands(Entry::D(i.min(j), i.max(j))) {
                    right += mean(&|s| acceleration(j, s));
                }
                for k in 0..n {
                    if stands(Entry::H(i, j.min(k), j.max(k))) {
                        right += mean(&|s| speed(j, s) * speed(k, s));
                    }
                }
            }
            right += if stands(Entry::G(i)) { 1.0 } else { 0.0 };
        }
        worst = worst.max((weight(coefficient, &measure) / right - 1.0).abs());
    }
    println!("weights against the midpoint rule: {worst:.1e}");
    assert!(worst < 1e-6, "{worst:e}");
    assert!((measure.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
}
