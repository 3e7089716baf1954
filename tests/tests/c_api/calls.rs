//! The same calls to a module in C and in Rust, and their answers as text.

use std::fmt::Write as _;

use gramforge_runtime::reference::Reference;
use gramforge_runtime::{ControlStep, Desired, Quantity, StepController};
use gramforge_tests::random::Random;

/// Good states for each module; others with a number that is infinite or NaN lie between.
const STATES: usize = 1000;

/// Calls, a line each, and what Rust answers.
#[derive(Default)]
pub struct Script {
    pub input: String,
    pub answers: Vec<String>,
}

/// A module's controller in Rust, and the letter that the program knows it by.
pub struct Answering<S: ControlStep<3, P>, const P: usize> {
    letter: char,
    controller: StepController<S, 3, P>,
}

fn bits<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> String {
    numbers.into_iter().fold(String::new(), |mut text, x| {
        write!(text, " {:x}", x.to_bits()).expect("text");
        text
    })
}

/// The documented number of a fault.
fn code(quantity: Quantity) -> u32 {
    match quantity {
        Quantity::Position => 1,
        Quantity::Velocity => 2,
        Quantity::DesiredPosition => 3,
        Quantity::DesiredVelocity => 4,
        Quantity::DesiredAcceleration => 5,
        Quantity::Torque => 6,
    }
}

impl<S: ControlStep<3, P, Scalar = f64>, const P: usize> Answering<S, P> {
    pub fn new(letter: char, controller: StepController<S, 3, P>) -> Self {
        Self { letter, controller }
    }

    fn call(&self, script: &mut Script, call: char, numbers: &str, answer: String) {
        writeln!(script.input, "{}{call}{numbers}", self.letter).expect("text");
        script.answers.push(answer);
    }

    /// One step; the fault's number, 0 where there is none.
    fn step(&mut self, script: &mut Script, q: &[f64; 3], qd: &[f64; 3], desired: &Desired<f64, 3>) -> u32 {
        let numbers = bits([q, qd, &desired.q, &desired.qd, &desired.qdd].into_iter().flatten());
        let (fault, answer) = match self.controller.step(q, qd, desired) {
            Ok(command) => {
                let mask = (0..3).fold(0, |mask, i| mask | u32::from(command.saturated[i]) << i);
                (0, format!("0 -1 {mask}{}", bits(&command.torque)))
            }
            Err(fault) => {
                assert!(fault.command.iter().all(|x| x.is_finite()));
                let number = code(fault.quantity);
                (number, format!("{number} {} 0{}", fault.joint, bits(&fault.command)))
            }
        };
        self.call(script, 's', &numbers, answer);
        fault
    }

    fn reference(
        &self,
        script: &mut Script,
        reference: &impl Reference<f64, 3>,
        time: f64,
    ) -> Desired<f64, 3> {
        let desired = reference.at(time);
        let answer = bits(desired.q.iter().chain(&desired.qd).chain(&desired.qdd));
        self.call(script, 'r', &bits([&time]), format!("0{answer}"));
        desired
    }

    /// A state about the motion, every tenth time with a number that is none; the fault's number.
    fn state(
        &mut self,
        script: &mut Script,
        reference: &impl Reference<f64, 3>,
        random: &mut Random,
        index: usize,
    ) -> u32 {
        let time = (0.6 * random.signed() + 0.5) * reference.duration();
        let mut desired = self.reference(script, reference, time);
        let (near, slow) = [(0.01, 0.1), (0.3, 1.0), (0.0, 0.0), (3.0, 10.0)][index % 4];
        let (e, ed): ([f64; 3], [f64; 3]) = (random.array(near), random.array(slow));
        let mut q: [f64; 3] = std::array::from_fn(|i| desired.q[i] + e[i]);
        let mut qd: [f64; 3] = std::array::from_fn(|i| desired.qd[i] + ed[i]);
        self.step(script, &q, &qd, &desired);
        let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX][index / 10 % 4];
        if index % 10 != 9 {
            return 0;
        }
        let place = index / 40;
        let input = [&mut q, &mut qd, &mut desired.q, &mut desired.qd, &mut desired.qdd];
        for (k, input) in input.into_iter().enumerate() {
            if k == place % 5 {
                input[place % 3] = bad;
            }
        }
        let fault = self.step(script, &q, &qd, &desired);
        if !bad.is_finite() {
            assert_eq!(fault as usize, place % 5 + 1, "{bad}");
        }
        self.call(script, 'c', "", format!("0{}", bits(&self.controller.safe_command())));
        fault
    }
}

/// Calls to both modules in turn: states, faults, safe commands, what is learnt, and a start from anew.
pub fn script<A: ControlStep<3, 1, Scalar = f64>, E: ControlStep<3, 0, Scalar = f64>>(
    adaptive: &mut Answering<A, 1>,
    motion: &impl Reference<f64, 3>,
    exact: &mut Answering<E, 0>,
    other: &impl Reference<f64, 3>,
) -> Script {
    let (mut script, mut random) = (Script::default(), Random::new(17));
    let (mut faults, start) = ([0; 7], *adaptive.controller.learnt());
    for index in 0..STATES {
        faults[adaptive.state(&mut script, motion, &mut random, index) as usize] += 1;
        faults[exact.state(&mut script, other, &mut random, index) as usize] += 1;
        let learnt = *adaptive.controller.learnt();
        adaptive.call(&mut script, 'l', "", format!("0{}", bits(&learnt)));
        match index % 400 {
            200 => {
                let half: [f64; 1] = std::array::from_fn(|k| 0.5 * (start[k] + learnt[k]));
                adaptive.controller.restore(half);
                adaptive.call(&mut script, 'p', &bits(&half), "0".to_string());
            }
            399 => {
                assert_ne!(learnt, start, "it has learnt");
                adaptive.controller.reset();
                exact.controller.reset();
                adaptive.call(&mut script, 'x', "", "0".to_string());
                exact.call(&mut script, 'x', "", "0".to_string());
            }
            _ => {}
        }
    }
    assert!(faults.iter().all(|&count| count > 0), "every fault occurs: {faults:?}");
    let cut = script.answers.iter().any(|answer| answer.starts_with("0 -1 7 "));
    assert!(cut, "a limit cuts every joint at once");
    script
}

/// Every answer is that of Rust.
pub fn compare(script: &Script, answers: &[String]) {
    for ((call, ours), theirs) in script.input.lines().zip(&script.answers).zip(answers) {
        assert_eq!(ours, theirs, "{call}");
    }
    assert_eq!(answers.len(), script.answers.len());
}
