//! Inputs that a step must refuse, and what it must then command.

use gramforge_runtime::{ControlStep, Desired, Fault, OnFault, Quantity, StepController, TickReference};

use crate::hash::Hash;
use crate::modules::Case;
use crate::print::line;
use crate::states::Random;

/// Gives a module infinite and NaN numbers at every place, and motions outside its domain. Prints how many outcomes were
/// not as documented.
pub fn refuse<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(case: &Case<S, N, P>) {
    let (wrong, commands) = not_finite(case);
    line(case.name, "not_finite_and_wrong", u64::from(wrong));
    line(case.name, "not_finite_commands", commands.value());
    line(case.name, "outside_and_wrong", u64::from(outside(case)));
    let (wrong, saturated) = far(case);
    line(case.name, "far_and_wrong", u64::from(wrong));
    line(case.name, "far_and_saturated", u64::from(saturated));
}

/// The inputs, in the order in which the first fault is named.
const INPUTS: [Quantity; 5] = [
    Quantity::Position,
    Quantity::Velocity,
    Quantity::DesiredPosition,
    Quantity::DesiredVelocity,
    Quantity::DesiredAcceleration,
];

/// One infinite or NaN number at a time: the fault must name it, the command must be safe, the next step good. Returns how
/// many were not, and the hash of the commands.
fn not_finite<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    case: &Case<S, N, P>,
) -> (u32, Hash) {
    let good = case.reference.at(case.reference.end / 2);
    let (mut wrong, mut commands) = (0, Hash::default());
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for input in INPUTS {
            for joint in 0..N {
                let mut controller = StepController::<S, N, P>::new();
                let before = controller.step(&good.q, &good.qd, &good);
                let (mut q, mut qd, mut desired) = (good.q, good.qd, good);
                let x = match input {
                    Quantity::Position => &mut q,
                    Quantity::Velocity => &mut qd,
                    Quantity::DesiredPosition => &mut desired.q,
                    Quantity::DesiredVelocity => &mut desired.qd,
                    Quantity::DesiredAcceleration | Quantity::Torque => &mut desired.qdd,
                };
                if let Some(x) = x.get_mut(joint) {
                    *x = bad;
                }
                let learnt = *controller.learnt();
                let right = match (before, controller.step(&q, &qd, &desired)) {
                    (Ok(before), Err(fault)) => {
                        commands.vector(&fault.command);
                        fault.quantity == input
                            && fault.joint == joint
                            && safe::<S, N, P>(&fault, &before.torque)
                            && *controller.learnt() == learnt
                            && controller.step(&good.q, &good.qd, &good).is_ok()
                    }
                    _ => false,
                };
                wrong += u32::from(!right);
            }
        }
    }
    (wrong, commands)
}

/// Whether the command of a fault is what the policy says.
fn safe<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    fault: &Fault<f32, N>,
    before: &[f32; N],
) -> bool {
    match S::SETTINGS.on_fault {
        OnFault::Hold => fault.command == *before,
        OnFault::Zero => fault.command == [0.0; N],
        OnFault::Gravity => within_limits::<S, N, P>(&fault.command),
    }
}

/// Whether every torque is finite and within its limit.
fn within_limits<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    torque: &[f32; N],
) -> bool {
    torque.iter().zip(&S::SETTINGS.torque_limit).all(|(x, limit)| match limit {
        Some(limit) => x.abs() <= *limit,
        None => x.is_finite(),
    })
}

/// Ticks at the start of the motion and after it: it must stand at its start and at its end.
fn outside<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(case: &Case<S, N, P>) -> u32 {
    let mut wrong = 0;
    for (tick, rest) in [
        (0, case.reference.from),
        (case.reference.end, case.reference.to),
        (case.reference.end + 1, case.reference.to),
        (u32::MAX, case.reference.to),
    ] {
        let desired = case.reference.at(tick);
        let mut controller = StepController::<S, N, P>::new();
        let right = desired == Desired::at_rest(rest)
            && controller
                .step(&desired.q, &desired.qd, &desired)
                .is_ok_and(|command| within_limits::<S, N, P>(&command.torque));
        wrong += u32::from(!right);
    }
    // A desired position that is NaN is a fault.
    let mut controller = StepController::<S, N, P>::new();
    let desired = Desired::at_rest([f32::NAN; N]);
    let right = controller
        .step(&case.reference.from, &[0.0; N], &desired)
        .is_err_and(|fault| fault.quantity == Quantity::DesiredPosition && fault.joint == 0);
    wrong + u32::from(!right)
}

/// Motions and states far outside the domain, up to the largest numbers: a torque within the limits, cut joints marked, or
/// a fault with a safe command. Returns how many were neither, and how many steps had a joint cut.
fn far<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    case: &Case<S, N, P>,
) -> (u32, u32) {
    let mut random = Random::new(2);
    let (mut wrong, mut cut) = (0, 0);
    for far in [1e1, 1e2, 1e4, 1e8, 1e20, 1e38] {
        for _ in 0..20 {
            let mut controller = StepController::<S, N, P>::new();
            let mut desired = case.reference.at(case.reference.end / 2);
            for x in [&mut desired.q, &mut desired.qd, &mut desired.qdd] {
                for x in x {
                    *x += far * random.symmetric();
                }
            }
            let (q, qd) = random.about(&desired, far);
            let right = match controller.step(&q, &qd, &desired) {
                Ok(command) => {
                    cut += u32::from(command.saturated.contains(&true));
                    within_limits::<S, N, P>(&command.torque)
                        && marked::<S, N, P>(&command.torque, &command.saturated)
                }
                Err(fault) => fault.quantity == Quantity::Torque && within_limits::<S, N, P>(&fault.command),
            };
            wrong += u32::from(!right);
        }
    }
    (wrong, cut)
}

/// Whether every joint that is marked as cut stands at its limit.
fn marked<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize>(
    torque: &[f32; N],
    saturated: &[bool; N],
) -> bool {
    let limits = &S::SETTINGS.torque_limit;
    torque.iter().zip(limits).zip(saturated).all(|((x, limit), cut)| !cut || *limit == Some(x.abs()))
}
