//! Instructions, stack, sizes and torques of one module.

use core::hint::black_box;

use gramforge_runtime::trig::{Polynomial, Trig};
use gramforge_runtime::{ControlStep, StepController, TickReference};

use crate::board;
use crate::hash::Hash;
use crate::modules::{Case, Control};
use crate::print::{count, line};
use crate::states::Random;

/// States that are measured.
const STATES: u32 = 1000;
/// Instructions of [`idle`] on either core: its result and its return.
const IDLE: u32 = 2;

/// Measures a module and gives it what it must refuse.
pub fn measure<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(case: &Case<S, N, P>) {
    steps(case);
    start(case);
    crate::faults::refuse(case);
}

/// A whole step that does nothing: what remains between it and a real one is the real one.
fn idle<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    _: &mut StepController<S, N, P>,
    _: &[f32; N],
    _: &[f32; N],
    _: u32,
    _: &mut [f32; N],
) -> bool {
    true
}

fn steps<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(case: &Case<S, N, P>) {
    let mut random = Random::new(1);
    let mut controller = StepController::<S, N, P>::new();
    let last = case.reference.end;
    let (mut worst, mut total, mut deepest, mut hash, mut good) = (0, 0, 0, Hash::default(), 0);
    for _ in 0..STATES {
        let tick = random.below(last + 1);
        let desired = case.reference.at(tick);
        let (q, qd) = random.about(&desired, case.error);
        let before = controller;
        let mut torque = [0.0; N];
        let mut call = |control: Control<S, N, P>, how: fn(&mut dyn FnMut()) -> u32| {
            controller = before;
            how(&mut || {
                let control = black_box(control);
                good += u32::from(control(&mut controller, black_box(&q), black_box(&qd), tick, &mut torque));
            })
        };
        let empty = call(idle, board::instructions);
        let empty_stack = call(idle, board::stack);
        let stack = call(case.control, board::stack).wrapping_sub(empty_stack);
        let instructions = call(case.control, board::instructions).wrapping_sub(empty).wrapping_add(IDLE);
        worst = instructions.max(worst);
        total += instructions;
        deepest = stack.max(deepest);
        hash.vector(&torque);
    }
    count(case.name, "instructions_worst", worst);
    count(case.name, "instructions_mean", total / STATES);
    count(case.name, "stack", deepest);
    line(case.name, "torques", hash.value());
    // Each of the four calls of a state must be without a fault.
    line(case.name, "steps_with_fault", u64::from(4 * STATES - good));
}

/// Measures one pair of sine and cosine.
pub fn sines() {
    #[inline(never)]
    fn pair(x: f32) -> (f32, f32) {
        Polynomial.sin_cos(x)
    }
    #[inline(never)]
    fn nothing(x: f32) -> (f32, f32) {
        (x, x)
    }
    let of = |f: fn(f32) -> (f32, f32), x: f32| {
        board::instructions(&mut || {
            black_box(black_box(f)(x));
        })
    };
    let mut random = Random::new(3);
    let (mut worst, mut hash) = (0, Hash::default());
    for _ in 0..STATES {
        let x = random.symmetric() * core::f32::consts::PI;
        let pair: fn(f32) -> (f32, f32) = pair;
        worst = of(pair, x).wrapping_sub(of(nothing, x)).max(worst);
        let (sin, cos) = pair(x);
        hash.vector(&[sin, cos]);
    }
    count("sines", "pair_worst", worst);
    line("sines", "pairs", hash.value());
}

fn start<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(case: &Case<S, N, P>) {
    let mut controller = StepController::<S, N, P>::new();
    let start = black_box(case.start);
    count(case.name, "start", board::instructions(&mut || start(black_box(&mut controller))));
    line(case.name, "controller_bytes", size_of::<StepController<S, N, P>>() as u64);
}
