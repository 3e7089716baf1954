//! One run, and what it shows.

use gramforge_runtime::law::Law;
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::{ConfigError, Controller, Model};

use super::fast_arm::FastArm;
use super::plan::Plan;
use super::push::Push;
use crate::simulate::run::{LOST, Rig};

/// Instants that matter, in control periods.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instants {
    /// From when on an error counts as settled.
    pub settle: usize,
    /// Where the motion ends.
    pub end: usize,
    /// Where the run ends.
    pub steps: usize,
    /// Control periods of a part of the picture.
    pub part: usize,
}

/// What one run shows, by joint: errors in rad or m, torques in N·m or N.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outcome<const N: usize> {
    /// Largest |q_e|.
    pub reach: [f64; N],
    /// The same from settling on.
    pub settled: [f64; N],
    /// |q_e| where the motion ends.
    pub end: [f64; N],
    /// Largest |τ| that is commanded.
    pub torque: [f64; N],
    /// Of every part of the run the q_e of largest magnitude.
    pub peaks: Vec<[f64; N]>,
    /// Whether the run could not go on to its end.
    pub lost: bool,
    /// Whether a torque limit has cut a command.
    pub cut: bool,
    /// Whether the model was wrong by more than its bound.
    pub beyond: bool,
}

impl<const N: usize> Outcome<N> {
    fn new(instants: &Instants) -> Self {
        Self {
            reach: [0.0; N],
            settled: [0.0; N],
            end: [0.0; N],
            torque: [0.0; N],
            peaks: vec![[0.0; N]; instants.steps / instants.part + 1],
            lost: false,
            cut: false,
            beyond: false,
        }
    }

    fn see(&mut self, step: usize, error: &[f64; N], instants: &Instants) {
        let raise = |most: &mut [f64; N]| {
            most.iter_mut().zip(error).for_each(|(most, error)| *most = most.max(error.abs()));
        };
        raise(&mut self.reach);
        if step >= instants.settle {
            raise(&mut self.settled);
        }
        if step == instants.end {
            raise(&mut self.end);
        }
        if let Some(peaks) = self.peaks.get_mut(step / instants.part) {
            for (peak, error) in peaks.iter_mut().zip(error) {
                if error.abs() > peak.abs() {
                    *peak = *error;
                }
            }
        }
    }

    /// The run has no error at the instants that it did not come to: the last one, which is large, stands for them.
    fn lose(&mut self, error: &[f64; N]) {
        self.lost = true;
        for most in [&mut self.settled, &mut self.end] {
            most.iter_mut().zip(error).for_each(|(most, error)| *most = most.max(error.abs()));
        }
    }
}

/// Runs `plan` on `arm`.
///
/// # Errors
/// The runtime's, where a number of law, settings or substeps cannot be used.
pub(super) fn run<M, L, const N: usize>(
    rig: &Rig<N>,
    arm: &FastArm<N>,
    (model, law): (M, L),
    plan: &Plan<N>,
    push: &Push<N>,
    instants: &Instants,
) -> Result<Outcome<N>, ConfigError>
where
    M: Model<N, Scalar = f64>,
    L: Law<M, N>,
{
    let mut controller = Controller::new(model, law, rig.settings)?;
    let desired = rig.reference.at(0.0);
    let start = JointState {
        q: std::array::from_fn(|i| desired.q[i] + plan.position[i]),
        qd: std::array::from_fn(|i| desired.qd[i] + plan.velocity[i]),
    };
    let plant = RigidPlant { model: arm, coulomb: rig.coulomb };
    let mut simulation = Simulation::new(plant, start, rig.settings.period, rig.substeps)?;
    let lost = plan.position.iter().fold(LOST, |lost, e| lost.max(LOST + e.abs()));
    let mut out = Outcome::new(instants);
    for step in 0..=instants.steps {
        let JointState { q, qd } = *simulation.state();
        let desired = rig.reference.at(simulation.time());
        let error: [f64; N] = std::array::from_fn(|i| q[i] - desired.q[i]);
        out.see(step, &error, instants);
        if error.iter().any(|e| e.abs() > lost) {
            out.lose(&error);
            break;
        }
        let Some(sides) = plan.sides.get(step) else { break };
        let command = match controller.step(&q, &qd, &desired) {
            Ok(command) => {
                out.cut |= command.saturated.contains(&true);
                command.torque
            }
            Err(fault) => fault.command,
        };
        out.torque.iter_mut().zip(&command).for_each(|(most, torque)| *most = most.max(torque.abs()));
        let (more, beyond) = push.torque(step, &q, &qd, &desired, sides);
        out.beyond |= beyond;
        let torque = std::array::from_fn(|i| command[i] + more[i]);
        if simulation.advance(&torque).is_err() {
            out.lose(&error);
            break;
        }
    }
    Ok(out)
}
