//! The fixed-step loop, as a firmware has it.

use gramforge_runtime::{ControlStep, StepController, TickReference};

/// What the loop needs of a board with `N` joints.
pub trait Board<const N: usize> {
    /// Waits for the next tick of the timer and returns its number, 0 for the first; `None` ends the loop. Where the loop
    /// was late, numbers are left out.
    fn wait_for_tick(&mut self) -> Option<u32>;

    /// Reads the position, rad or m, and the velocity, rad/s or m/s, of every joint.
    fn encoders(&mut self) -> ([f32; N], [f32; N]);

    /// Sets the torque of every motor, N·m or N, which it holds until the next call.
    fn drive(&mut self, torque: &[f32; N]);

    /// Tells the watchdog that all is well. A watchdog that is not fed puts on the brakes.
    fn feed_watchdog(&mut self);
}

/// More faults in a row than these stop the loop.
pub const FAULTS: u32 = 3;
/// More ticks missed at once than these stop the loop.
pub const MISSED: u32 = 5;

/// How the loop went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Control steps taken.
    pub steps: u32,
    /// Ticks that no step was taken for.
    pub missed: u32,
    /// Steps that had a fault and drove with its safe command.
    pub faults: u32,
    /// Steps whose torque a limit has cut at one joint or more.
    pub saturated: u32,
    /// Whether the loop has stopped and left the arm to the watchdog.
    pub stopped: bool,
}

/// Runs the loop until the board ends it or too much has gone wrong.
pub fn run<S, const N: usize, const P: usize>(
    controller: &mut StepController<S, N, P>,
    reference: &impl TickReference<f32, N>,
    board: &mut impl Board<N>,
) -> Outcome
where
    S: ControlStep<N, P, Scalar = f32>,
{
    let mut outcome = Outcome::default();
    let (mut next, mut in_a_row) = (0, 0);
    while let Some(tick) = board.wait_for_tick() {
        // The motion goes by the number of the tick: a missed one does not delay it, and no rounding adds up.
        let late = tick.wrapping_sub(next);
        next = tick.wrapping_add(1);
        outcome.missed += late;
        let (q, qd) = board.encoders();
        let desired = reference.at(tick);
        match controller.step(&q, &qd, &desired) {
            Ok(command) => {
                in_a_row = 0;
                outcome.saturated += u32::from(command.saturated.contains(&true));
                board.drive(&command.torque);
            }
            Err(fault) => {
                in_a_row += 1;
                outcome.faults += 1;
                board.drive(&fault.command);
            }
        }
        outcome.steps += 1;
        if in_a_row > FAULTS || late > MISSED {
            outcome.stopped = true;
            return outcome;
        }
        board.feed_watchdog();
    }
    outcome
}
