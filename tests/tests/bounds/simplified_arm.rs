//! The recursion of a simpler arm in place of the arm's own: what it computes is what its certificates are about.

use std::path::Path;
use std::sync::OnceLock;

use gramforge::Generation;
use gramforge::internals::bounds::{Effort, Rates};
use gramforge::internals::domain::Domain;
use gramforge::internals::lagrangian::Values;
use gramforge::internals::numerics::low_discrepancy::LowDiscrepancy;
use gramforge::internals::torque::Form;
use gramforge::load::load;
use gramforge::spec::ModelSpec;

const TOLERANCE: f64 = 0.05;

fn made(torque: f64) -> Generation {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/ur5.json");
    let mut loaded = load(&file).unwrap();
    loaded.spec.control = None;
    loaded.spec.model = ModelSpec::Tolerance { torque };
    Generation::with_effort(loaded, &Effort::default().boxes(500)).unwrap()
}

/// A UR5 at 5 %.
fn generation() -> &'static Generation {
    static MADE: OnceLock<Generation> = OnceLock::new();
    MADE.get_or_init(|| made(TOLERANCE))
}

/// Position, speed, reference speed and reference acceleration.
type State = [Vec<f64>; 4];

/// States of the tube, rates in corners of their box.
fn states(generation: &Generation, count: usize) -> impl Iterator<Item = State> + '_ {
    let motion = generation.motion().unwrap();
    let Domain::Tube(_, errors) = generation.domain() else { panic!("no tube") };
    let n = generation.arm().dof();
    let rates = Rates::of(motion);
    let spread = LowDiscrepancy::new(n + 1);
    (0..count).map(move |index| {
        let mut unit = spread.point(index);
        if index % 3 == 0 {
            unit[..n].iter_mut().for_each(|u| *u = u.round());
        }
        let centre = motion.at(motion.duration() * unit[n]).q;
        let q = centre.iter().zip(errors).zip(&unit).map(|((q, e), u)| q + e * (2.0 * u - 1.0)).collect();
        let corner = |rate: &[f64], salt: usize| -> Vec<f64> {
            let bits = (index + 1).wrapping_mul(0x9e37_79b9) >> salt;
            rate.iter().enumerate().map(|(i, r)| if bits >> i & 1 == 1 { -r } else { *r }).collect()
        };
        let (v, w) = (corner(&rates.speed, 5), corner(&rates.reference_speed, 11));
        [q, v, w, corner(&rates.reference_acceleration, 17)]
    })
}

fn torque(values: &Values, [_, v, w, a]: &State) -> Vec<f64> {
    let c = values.coriolis(v);
    let dot = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(k, x)| k * x).sum::<f64>();
    (0..a.len()).map(|i| dot(&values.mass_matrix[i], a) + dot(&c[i], w) + values.gravity[i]).collect()
}

#[test]
fn parameters_are_left_out_and_that_pays() {
    let generation = generation();
    let simplified_arm = generation.reduced().simplified_arm().expect("a recursion of a simpler arm");
    assert_eq!(generation.form(), Form::Recursive);
    assert!(!simplified_arm.parameters.is_empty() && generation.reduced().simplified.contains(&true));
    assert!(generation.code().operations().cost() < generation.exact_code().operations().cost());
}

/// Nearer than 1e-11 of the peak, and within the rounding that the certificates allow for.
#[test]
fn the_code_computes_the_combinations() {
    let generation = generation();
    let peak = &generation.torque().unwrap().peak;
    let rounding = &generation.reduced().simplified_arm().unwrap().rounding;
    let multipliers: Vec<Vec<f64>> = (0..peak.len())
        .map(|i| Rates::of(generation.motion().unwrap()).multipliers(generation.lagrangian(), i))
        .collect();
    for state in states(generation, 300) {
        let values = generation.lagrangian().at_with(&generation.reduced().combinations, &state[0]);
        let expected = torque(&values, &state);
        let computed = generation.code().interpret(&state[0], &state[1], &state[2], &state[3]);
        for i in 0..peak.len() {
            let off = (computed[i] - expected[i]).abs();
            let allowed: f64 = rounding.iter().zip(&multipliers[i]).map(|(r, u)| r * u).sum();
            assert!(off <= 1e-11 * peak[i] && off <= allowed, "joint {}: {off:e} of {allowed:e}", i + 1);
        }
    }
}

#[test]
fn no_state_exceeds_the_certificates() {
    let generation = generation();
    let known = generation.torque().unwrap();
    assert!(known.fraction() <= TOLERANCE);
    let mut worst = 0.0_f64;
    for state in states(generation, 20_000) {
        let model = generation.code().interpret(&state[0], &state[1], &state[2], &state[3]);
        let exact = generation.exact_code().interpret(&state[0], &state[1], &state[2], &state[3]);
        for i in 0..model.len() {
            let error = (model[i] - exact[i]).abs();
            assert!(error <= known.error[i] + 1e-11 * known.peak[i], "joint {}: {error}", i + 1);
            worst = worst.max(error / known.peak[i]);
        }
    }
    assert!(worst > 0.2 * known.fraction(), "an idle certificate: {worst} of {}", known.fraction());
}

/// Every entry at once: what is certified of a coefficient holds of the model that the code computes.
#[test]
fn no_coefficient_exceeds_its_certificate() {
    let generation = generation();
    for state in states(generation, 500) {
        let psi = generation.lagrangian().evaluate_functions(&state[0]);
        for (m, certificate) in generation.certificates().iter().enumerate() {
            let left = generation.reduced().residual(generation.lagrangian(), m);
            let left = gramforge::internals::lagrangian::evaluate(&left, &psi).abs();
            assert!(!generation.reduced().simplified[m] || left <= certificate.bound);
        }
    }
}

#[test]
fn the_same_with_one_thread() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let one = pool.install(|| made(TOLERANCE));
    assert_eq!(one.reduced(), generation().reduced());
    assert_eq!(one.module().unwrap(), generation().module().unwrap());
}

#[test]
fn a_looser_tolerance_costs_no_more() {
    let cost = |generation: &Generation| generation.code().operations().cost();
    let strict = made(0.01);
    assert!(cost(&strict) <= strict.exact_code().operations().cost());
    assert!(cost(generation()) <= cost(&strict));
}
