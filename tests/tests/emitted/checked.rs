//! A controller over a workspace without a motion: motions inside its limits keep its promise, others are faults.

use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::{Desired, Guarantee, Quantity, Reason, StepController};
use gramforge_tests::random::Random;

included!(workspace_checked);

use workspace_checked::{GUARANTEE, REFERENCE_LIMITS, SETTINGS, WorkspaceChecked, controller};

/// A motion whose accelerations are at their limits all the time and change sign at once, within the limits of speed and position.
struct Restless {
    desired: Desired<f64, 3>,
    /// Seconds until each joint turns.
    left: [f64; 3],
}

impl Restless {
    fn new() -> Self {
        let middle = |i: usize| 0.5 * (REFERENCE_LIMITS.lowest[i] + REFERENCE_LIMITS.highest[i]);
        Self { desired: Desired::at_rest(std::array::from_fn(middle)), left: [0.0; 3] }
    }

    /// The desired motion at the next sample.
    fn next(&mut self, random: &mut Random) -> Desired<f64, 3> {
        let t = SETTINGS.period;
        for i in 0..3 {
            let most = REFERENCE_LIMITS.acceleration[i];
            let Desired { q, qd, qdd } = &mut self.desired;
            q[i] += t * (qd[i] + 0.5 * t * qdd[i]);
            qd[i] += t * qdd[i];
            self.left[i] -= t;
            let mut wanted = if qdd[i] == 0.0 { most } else { qdd[i] };
            if self.left[i] <= 0.0 {
                wanted = if random.signed() > 0.0 { most } else { -most };
                self.left[i] = 0.02 + 0.2 * (random.signed() + 1.0);
            }
            // Where this would go beyond a limit before it can stop, the joint brakes.
            let faster = qd[i] + t * wanted;
            let after = q[i] + t * (qd[i] + 0.5 * t * wanted);
            let stop = after + faster * faster.abs() / (2.0 * most);
            let edge = 2.0 * t * REFERENCE_LIMITS.velocity[i];
            let far = stop > REFERENCE_LIMITS.highest[i] - edge || stop < REFERENCE_LIMITS.lowest[i] + edge;
            let away =
                (stop > 0.5 * (REFERENCE_LIMITS.lowest[i] + REFERENCE_LIMITS.highest[i])) == (wanted > 0.0);
            if faster.abs() > REFERENCE_LIMITS.velocity[i] || (far && away) {
                wanted = if faster.abs() > REFERENCE_LIMITS.velocity[i] {
                    -most * qd[i].signum()
                } else {
                    -wanted
                };
            }
            qdd[i] = wanted;
        }
        self.desired
    }

    /// The desired motion whose acceleration at the samples is the opposite of that in between: the worst that its limits admit.
    fn opposed(&self) -> Desired<f64, 3> {
        Desired { qdd: self.desired.qdd.map(|x| -x), ..self.desired }
    }
}

#[test]
fn a_motion_inside_the_limits_keeps_the_promise_and_is_no_fault() {
    let Guarantee::Continuous { final_error } = GUARANTEE else { panic!("{GUARANTEE:?}") };
    let mut random = Random::new(1);
    let mut largest = [0.0_f64; 3];
    let mut turns = 0;
    for run in 0..20 {
        let (mut motion, mut controller): (_, StepController<WorkspaceChecked, 3>) =
            (Restless::new(), controller());
        let start = JointState { q: motion.desired.q, qd: [0.0; 3] };
        let plant = RigidPlant { model: WorkspaceChecked, coulomb: [[0.0; 2]; 3] };
        let mut simulation = Simulation::new(plant, start, SETTINGS.period, 2).expect("a simulation");
        let mut before = [0.0; 3];
        for _ in 0..4000 {
            let moving = motion.next(&mut random);
            let desired = if run % 2 == 0 { moving } else { motion.opposed() };
            turns += (0..3).filter(|&i| moving.qdd[i] != before[i]).count();
            before = moving.qdd;
            let state = *simulation.state();
            for i in 0..3 {
                largest[i] = largest[i].max((state.q[i] - desired.q[i]).abs());
            }
            let command = controller.step(&state.q, &state.qd, &desired);
            let command = command.unwrap_or_else(|fault| panic!("{fault}: {desired:?}"));
            simulation.advance(&command.torque).expect("a finite state");
        }
    }
    println!("largest {largest:?} of {final_error:?}, {turns} turns");
    assert!(turns > 600, "{turns}");
    assert!(
        (0..3).all(|i| largest[i] <= final_error[i] && largest[i] > 0.02 * final_error[i]),
        "{largest:?}"
    );
}

#[test]
fn a_motion_beyond_the_limits_is_a_fault_that_names_the_quantity() {
    let rest = Restless::new().desired;
    let (q, qd) = (rest.q, [0.0; 3]);
    let quantities = [Quantity::DesiredPosition, Quantity::DesiredVelocity, Quantity::DesiredAcceleration];
    for (place, quantity) in quantities.into_iter().enumerate() {
        for joint in 0..3 {
            let limit = match place {
                0 => REFERENCE_LIMITS.highest,
                1 => REFERENCE_LIMITS.velocity,
                _ => REFERENCE_LIMITS.acceleration,
            };
            let with = |x: f64| {
                let mut desired = rest;
                [&mut desired.q, &mut desired.qd, &mut desired.qdd][place][joint] = x;
                desired
            };
            let mut controller = controller();
            let command = controller.step(&q, &qd, &with(limit[joint])).expect("the limit itself is inside");
            let fault =
                controller.step(&q, &qd, &with(limit[joint].next_up())).expect_err("beyond it is not");
            assert_eq!((fault.quantity, fault.reason, fault.joint), (quantity, Reason::BeyondLimits, joint));
            assert_eq!(fault.command, command.torque, "the last good command is held");
        }
    }
}
