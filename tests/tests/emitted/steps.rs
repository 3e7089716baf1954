//! The emitted control step: the bits of its graph, the torque of the runtime's law, the faults of the runtime's loop.

mod lifted;

use std::collections::BTreeMap;

use gramforge::Generation;
use gramforge_generated::{
    arm3_adaptive, arm3_adaptive_guaranteed, arm3_exact, arm3_robust, arm3_xi1, arm3_xi2, arm3_xi3,
    puma560_exact, puma560_one_percent, puma560_xi6, puma560_xi12,
};
use gramforge_runtime::law::{Law, Sample};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::step::Learning;
use gramforge_runtime::{ControlStep, Controller, Desired, Estimate, Model, Real, StepController};
use gramforge_tests::random::Random;
use gramforge_tests::tracked::Tracked;
use gramforge_tests::{edited, generation};
use serde_json::{Value, json};

use lifted::{Learnt, Lift, TrackedModel, tracked_step};

included!(panda ur5 stanford arm3_csv arm3_polynomial arm3_table puma3_union);
included!(step_tight step_switching step_constant step_exact);

macro_rules! each {
    ($check:ident $states:expr; $($name:ident $model:ident),* $(,)?) => {
        $($check(stringify!($name), $name::$model, &$name::LAW, &$name::REFERENCE, $states);)*
    };
}

macro_rules! all {
    ($check:ident, $states:expr) => {
        each!($check $states; arm3_exact Arm3Exact, arm3_xi1 Arm3Xi1, arm3_xi2 Arm3Xi2, arm3_xi3 Arm3Xi3, arm3_robust Arm3Robust,
            puma560_exact Puma560Exact, puma560_one_percent Puma560OnePercent, puma560_xi6 Puma560Xi6, puma560_xi12 Puma560Xi12, arm3_adaptive Arm3Adaptive,
            arm3_adaptive_guaranteed Arm3AdaptiveGuaranteed, panda Panda, ur5 Ur5, stanford Stanford, arm3_csv Arm3Csv,
            arm3_polynomial Arm3Polynomial, arm3_table Arm3Table, puma3_union Puma3Union,
            step_tight StepTight, step_switching StepSwitching, step_constant StepConstant, step_exact StepExact);
    };
}

/// A number from 0 to 1.
fn unit(random: &mut Random) -> f64 {
    0.5 * (random.signed() + 1.0)
}

/// A state about the motion: mostly near it, at times at rest or far away.
struct Instant<const N: usize> {
    q: [f64; N],
    qd: [f64; N],
    desired: Desired<f64, N>,
}

fn instant<const N: usize>(
    random: &mut Random,
    reference: &impl Reference<f64, N>,
    index: usize,
) -> Instant<N> {
    let desired = reference.at((1.2 * unit(random) - 0.1) * reference.duration());
    let (near, slow) = match index % 4 {
        0 => (0.01, 0.1),
        1 => (0.3, 1.0),
        2 => (0.0, 0.0),
        _ => (3.0, 10.0),
    };
    let (e, ed): ([f64; N], [f64; N]) = (random.array(near), random.array(slow));
    Instant {
        q: std::array::from_fn(|i| desired.q[i] + e[i]),
        qd: std::array::from_fn(|i| desired.qd[i] + ed[i]),
        desired,
    }
}

fn theta<const P: usize>(random: &mut Random, made: &Generation) -> [f64; P] {
    let Some(adaptation) = made.design().and_then(|design| design.adaptation.as_ref()) else {
        return [0.0; P];
    };
    std::array::from_fn(|k| adaptation.low[k] + unit(random) * (adaptation.high[k] - adaptation.low[k]))
}

fn same_bits<S, L, const N: usize, const P: usize>(
    name: &str,
    _model: S,
    _law: &L,
    reference: &impl Reference<f64, N>,
    states: usize,
) where
    S: ControlStep<N, P, Scalar = f64>,
{
    let made = generation(name);
    let step = made.step().expect("a controller");
    let mut random = Random::new(31);
    for index in 0..states {
        let Instant { q, qd, desired } = instant(&mut random, reference, index);
        let theta = theta::<P>(&mut random, &made);
        let compiled = S::step(&q, &qd, &desired, &theta);
        let unread = (step.code.outputs.len() > N + P).then_some(compiled.unread);
        let compiled = compiled.limited.iter().chain(&compiled.correction).chain(&unread);
        let compiled: Vec<u64> = compiled.map(|x| x.to_bits()).collect();
        let inputs = [desired.q.as_slice(), &desired.qd, &desired.qdd];
        let interpreted = step.code.interpret_step(&q, &qd, inputs, &theta);
        let interpreted: Vec<u64> = interpreted.iter().map(|x| x.to_bits()).collect();
        assert_eq!(compiled, interpreted, "{name} at {q:?}");
    }
}

#[test]
fn a_step_has_the_bits_of_its_graph() {
    all!(same_bits, 1000);
}

/// The parameters after a period.
fn corrected<T: Real, const P: usize>(
    theta: &[f64; P],
    correction: &[T; P],
    learning: &Learning<f64, P>,
) -> [T; P] {
    let [theta, low, high] = [theta, &learning.low, &learning.high].map(|x| x.map(T::from_f64));
    let mut estimate = Estimate::new(theta);
    estimate.correct(correction, &low, &high);
    *estimate.theta()
}

/// The torque of law and model as the runtime computes it differs by no more than rounding can do on both sides.
fn same_law<S, L, const N: usize, const P: usize>(
    name: &str,
    _model: S,
    law: &L,
    reference: &impl Reference<f64, N>,
    states: usize,
) where
    S: ControlStep<N, P, Scalar = f64>,
    L: Lift,
    for<'a> L::Lifted: Law<TrackedModel<'a, N>, N, State: Learnt<P>>,
{
    let made = generation(name);
    let step = made.step().expect("a controller");
    let model = TrackedModel::<N>::new(&made);
    let lifted = law.lifted();
    let mut random = Random::new(32);
    let (mut worst, mut widest) = (0.0_f64, 0.0_f64);
    for index in 0..states {
        let Instant { q, qd, desired } = instant(&mut random, reference, index);
        let theta = theta::<P>(&mut random, &made);
        let exact = |x: [f64; N]| x.map(Tracked::exact);
        let sample = Sample {
            q: exact(q),
            qd: exact(qd),
            desired: Desired { q: exact(desired.q), qd: exact(desired.qd), qdd: exact(desired.qdd) },
            period: Tracked::exact(S::SETTINGS.period),
        };
        let mut state = lifted.initial_state();
        state.set(&theta);
        let torque = lifted.torque(&model, &mut state, &sample);
        let own = tracked_step(step, &q, &qd, &desired, &theta);
        let own = own.asked.into_iter().chain(corrected(&theta, &own.correction, &S::LEARNING));
        let compiled = S::step(&q, &qd, &desired, &theta);
        let generic = torque.iter().copied().chain(state.get());
        let compiled =
            compiled.asked.into_iter().chain(corrected(&theta, &compiled.correction, &S::LEARNING));
        for ((generic, own), compiled) in generic.zip(own).zip(compiled) {
            assert_eq!(own.value.to_bits(), compiled.to_bits(), "{name}: the oracle walks the same graph");
            let (off, allowed) = ((generic.value - compiled).abs(), generic.error + own.error);
            assert!(off <= allowed, "{name}: {} {compiled}, {off:e} above {allowed:e}", generic.value);
            worst = worst.max(off / allowed);
            widest = widest.max(allowed);
        }
    }
    println!(
        "{name}: {states} states, at most {worst:.3} of what rounding allows, which is up to {widest:.1e} N·m"
    );
}

#[test]
fn a_step_is_its_law_up_to_rounding() {
    all!(same_law, 1000);
}

/// Faults and safe commands are those of the runtime's loop, whichever inputs are spoilt.
fn same_faults<S, L, const N: usize, const P: usize>(
    name: &str,
    model: S,
    law: &L,
    reference: &impl Reference<f64, N>,
    states: usize,
) where
    S: ControlStep<N, P, Scalar = f64> + Model<N, Scalar = f64> + Copy,
    L: Law<S, N> + Copy,
{
    let mut own = StepController::<S, N, P>::new();
    let mut generic = Controller::new(model, *law, S::SETTINGS).unwrap();
    let mut random = Random::new(33);
    let mut faults = 0;
    for index in 0..states {
        let Instant { mut q, mut qd, mut desired } = instant(&mut random, reference, index);
        let spoil = (unit(&mut random) * 12.0) as usize;
        let joint = (unit(&mut random) * N as f64) as usize % N;
        let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300][index % 4];
        let places = [&mut q, &mut qd, &mut desired.q, &mut desired.qd, &mut desired.qdd];
        if let Some(place) = places.into_iter().nth(spoil) {
            place[joint] = bad;
        }
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs()));
        match (own.step(&q, &qd, &desired), generic.step(&q, &qd, &desired)) {
            (Ok(own), Ok(generic)) => {
                for i in 0..N {
                    assert!(close(own.torque[i], generic.torque[i]), "{name}: {own:?} {generic:?}");
                }
            }
            (Err(own), Err(generic)) => {
                faults += 1;
                assert_eq!(
                    (own.quantity, own.joint),
                    (generic.quantity, generic.joint),
                    "{name}: {q:?} {qd:?} {desired:?}"
                );
                for i in 0..N {
                    assert!(close(own.command[i], generic.command[i]), "{name}: {own:?} {generic:?}");
                }
            }
            (own, generic) => panic!("{name}: {own:?} and {generic:?} at {q:?} {qd:?} {desired:?}"),
        }
    }
    assert!(faults > states / 10, "{name}: {faults} faults");
    println!("{name}: {states} steps, {faults} faults, the same");
}

#[test]
fn faults_are_those_of_the_loop() {
    all!(same_faults, 20_000);
}

#[test]
#[ignore = "minutes"]
fn a_step_is_its_law_at_length() {
    all!(same_law, 100_000);
}

#[test]
#[ignore = "minutes"]
fn faults_are_those_of_the_loop_at_length() {
    all!(same_faults, 1_000_000);
}

#[test]
fn a_controller_can_be_a_static_and_is_small() {
    static READY: StepController<puma560_exact::Puma560Exact, 6> = puma560_exact::controller();
    let mut controller = READY;
    let at = puma560_exact::REFERENCE.at(0.1);
    assert!(controller.step(&at.q, &at.qd, &at).is_ok());
    assert_eq!(size_of_val(&READY), (2 * 6 + 1) * 8);
    assert_eq!(size_of_val(&arm3_adaptive::controller()), (2 * 3 + 2 + 1) * 8);
}

/// What a module says of its step is what stands in it.
#[test]
fn published_counts_are_those_of_the_text() {
    for (name, counts) in [
        ("arm3_xi2", [arm3_xi2::STEP_MULTIPLICATIONS, arm3_xi2::STEP_ADDITIONS, arm3_xi2::STEP_CLAMPS]),
        (
            "arm3_adaptive",
            [arm3_adaptive::STEP_MULTIPLICATIONS, arm3_adaptive::STEP_ADDITIONS, arm3_adaptive::STEP_CLAMPS],
        ),
        (
            "puma560_exact",
            [puma560_exact::STEP_MULTIPLICATIONS, puma560_exact::STEP_ADDITIONS, puma560_exact::STEP_CLAMPS],
        ),
        (
            "puma560_one_percent",
            [
                puma560_one_percent::STEP_MULTIPLICATIONS,
                puma560_one_percent::STEP_ADDITIONS,
                puma560_one_percent::STEP_CLAMPS,
            ],
        ),
    ] {
        let text = generation(name).module().unwrap();
        let step = text.split("fn step(").nth(1).expect("a step").split("\n    }\n").next().expect("its end");
        let step = step.split_whitespace().collect::<Vec<_>>().join(" ");
        let count = |word: &str| step.matches(word).count();
        // A constant with a sign is none; what is negated has a letter or a bracket behind it.
        let negated = step.match_indices('-').filter(|(at, _)| {
            step[at + 1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '(')
                && !step[..*at].ends_with(|c: char| c.is_ascii_alphanumeric())
        });
        let additions = count(" + ") + count(" - ") + count(".abs()") + negated.count();
        // The loop takes the corrections off what is learnt.
        let learnt = generation(name).step().expect("a controller").parameters;
        let chosen = count("clamp(") + count("select(") + learnt;
        assert_eq!([count(" * "), additions + 4 * learnt, chosen], counts, "{name}");
    }
}

/// The statements of a module's step: name and right side.
fn statements(text: &str) -> BTreeMap<String, String> {
    let step = text.split("fn step(").nth(1).expect("a step");
    let step = step.split("\n    }\n").next().expect("its end");
    let joined = step.split_whitespace().collect::<Vec<_>>().join(" ");
    let of = |line: &str| {
        let (name, value) = line.trim().strip_prefix("let ")?.split_once(" = ")?;
        Some((name.to_string(), value.to_string()))
    };
    joined.split(';').filter_map(of).collect()
}

#[test]
fn names_stay_from_one_size_to_the_next() {
    for (name, sizes) in [("arm3_xi2", [2, 3]), ("ur5", [4, 6])] {
        let [before, after] = sizes.map(|functions| {
            let of_size = |v: &mut Value| v["model"] = json!({ "shared": { "functions": functions } });
            let made = edited(name, of_size).unwrap_or_else(|message| panic!("{message}"));
            statements(&made.module().unwrap())
        });
        let changed: Vec<_> = after.iter().filter(|&(name, value)| before.get(name) != Some(value)).collect();
        let new = changed.iter().filter(|(name, _)| !before.contains_key(*name)).count();
        // What both have and has no number in it is the same to the letter.
        for (name, value) in &changed {
            let mut words = value.split(|c: char| !c.is_ascii_digit() && c != '.');
            let numbers = words.any(|word| word.parse::<f64>().is_ok_and(|x| x.fract() != 0.0));
            assert!(numbers || !before.contains_key(*name), "{name}: {value}, before {}", before[*name]);
        }
        println!(
            "{name}, {sizes:?} functions: {} of {} statements differ, {new} of them are new",
            changed.len(),
            after.len()
        );
        assert!(new > 0 && 2 * changed.len() < after.len());
    }
}
