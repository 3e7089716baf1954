//! Modules in f32 in a closed loop with a plant in f64: what they publish, what they learn, and the bits of the simulation.

use gramforge::Generation;
use gramforge::internals::arm::Arm;
use gramforge::internals::simulate::{ArmModel, Scenario, simulate};
use gramforge_runtime::reference::{Reference, TickReference};
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::step::ControlStep;
use gramforge_runtime::{
    Command, ConfigError, Desired, Fault, Guarantee, SampledErrors, StepController, TorqueController,
};
use gramforge_tests::{array, edited, generation};
use serde_json::json;

included!(single_adaptive single_guaranteed single_puma);

/// A controller in f32 as a loop in f64 sees it.
struct Narrow<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(StepController<S, N, P>);

impl<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize> TorqueController<N>
    for Narrow<S, N, P>
{
    type Scalar = f64;
    type Learnt = [f32; P];

    fn period(&self) -> f64 {
        f64::from(S::SETTINGS.period)
    }

    fn learnt(&self) -> &[f32; P] {
        self.0.learnt()
    }

    fn step(
        &mut self,
        q: &[f64; N],
        qd: &[f64; N],
        desired: &Desired<f64, N>,
    ) -> Result<Command<f64, N>, Fault<f64, N>> {
        let single = |x: &[f64; N]| x.map(|x| x as f32);
        let desired = Desired { q: single(&desired.q), qd: single(&desired.qd), qdd: single(&desired.qdd) };
        let wide = |x: [f32; N]| x.map(f64::from);
        let Command { torque, saturated } = self.0.step(&single(q), &single(qd), &desired).map_err(
            |Fault { quantity, reason, joint, command }| Fault {
                quantity,
                reason,
                joint,
                command: wide(command),
            },
        )?;
        Ok(Command { torque: wide(torque), saturated })
    }
}

/// The motion by the number of the period, which is what the firmware follows.
struct Ticks<'a, R> {
    reference: &'a R,
    duration: f64,
    period: f64,
}

impl<R: TickReference<f32, N>, const N: usize> Reference<f64, N> for Ticks<'_, R> {
    fn at(&self, t: f64) -> Desired<f64, N> {
        let Desired { q, qd, qdd } = self.reference.at((t / self.period).round() as u32);
        let wide = |x: [f32; N]| x.map(f64::from);
        Desired { q: wide(q), qd: wide(qd), qdd: wide(qdd) }
    }

    fn duration(&self) -> f64 {
        self.duration
    }

    fn check(&self) -> Result<(), ConfigError> {
        Ok(())
    }
}

fn plant<const N: usize>(arm: &Arm) -> RigidPlant<ArmModel<'_, N>, N> {
    let coulomb: Vec<[f64; 2]> = arm.joints.iter().map(|joint| joint.coulomb_friction).collect();
    let coulomb = coulomb.try_into().expect("one entry a joint");
    RigidPlant { model: ArmModel::new(arm).unwrap_or_else(|error| panic!("{error}")), coulomb }
}

/// Bounds on |q − q_d| by joint: at any time, from a time on, at the end of the motion and for ever after. Where the motion has
/// ended, what the initial errors have left is far below any of them.
struct Published<const N: usize> {
    reach: Vec<f64>,
    settle: f64,
    settled: [f64; N],
    end: [f64; N],
}

impl<const N: usize> Published<N> {
    fn of(guarantee: &Guarantee<f32, N>, made: &Generation) -> Self {
        let wide = |x: [f32; N]| x.map(f64::from);
        let duration = made.motion().expect("a motion").duration();
        match *guarantee {
            Guarantee::None => panic!("nothing is published"),
            Guarantee::Continuous { final_error } => Self {
                reach: made.design().expect("a controller").envelope.position_error.clone(),
                settle: duration,
                settled: wide(final_error),
                end: wide(final_error),
            },
            Guarantee::Sampled(SampledErrors {
                reach,
                settle,
                settled_error,
                end_error,
                valid_until,
                ..
            }) => {
                assert_eq!(valid_until, None, "the loop runs for a second behind the motion");
                let settled = wide(settled_error.expect("a motion long enough"));
                Self { reach: wide(reach).to_vec(), settle: f64::from(settle), settled, end: wide(end_error) }
            }
        }
    }

    fn holds(&self, time: f64, end: f64, error: &[f64; N]) -> bool {
        let at_end = (time - end).abs() < 1e-9;
        (0..N).all(|i| {
            error[i] <= self.reach[i]
                && (time < self.settle || error[i] <= self.settled[i])
                && (!at_end || error[i] <= self.end[i])
        })
    }
}

/// The arm moves from its initial error to the end of the motion and stands there for a second.
fn keeps_to_what_is_published<S, R, const N: usize, const P: usize>(
    name: &str,
    controller: StepController<S, N, P>,
    reference: &R,
    guarantee: &Guarantee<f32, N>,
    arm: &Arm,
) where
    S: ControlStep<N, P, Scalar = f32>,
    R: TickReference<f32, N>,
{
    let made = generation(name);
    let published = Published::of(guarantee, &made);
    let period = made.design().expect("a controller").period;
    let motion = made.motion().expect("a motion");
    let reference = Ticks { reference, duration: motion.duration(), period };
    let initial = &made.control().expect("a controller").initial_error;
    let start = motion.at(0.0);
    let [q, qd] = [(&start.q, &initial.position), (&start.qd, &initial.velocity)]
        .map(|(at, off)| std::array::from_fn(|i| at[i] + off[i]));
    let mut simulation = Simulation::new(plant::<N>(arm), JointState { q, qd }, period, 4).unwrap();
    let mut controller = Narrow(controller);
    let mut last = [0.0_f64; N];
    while simulation.time() < motion.duration() + 1.0 {
        let record = simulation.step(&mut controller, &reference).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(record.command.map(|command| command.saturated), Ok([false; N]), "{name}");
        let target = motion.at(record.time);
        let error: [f64; N] = std::array::from_fn(|i| (record.state.q[i] - target.q[i]).abs());
        assert!(
            published.holds(record.time, motion.duration(), &error),
            "{name}, {} s: {error:?}",
            record.time
        );
        if record.time >= motion.duration() {
            last = std::array::from_fn(|i| last[i].max(error[i]));
        }
    }
    println!("{name}: errors at the end {last:.5?}, published {:.5?}", published.end);
}

#[test]
fn a_robust_law_in_f32_keeps_to_its_published_errors() {
    const { assert!(single_puma::GUARANTEE.is_sampled()) };
    let arm = generation("single_puma").given().clone();
    let (controller, reference) = (single_puma::controller(), &single_puma::REFERENCE);
    keeps_to_what_is_published("single_puma", controller, reference, &single_puma::GUARANTEE, &arm);
}

#[test]
fn an_adaptive_law_in_f32_keeps_to_its_published_errors() {
    let made = generation("single_guaranteed");
    for load in [-0.1, 0.1] {
        let arm = made.uncertainty().at(made.given(), &[load]);
        let (controller, reference) = (single_guaranteed::controller(), &single_guaranteed::REFERENCE);
        let guarantee = &single_guaranteed::GUARANTEE;
        keeps_to_what_is_published("single_guaranteed", controller, reference, guarantee, &arm);
    }
}

fn bits(x: impl IntoIterator<Item = f64>) -> Vec<u64> {
    x.into_iter().map(f64::to_bits).collect()
}

#[test]
fn a_run_through_a_module_in_f32_is_the_simulated_one() {
    let short = |spec: &mut serde_json::Value| spec["simulation"] = json!({ "duration": 0.5 });
    let made = edited("single_adaptive", short).unwrap_or_else(|message| panic!("{message}"));
    let scenario = Scenario::of(&made).unwrap_or_else(|error| panic!("{error}"));
    let trace = simulate(&scenario).unwrap_or_else(|error| panic!("{error}")).law.trace;
    let motion = made.motion().expect("a motion");
    let start = motion.at(0.0);
    let q: [f64; 3] = array(&start.q);
    let state = JointState { q: q.map(|q| q + 0.2), qd: array(&start.qd) };
    let period = made.design().expect("a controller").period;
    let mut simulation = Simulation::new(plant::<3>(made.given()), state, period, 10).unwrap();
    let mut controller = Narrow(single_adaptive::controller());
    for (learnt, torque) in trace.parameters.iter().zip(&trace.torque) {
        assert_eq!(bits(controller.learnt().map(f64::from)), bits(learnt.iter().copied()));
        let record = simulation.step(&mut controller, &InDouble(&made)).unwrap();
        let command = record.command.expect("no fault");
        assert_eq!(bits(command.torque), bits(torque.iter().copied()), "at {} s", record.time);
    }
    assert!(trace.parameters.last() != trace.parameters.first(), "it learns");
}

/// The motion as the generator knows it.
struct InDouble<'a>(&'a Generation);

impl Reference<f64, 3> for InDouble<'_> {
    fn at(&self, t: f64) -> Desired<f64, 3> {
        let target = self.0.motion().expect("a motion").at(t);
        Desired { q: array(&target.q), qd: array(&target.qd), qdd: array(&target.qdd) }
    }

    fn duration(&self) -> f64 {
        self.0.motion().expect("a motion").duration()
    }

    fn check(&self) -> Result<(), ConfigError> {
        Ok(())
    }
}

/// The corrections of a slow law are fractions of an ulp of θ̂: f32 would round every one of them to nothing.
#[test]
fn a_slow_law_in_f32_learns_what_it_learns_in_real_numbers() {
    const START: f32 = 0.5;
    const ULP: f64 = 0.5 * f32::EPSILON as f64;
    let made = generation("single_adaptive");
    let step = made.step().expect("a controller");
    for sign in [1.0_f32, -1.0] {
        let mut controller = single_adaptive::controller();
        controller.restore([START]);
        let (mut exact, mut largest) = (f64::from(START), 0.0_f64);
        for tick in 0..5000 {
            let desired = single_adaptive::REFERENCE.at(tick);
            let q = desired.q.map(|q| q + 0.15 * sign);
            let wide = |x: [f32; 3]| x.map(f64::from);
            let inputs = [wide(desired.q), wide(desired.qd), wide(desired.qdd)];
            let inputs = inputs.each_ref().map(<[f64; 3]>::as_slice);
            let correction = step.code.interpret_step(&wide(q), &wide(desired.qd), inputs, &[exact])[3];
            exact -= correction;
            largest = largest.max(correction.abs());
            controller.step(&q, &desired.qd, &desired).expect("no fault");
        }
        let moved = (exact - f64::from(START)) / ULP;
        let off = (f64::from(controller.learnt()[0]) - exact) / ULP;
        println!(
            "corrections up to {:.3} ulp add up to {moved:.1} ulp; θ̂ is {off:.2} ulp off",
            largest / ULP
        );
        assert!(largest < 0.5 * ULP && moved.abs() > 50.0 && off.abs() <= 1.0);
    }
}
