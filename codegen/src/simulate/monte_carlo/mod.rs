//! Many runs of the loop that seek the worst: initial errors, uncertain numbers and disturbances at their limits.
//!
//! What is found stands beside what is certified: it can only be smaller. A run is the sampled loop on the exact arm: law
//! and model are the step graph, interpreted in its number type; the torque is held for a period, within its limits; the
//! arm is integrated in Runge–Kutta steps of at most [`LONGEST_SUBSTEP`]. A run lasts for the motion or until its errors
//! count as settled, whichever is longer, and [`REST`] more. After its end a motion stays where it ends, at rest, but
//! for sinusoids, which go on, as on the device.

mod family;
mod fast_arm;
mod found;
mod frozen;
mod links;
mod plan;
mod push;
mod request;
mod run;
#[cfg(test)]
mod tests;

use gramforge_runtime::ConfigError;

pub use family::Family;
pub use found::{MonteCarlo, Picture};
pub use push::{Against, BoundAtState, ModelErrorBound};
pub use request::{MonteCarloRequest, SETTLE};

use self::fast_arm::FastArm;
use self::frozen::{FrozenLoop, Parts};
use self::plan::Planner;
use self::push::{Emitted, Push};
use self::run::{Instants, Outcome, run};
use super::array::vector;
use super::{Controlled, Rig, Scenario, refused, rig};
use crate::bounds::Rates;
use crate::control::{Design, RobustGain};
use crate::error::Error;
use crate::numerics::linalg::inverse;
use crate::parallel::Parallelize;
use crate::progress::{Progress, Stage};
use crate::spec::{ScalarSpec, SimulationSpec};
use crate::trig::Angle;
use gramforge_runtime::Model;
use gramforge_runtime::reference::Reference;

/// Time after the motion, s.
const REST: f64 = 1.0;
/// Longest Runge–Kutta step, s.
const LONGEST_SUBSTEP: f64 = 0.5e-3;
/// Parts of a run in a picture, at most twice this.
const PARTS: usize = 400;
/// Runs between which what they show is summed up: no more are held at a time.
const BLOCK: usize = 128;

/// Runs the loop `request.runs` times and keeps the largest errors and torques. The same on any number of threads; a
/// longer list begins with the runs of a shorter one.
///
/// # Errors
/// As [`super::simulate`].
pub fn monte_carlo(
    scenario: &Scenario,
    request: &MonteCarloRequest,
    progress: &dyn Progress,
) -> Result<MonteCarlo, Error> {
    let period = scenario.design.period;
    let lasting = scenario.motion.duration().max(request.settle) + REST;
    let substeps = libm::ceil(period / LONGEST_SUBSTEP - 1e-9).max(1.0) as usize;
    let own = scenario.simulation.substeps.unwrap_or(1);
    let simulation = SimulationSpec { duration: Some(lasting), substeps: Some(substeps.max(own)) };
    let scenario = &Scenario { simulation: &simulation, ..*scenario };
    macro_rules! dispatch {
        ($($n:literal)*) => {
            match scenario.arm.dof() {
                $($n => match scenario.scalar {
                    ScalarSpec::F64 => Runs::<f64, $n>::new(scenario, request)?.all(scenario, request, progress),
                    ScalarSpec::F32 => Runs::<f32, $n>::new(scenario, request)?.all(scenario, request, progress),
                },)*
                n => Err(Error::Internal(format!("an arm of {n} joints passed its check"))),
            }
        };
    }
    dispatch!(1 2 3 4 5 6 7 8)
}

/// What all runs share.
struct Runs<'a, T, const N: usize> {
    rig: Rig<'a, N>,
    controlled: Controlled<'a, T, N>,
    /// The arm as specified.
    arm: FastArm<N>,
    planner: Planner<'a, N>,
    bound: [f64; N],
    followed: Vec<(usize, [f64; N])>,
    emitted: Emitted,
    instants: Instants,
}

impl<'a, T: Angle + Send + Sync, const N: usize> Runs<'a, T, N> {
    fn new(scenario: &Scenario<'a>, request: &'a MonteCarloRequest) -> Result<Self, Error> {
        let rig = rig::<N>(scenario, scenario.plant)?;
        let controlled = Controlled::new(scenario)?;
        let arm = FastArm::<N>::new(scenario.plant.clone())?;
        let (period, steps) = (rig.settings.period, rig.steps as usize);
        let instant = |time: f64| (libm::ceil(time / period - 1e-9).max(0.0) as usize).min(steps);
        let (settle, end) = (instant(request.settle), instant(scenario.motion.duration()));
        let design = smooth(scenario, &rig, &arm);
        let smooth =
            Controlled::<f64, N>::new(&Scenario { design: &design, scalar: ScalarSpec::F64, ..*scenario })?;
        let frozen = FrozenLoop::new(&Parts {
            arm: &arm,
            law: &smooth.law,
            reference: &rig.reference,
            period,
            steps,
            family: &request.family,
        });
        let ranges = request.family.ranges();
        Ok(Self {
            planner: Planner { frozen, initial: scenario.initial, ranges, period, settle, end, steps },
            bound: vector("the bound on the model's error", &request.model_error.torque)?,
            followed: request
                .model_error
                .followed
                .iter()
                .map(|(time, torque)| Ok((instant(*time), vector("what was followed", torque)?)))
                .collect::<Result<_, Error>>()?,
            emitted: Emitted::new(scenario.code, scenario.scalar),
            instants: Instants { settle, end, steps, part: (steps / PARTS).max(1) },
            rig,
            controlled,
            arm,
        })
    }

    fn all(
        &self,
        scenario: &Scenario,
        request: &MonteCarloRequest,
        progress: &dyn Progress,
    ) -> Result<MonteCarlo, Error> {
        let stage = Stage::new(progress, "simulated runs", request.runs);
        let mut found = MonteCarlo::new(N, &self.instants, self.rig.settings.period);
        for begin in (0..request.runs).step_by(BLOCK) {
            let block = begin..(begin + BLOCK).min(request.runs);
            let outcomes: Vec<_> = block
                .into_par_iter()
                .map(|index| {
                    let _part = stage.part();
                    self.one(scenario, request, index)
                })
                .collect();
            for outcome in outcomes {
                found.take(&outcome?);
            }
        }
        Ok(found)
    }

    /// Run number `index`.
    fn one(
        &self,
        scenario: &Scenario,
        request: &MonteCarloRequest,
        index: usize,
    ) -> Result<Outcome<N>, Error> {
        let plan = self.planner.plan(index);
        let arm = FastArm::new(request.family.at(&plan.parameters))?;
        let push = Push {
            bound: self.bound,
            followed: &self.followed,
            at_state: request.model_error.at_state.as_ref(),
            exact: match request.model_error.against {
                Against::Exact => None,
                Against::Specified => Some(&self.arm),
                Against::Family => Some(&arm),
            },
            code: &self.emitted,
            p12: &self.rig.gains.p12,
        };
        let Controlled { model, law, .. } = self.controlled.clone();
        let refuse = |error: ConfigError| refused(scenario, &error);
        run(&self.rig, &arm, (model, law), &plan, &push, &self.instants).map_err(refuse)
    }
}

/// The design with a boundary layer in place of a sign function, which has no slope: one in which the error of a period
/// is undone in the next.
fn smooth<const N: usize>(scenario: &Scenario, rig: &Rig<N>, arm: &FastArm<N>) -> Design {
    let Scenario { design, motion, bounds, .. } = *scenario;
    if design.boundary_layer.is_some() {
        return design.clone();
    }
    let rates = Rates::of(motion);
    let gain = match &design.robust_gain {
        RobustGain::Constant(gain) => gain.clone(),
        RobustGain::State => {
            let friction = |i: usize| bounds.b[i] * rates.speed[i] + design.disturbance[i];
            bounds.torque(&rates).iter().enumerate().map(|(i, torque)| torque + friction(i)).collect()
        }
    };
    let inertia = arm.mass_matrix(&rig.reference.at(0.0).q).map(|row| row.to_vec());
    let mobility = inverse(&inertia).unwrap_or_default();
    let layer = |(i, gain): (usize, &f64)| {
        let mobility = mobility.get(i).map_or(1.0, |row| row[i]);
        (2.0 * design.period * gain * mobility).max(f64::EPSILON)
    };
    Design { boundary_layer: Some(gain.iter().enumerate().map(layer).collect()), ..design.clone() }
}
