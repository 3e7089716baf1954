//! Expansion and recursion against reference values, the skew symmetry of Ḋ − 2C, and the energy of a free swing.

use gramforge::internals::arm::Arm;
use gramforge::internals::dynamics;
use gramforge::internals::lagrangian::{Entry, Lagrangian, expand};
use gramforge::internals::simulate::ArmModel;
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_tests::truth::{State, Truth};
use gramforge_tests::{arm, array, difference, largest};

/// Reference file and specification of each arm.
const ARMS: [(&str, &str); 5] = [
    ("threedof", "arm3_exact"),
    ("puma560", "puma560_exact"),
    ("stanford", "stanford"),
    ("ur5", "ur5"),
    ("panda", "panda"),
];

/// Error allowed, as a fraction of the arm's largest value of the same kind.
const TOLERANCE: f64 = 1e-9;

/// D, C, G and τ at one state, flat.
type Terms = [Vec<f64>; 4];

fn reference(state: &State) -> Terms {
    [state.mass_matrix().concat(), state.C.concat(), state.G.clone(), state.torque().to_vec()]
}

fn by_recursion(arm: &Arm, state: &State) -> Terms {
    let (q, qd) = (&state.q, &state.qd);
    [
        dynamics::mass_matrix(arm, q).concat(),
        dynamics::coriolis(arm, q, qd).concat(),
        dynamics::gravity(arm, q),
        dynamics::inverse_dynamics(arm, q, qd, &state.qdd),
    ]
}

fn by_expansion(lagrangian: &Lagrangian, state: &State) -> Terms {
    let values = lagrangian.at(&state.q);
    let coriolis = values.coriolis(&state.qd);
    let dot = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
    let torque = (0..lagrangian.dof)
        .map(|i| dot(&values.mass_matrix[i], &state.qdd) + dot(&coriolis[i], &state.qd) + values.gravity[i])
        .collect();
    [values.mass_matrix.concat(), coriolis.concat(), values.gravity.clone(), torque]
}

/// |Ḋ − 2C + (Ḋ − 2C)ᵀ|, with Ḋ by exact differentiation of the expansion.
fn skewness(lagrangian: &Lagrangian, state: &State) -> f64 {
    let n = lagrangian.dof;
    let rates: Vec<f64> = lagrangian
        .functions
        .iter()
        .map(|psi| {
            let partial =
                |k: usize| psi.derivative(k).map_or(0.0, |(f, factor)| factor * f.evaluate(&state.q));
            (0..n).map(|k| partial(k) * state.qd[k]).sum()
        })
        .collect();
    let mut rate = vec![vec![0.0; n]; n];
    for coefficient in &lagrangian.coefficients {
        let value: f64 = coefficient.terms.iter().map(|&(l, k)| k * rates[l]).sum();
        for place in &coefficient.places {
            if let Entry::D(i, j) = place.entry {
                rate[i][j] = place.sign * value;
                rate[j][i] = place.sign * value;
            }
        }
    }
    let c = lagrangian.at(&state.q).coriolis(&state.qd);
    let entry = |i: usize, j: usize| rate[i][j] - 2.0 * c[i][j];
    (0..n * n).map(|at| (entry(at / n, at % n) + entry(at % n, at / n)).abs()).fold(0.0, f64::max)
}

#[test]
fn expansion_and_recursion_give_the_reference_values() {
    println!("largest error over 50 states, as a fraction of the arm's largest value");
    println!("{:9} {:10} {:>9} {:>9} {:>9} {:>9} {:>9}", "arm", "by", "D", "C", "G", "tau", "skew");
    for (name, spec) in ARMS {
        let (truth, arm) = (Truth::of(name), arm(spec));
        assert_eq!(truth.samples.len(), 50);
        let lagrangian = expand(&arm);
        let (mut scale, mut recursion, mut expansion) = ([0.0_f64; 4], [0.0_f64; 4], [0.0_f64; 4]);
        let mut skew = 0.0_f64;
        for state in &truth.samples {
            let right = reference(state);
            let (first, second) = (by_recursion(&arm, state), by_expansion(&lagrangian, state));
            for kind in 0..4 {
                scale[kind] = scale[kind].max(largest(&right[kind]));
                recursion[kind] = recursion[kind].max(difference(&right[kind], &first[kind]));
                expansion[kind] = expansion[kind].max(difference(&right[kind], &second[kind]));
            }
            skew = skew.max(skewness(&lagrangian, state));
        }
        let parts = |errors: [f64; 4]| -> [f64; 4] { std::array::from_fn(|kind| errors[kind] / scale[kind]) };
        let (recursion, expansion, skew) = (parts(recursion), parts(expansion), skew / scale[1]);
        let [d, c, g, tau] = recursion;
        println!("{name:9} {:10} {d:9.1e} {c:9.1e} {g:9.1e} {tau:9.1e}", "recursion");
        let [d, c, g, tau] = expansion;
        println!("{name:9} {:10} {d:9.1e} {c:9.1e} {g:9.1e} {tau:9.1e} {skew:9.1e}", "expansion");
        for error in recursion.into_iter().chain(expansion).chain([skew]) {
            assert!(error <= TOLERANCE, "{name}: {error:e}");
        }
    }
}

/// Change of the total energy over 5 s of free swing from rest, without friction, in Runge–Kutta steps of 1 ms divided
/// by `substeps`, as a fraction of the largest kinetic energy reached. The potential's zero is arbitrary; the kinetic
/// energy is what the arm has exchanged with it, so it is the natural scale.
fn drift<const N: usize>(name: &str, spec: &str, substeps: u32) -> f64 {
    let mut arm = arm(spec);
    arm.joints.iter_mut().for_each(|joint| joint.viscous_friction = 0.0);
    let plant = RigidPlant { model: ArmModel::<N>::new(&arm).unwrap(), coulomb: [[0.0; 2]; N] };
    let state = JointState { q: array::<N>(&Truth::of(name).samples[0].q), qd: [0.0; N] };
    let mut swing = Simulation::new(plant, state, 0.001, substeps).unwrap();
    let total = |state: &JointState<f64, N>| dynamics::energy(&arm, &state.q, &state.qd);
    let (_, before) = total(swing.state());
    let (mut most, mut worst) = (0.0_f64, 0.0_f64);
    for _ in 0..5000 {
        swing.advance(&[0.0; N]).unwrap();
        let (kinetic, potential) = total(swing.state());
        most = most.max(kinetic);
        worst = worst.max((kinetic + potential - before).abs());
    }
    println!("{name}: kinetic energy up to {most:.1} J, drift {:.1e} of it in 1/{substeps} ms", worst / most);
    assert!(most > 1.0, "the arm must swing");
    worst / most
}

#[test]
fn a_free_swing_keeps_its_energy() {
    assert!(drift::<3>("threedof", "arm3_exact", 1) < 1e-7);
    assert!(drift::<6>("puma560", "puma560_exact", 1) < 1e-7);
    assert!(drift::<6>("stanford", "stanford", 1) < 1e-7);
    assert!(drift::<6>("ur5", "ur5", 1) < 1e-7);
    // Without rotors the Panda's wrist spins so fast that 1 ms is coarse; a drift that falls with the fourth power of
    // the step is the integrator's and not the model's.
    let (coarse, fine) = (drift::<7>("panda", "panda", 1), drift::<7>("panda", "panda", 2));
    assert!(fine < 1e-7 && coarse > 10.0 * fine);
}
