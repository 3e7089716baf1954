//! Prints what is measured and hashed of every module, and of whole loops.
#![cfg_attr(target_os = "none", no_std, no_main)]

use firmware::bench::{Bench, Trouble};
use firmware::control_loop::run;
use firmware::measure::sines;
use firmware::modules::{Case, arm3_exact, arm3_robust, measure_all, puma560_exact, puma560_one_percent};
use firmware::print::{grouped, line};
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::{ControlStep, Model, StepController};

/// Duration of each loop, s.
const SECONDS: f32 = 5.0;

fn program() {
    sines();
    measure_all();
    let blind = |first, many| Trouble { blind: [first, many], ..Trouble::default() };
    let missed = |first, many| Trouble { missed: [first, many], ..Trouble::default() };
    let arm = (&arm3_robust::CASE, arm3_exact::Arm3Exact);
    let puma = (&puma560_one_percent::CASE, puma560_exact::Puma560Exact);
    whole("loop", arm, SECONDS, Trouble::default());
    whole("loop", puma, SECONDS, Trouble::default());
    // Tolerated, then not.
    whole("blind_3", arm, 0.5, blind(100, 3));
    whole("blind_4", arm, 0.5, blind(100, 4));
    whole("missed_5", arm, 0.5, missed(100, 5));
    whole("missed_6", arm, 0.5, missed(100, 6));
    whole("blind_3", puma, 0.5, blind(100, 3));
    whole("missed_6", puma, 0.5, missed(100, 6));
}

/// A whole loop about a simulated arm, which starts at rest a little off the motion.
fn whole<S, M, const N: usize, const P: usize>(
    key: &str,
    (case, model): (&Case<S, N, P>, M),
    seconds: f32,
    trouble: Trouble,
) where
    S: ControlStep<N, P, Scalar = f32>,
    M: Model<N, Scalar = f32>,
{
    let period = S::SETTINGS.period;
    let start = JointState { q: case.reference.from.map(|x| x + 0.01), qd: [0.0; N] };
    let plant = RigidPlant { model, coulomb: [[0.0; 2]; N] };
    let Ok(simulation) = Simulation::new(plant, start, period, 1) else {
        return line(case.name, key, u64::MAX);
    };
    let mut board = Bench::new(simulation, (seconds / period + 0.5) as u32, trouble);
    let mut controller = StepController::<S, N, P>::new();
    let outcome = run(&mut controller, &case.reference, &mut board);
    let say = |what: &str, value: u64| grouped(case.name, key, what, value);
    say("torques", board.hash.value());
    say("steps", outcome.steps.into());
    say("missed", outcome.missed.into());
    say("faults", outcome.faults.into());
    say("stopped", outcome.stopped.into());
    say("fed", board.fed.into());
    say("astray", board.astray.into());
    let off = board.state().q.iter().zip(&case.reference.to).fold(0.0_f32, |most, (q, to)| {
        let off = (q - to).abs();
        if off > most { off } else { most }
    });
    say("end_off", off.to_bits().into());
}

#[cfg(target_os = "none")]
mod entry {
    #![allow(unsafe_code, reason = "the name that the reset handler calls")]

    // Apart from the reset handler, which turns on the floating-point unit that this uses.
    #[unsafe(no_mangle)]
    #[inline(never)]
    extern "C" fn start() -> ! {
        super::program();
        firmware::board::exit(0)
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    program();
}
