//! Modules in f32: the bits of their graph, and a rounding that no state exceeds.

use std::array::from_fn;

use gramforge::Generation;
use gramforge_runtime::reference::TickReference;
use gramforge_runtime::{ControlStep, Desired, Model};
use gramforge_tests::random::Random;
use gramforge_tests::{edited, generation};
use serde_json::json;

included!(single_sign single_adaptive single_puma single_panda single_ur5 single_stanford single_tight single_csv);
included!(single_sinusoids);

macro_rules! all {
    ($check:ident) => {
        all!($check; single_sign SingleSign, single_adaptive SingleAdaptive, single_puma SinglePuma, single_panda SinglePanda,
            single_ur5 SingleUr5, single_stanford SingleStanford, single_tight SingleTight, single_csv SingleCsv,
            single_sinusoids SingleSinusoids);
    };
    ($check:ident; $($name:ident $model:ident),* $(,)?) => {
        $($check(stringify!($name), $name::$model, &$name::ROUNDING, &$name::REFERENCE);)*
    };
}

/// A state in the unit cube: time, position errors, velocity errors, θ̂.
type Coordinates = Vec<f64>;

struct Instant<const N: usize, const P: usize> {
    q: [f32; N],
    qd: [f32; N],
    desired: Desired<f32, N>,
    theta: [f32; P],
}

impl<const N: usize, const P: usize> Instant<N, P> {
    fn new(made: &Generation, x: &[f64]) -> Self {
        let rounding = made.rounding().expect("a controller");
        let motion = made.motion().expect("a motion");
        let target = motion.at(0.5 * (x[0] + 1.0) * motion.duration());
        let single = |x: &[f64]| -> [f32; N] { from_fn(|i| x[i] as f32) };
        let desired = Desired { q: single(&target.q), qd: single(&target.qd), qdd: single(&target.qdd) };
        // A hair inside, so that rounding to f32 does not leave the states.
        let about = |centre: &[f64], most: &[f64], from: usize| -> [f32; N] {
            from_fn(|i| (centre[i] + 0.999_999 * x[from + i] * most[i]) as f32)
        };
        let theta = from_fn(|k| match &made.design().and_then(|design| design.adaptation.as_ref()) {
            Some(adaptation) => {
                let (low, high) = (adaptation.low[k], adaptation.high[k]);
                (low + 0.5 * (1.0 + 0.999_999 * x[1 + 2 * N + k]) * (high - low)) as f32
            }
            None => 0.0,
        });
        Self {
            q: about(&target.q, &rounding.states.position_error, 1),
            qd: about(&target.qd, &rounding.states.velocity_error, 1 + N),
            desired,
            theta,
        }
    }

    /// s in f64.
    fn s(&self, made: &Generation) -> [f64; N] {
        let p12 = &made.design().expect("a controller").gains.p12;
        let less = |a: f32, b: f32| f64::from(a) - f64::from(b);
        from_fn(|i| {
            let pulled = (0..N).map(|j| p12[i][j] * less(self.q[j], self.desired.q[j])).sum::<f64>();
            less(self.qd[i], self.desired.qd[i]) + pulled
        })
    }
}

/// |computed − exact| of the torques that are asked for; exact is the graph in f64, which rounds 2⁻²⁹ of what f32 does. `None` where
/// a sign may be the wrong one.
fn off<S, const N: usize, const P: usize>(made: &Generation, x: &[f64]) -> Option<[f64; N]>
where
    S: ControlStep<N, P, Scalar = f32>,
{
    let state = Instant::<N, P>::new(made, x);
    let rounding = made.rounding().expect("a controller");
    if state.s(made).iter().any(|s| s.abs() <= rounding.sign) {
        return None;
    }
    let step = made.step().expect("a controller");
    let mut code = step.code.clone();
    code.outputs = step.asked();
    let real = |x: &[f32]| -> Vec<f64> { x.iter().copied().map(f64::from).collect() };
    let Desired { q, qd, qdd } = &state.desired;
    let (q, qd, qdd) = (real(q), real(qd), real(qdd));
    let exact = code.interpret_step(&real(&state.q), &real(&state.qd), [&q, &qd, &qdd], &real(&state.theta));
    let computed = S::step(&state.q, &state.qd, &state.desired, &state.theta).asked;
    Some(from_fn(|i| (f64::from(computed[i]) - exact[i]).abs()))
}

/// Seeks the largest rounding of each joint: from the best of random states, changing a few numbers at a time.
fn attacked<S, const N: usize, const P: usize>(
    name: &str,
    _model: S,
    published: &[f32; N],
    _reference: &impl TickReference<f32, N>,
) where
    S: ControlStep<N, P, Scalar = f32>,
{
    let made = generation(name);
    let mut random = Random::new(71);
    let variables = 1 + 2 * N + P;
    let check = |x: &[f64]| -> Option<[f64; N]> {
        let off = off::<S, N, P>(&made, x)?;
        for (i, (off, published)) in off.iter().zip(published).enumerate() {
            assert!(*off <= f64::from(*published), "{name}, joint {}: {off:e} above {published:e}", i + 1);
        }
        Some(off)
    };
    let starts: Vec<(Coordinates, [f64; N])> = (0..1000)
        .filter_map(|k| {
            let mut x = random.vector(variables, 1.0);
            // Corners are where numbers are largest.
            if k % 2 == 0 {
                x[1..].iter_mut().for_each(|x| *x = x.signum());
            }
            check(&x).map(|off| (x, off))
        })
        .collect();
    let mut ratios = Vec::new();
    for i in 0..N {
        let (mut best, mut found) =
            starts.iter().max_by(|a, b| a.1[i].total_cmp(&b.1[i])).cloned().expect("states");
        for _ in 0..20_000 / N {
            let mut next = best.clone();
            for _ in 0..2 {
                let place = (0.5 * (random.signed() + 1.0) * variables as f64) as usize % variables;
                next[place] = (next[place] + 0.2 * random.signed()).clamp(-1.0, 1.0);
            }
            match check(&next) {
                Some(off) if off[i] > found[i] => (best, found) = (next, off),
                _ => {}
            }
        }
        ratios.push(f64::from(published[i]) / found[i]);
    }
    println!("{name}: published over largest found, by joint: {ratios:.1?}");
    assert!(ratios.iter().all(|ratio| *ratio <= 20.0), "{name}: {ratios:?}");
}

#[test]
fn no_state_rounds_by_more_than_published() {
    all!(attacked);
}

/// The model alone in f32: its rounding is the part of the torque error that is published as rounding.
fn model_attacked<S, const N: usize>(
    name: &str,
    model: S,
    _published: &[f32; N],
    _reference: &impl TickReference<f32, N>,
) where
    S: Model<N, Scalar = f32>,
{
    let made = generation(name);
    let Some(torque) = made.torque() else { panic!("{name}: the rates are known") };
    let mut random = Random::new(73);
    let mut worst = [0.0_f64; N];
    for k in 0..3000 {
        let mut x = random.vector(1 + 4 * N, 1.0);
        if k % 2 == 0 {
            x[1..].iter_mut().for_each(|x| *x = x.signum());
        }
        let about = |most: &[f64], from: usize| -> [f32; N] {
            from_fn(|i| (0.999_999 * x[from + i] * most[i]) as f32)
        };
        let motion = made.motion().expect("a motion");
        let centre = motion.at(0.5 * (x[0] + 1.0) * motion.duration()).q;
        // Around a motion as far as the tube goes, over a workspace near the motion.
        let width = made.domain().width().unwrap_or_else(|| vec![0.0; N]);
        let q: [f32; N] = from_fn(|i| (centre[i] + 0.999_999 * x[1 + i] * width[i]) as f32);
        let (qd, v_r) = (about(&torque.rates.speed, 1 + N), about(&torque.rates.reference_speed, 1 + 2 * N));
        let a_r = about(&torque.rates.reference_acceleration, 1 + 3 * N);
        let computed = model.passivity_torque(&q, &qd, &v_r, &a_r);
        let real = |x: [f32; N]| x.map(f64::from);
        let exact = made.code().interpret(&real(q), &real(qd), &real(v_r), &real(a_r));
        for i in 0..N {
            let off = (f64::from(computed[i]) - exact[i]).abs();
            assert!(off <= torque.rounding[i], "{name}, joint {}: {off:e}", i + 1);
            assert!(torque.rounding[i] <= torque.error[i], "{name}: the error holds its rounding");
            worst[i] = worst[i].max(off / torque.rounding[i]);
        }
    }
    println!("{name}: the model rounds by at most {worst:.3?} of what is published");
    assert!(worst.iter().any(|part| *part > 0.02));
}

#[test]
fn no_model_in_f32_rounds_by_more_than_its_torque_error_says() {
    all!(model_attacked);
}

/// What f32 rounds by is no part of the model: the same law is promised less.
#[test]
fn a_guarantee_in_f32_counts_its_rounding() {
    // A sign function held for 10 ms chatters too much for a final error below the first one.
    for (name, period) in [("single_sign", 1e-4), ("single_puma", 1e-3), ("single_tight", 1e-3)] {
        let [single, double] = ["f32", "f64"].map(|scalar| {
            let made = edited(name, |spec| {
                spec["emit"] = json!({ "scalar": scalar, "trig": "polynomial" });
                spec["control"]["period"] = json!(period);
            });
            made.unwrap_or_else(|message| panic!("{message}"))
        });
        let [single, double] = [&single, &double].map(|made| &made.design().expect("a controller").guarantee);
        assert_eq!(single.holds, double.holds, "{name}");
        let pairs = || single.final_error.iter().zip(&double.final_error);
        assert!(pairs().all(|(single, double)| single > double), "{name}: {single:?} {double:?}");
    }
}

fn same_bits<S, const N: usize, const P: usize>(
    name: &str,
    _model: S,
    _published: &[f32; N],
    reference: &impl TickReference<f32, N>,
) where
    S: ControlStep<N, P, Scalar = f32>,
{
    let made = generation(name);
    let step = made.step().expect("a controller");
    let mut random = Random::new(72);
    for index in 0..1000_u32 {
        let mut state = Instant::<N, P>::new(&made, &random.vector(1 + 2 * N + P, 1.0));
        if index % 3 == 0 {
            state.desired = reference.at(index);
        }
        let Instant { q, qd, desired, theta } = &state;
        let compiled = S::step(q, qd, desired, theta);
        let compiled = compiled.limited.iter().chain(&compiled.correction).map(|x| x.to_bits());
        let interpreted = step.code.interpret_step(q, qd, [&desired.q, &desired.qd, &desired.qdd], theta);
        let interpreted = interpreted.iter().take(N + P).map(|x| x.to_bits());
        assert!(compiled.eq(interpreted), "{name} at {q:?}");
    }
}

#[test]
fn a_step_in_f32_has_the_bits_of_its_graph() {
    all!(same_bits);
}

/// The motion by the number of the period is that of the specification, within what is published.
fn same_motion<S, const N: usize, const P: usize>(
    name: &str,
    _model: S,
    _published: &[f32; N],
    reference: &impl TickReference<f32, N>,
) where
    S: ControlStep<N, P, Scalar = f32>,
{
    let made = generation(name);
    let motion = made.motion().expect("a motion");
    let period = made.design().expect("a controller").period;
    let allowed = made.rounding().and_then(|rounding| rounding.reference_error()).expect("a motion in f32");
    let last = (motion.duration() / period).ceil() as u32;
    let mut worst = 0.0_f64;
    for tick in 0..last {
        let (own, target) = (reference.at(tick), motion.at(f64::from(tick) * period));
        let pairs = [(&own.q, &target.q), (&own.qd, &target.qd), (&own.qdd, &target.qdd)];
        for ((own, target), allowed) in pairs.into_iter().zip(allowed) {
            for i in 0..N {
                let off = (f64::from(own[i]) - target[i]).abs();
                assert!(off <= allowed[i] + 1e-12, "{name}, period {tick}: {off:e} above {:e}", allowed[i]);
                worst = worst.max(off / allowed[i]);
            }
        }
    }
    println!("{name}: {last} periods, at most {worst:.3} of the error that is published");
    assert!(worst > 0.02);
}

#[test]
fn the_motion_in_f32_is_as_near_as_published() {
    all!(same_motion);
}
