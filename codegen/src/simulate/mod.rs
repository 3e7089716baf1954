//! Closed-loop simulation, with the very laws and the very controller that run on the device.
//!
//! The plant is an exact arm, by default that of the specification; the law under test knows only the reduced model.

mod array;
mod chatter;
mod controlled;
#[cfg(test)]
pub(crate) mod example;
mod metrics;
mod models;
mod monte_carlo;
mod reference;
mod run;
mod step_law;
mod torque_error;

use std::path::Path;

use gramforge_runtime::law::{ExactLaw, Gains};
use gramforge_runtime::simulate::JointState;
use gramforge_runtime::{ConfigError, OnFault, Settings};
use serde::Serialize;

pub use chatter::{Chatter, chatter};
pub use metrics::{CONVERGED, Metrics};
pub use models::{ArmModel, GraphModel};
pub use monte_carlo::{
    Against, BoundAtState, Family, ModelErrorBound, MonteCarlo, MonteCarloRequest, Picture, SETTLE,
    monte_carlo,
};
pub use run::{Run, Trace};
pub use step_law::MOST_LEARNT;
pub use torque_error::largest_torque_error;

use self::array::{matrix, vector};
use self::controlled::Controlled;
use self::reference::MotionReference;
use self::run::Rig;
use crate::arm::Arm;
use crate::bounds::Bounds;
use crate::check::InitialError;
use crate::control::Design;
use crate::error::Error;
use crate::graph::Graph;
use crate::motion::Motion;
use crate::number::scientific;
use crate::pipeline::Generation;
use crate::spec::{LawSpec, OnFaultSpec, ScalarSpec, SimulationSpec};
use crate::torque::Regressor;

/// Runge–Kutta steps a control period, where the specification names none.
const SUBSTEPS: usize = 10;
/// Most Runge–Kutta steps of a run: some minutes of computing.
const MOST_STEPS: f64 = 1e8;

/// Most control periods of a run: every one is recorded.
const MOST_PERIODS: f64 = 1e6;

/// Everything that a simulation needs.
#[derive(Clone, Copy, Debug)]
pub struct Scenario<'a> {
    /// The specification, which errors name.
    pub file: &'a Path,
    /// The arm that the models were made for: the specification's, with its rotations rounded.
    pub arm: &'a Arm,
    /// The plant: the arm as the specification gives it.
    pub plant: &'a Arm,
    /// The desired motion.
    pub motion: &'a Motion,
    /// Law, gains, period and limits.
    pub design: &'a Design,
    /// The passivity torque of the exact model.
    pub exact: &'a Graph,
    /// The passivity torque of the reduced model.
    pub code: &'a Graph,
    /// What the reduced model leaves out.
    pub bounds: &'a Bounds,
    /// The torque as a function of what the law learns.
    pub regressor: Option<&'a Regressor>,
    /// Error at time 0: the arm starts at q_d + position, q̇_d + velocity.
    pub initial: &'a InitialError,
    /// Duration and substeps.
    pub simulation: &'a SimulationSpec,
    /// Number type of the controller.
    pub scalar: ScalarSpec,
}

impl<'a> Scenario<'a> {
    /// What a specification describes.
    ///
    /// # Errors
    /// [`Error::Input`] where it has no motion or no controller.
    pub fn of(generation: &'a Generation) -> Result<Self, Error> {
        let file = generation.path();
        let missing = |field: &str, what: &str| {
            let help = format!("add `{field}` to the specification");
            Error::input(file, field, format!("is missing, but a simulation needs {what}"), help)
        };
        let control = generation.control().ok_or_else(|| missing("control", "a law"));
        Ok(Self {
            file,
            arm: generation.arm(),
            plant: generation.given(),
            exact: generation.exact_code(),
            motion: generation.motion().ok_or_else(|| missing("motion", "a desired motion"))?,
            design: generation.design().ok_or_else(|| missing("control", "a law"))?,
            code: generation.code(),
            bounds: generation.bounds(),
            regressor: generation.regressor(),
            initial: &control?.initial_error,
            simulation: &generation.spec().simulation,
            scalar: generation.spec().emit.scalar,
        })
    }
}

/// The same motion of the same arm under two laws with the same gains, period and limits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Equation (16) with the exact model.
    pub exact: Run,
    /// The specification's law with the reduced model.
    pub law: Run,
    /// Which law that is.
    pub law_kind: LawSpec,
    /// φ of its boundary layer by joint; `None` for the sign function.
    pub boundary_layer: Option<Vec<f64>>,
}

/// Runs both laws. A run that diverges is a result, not an error: see [`Metrics::diverged_at`].
///
/// # Errors
/// [`Error::Input`] where a number of control or simulation cannot be used, [`Error::Internal`] where the parts of
/// the scenario do not belong to the same arm of 1 to 8 joints.
pub fn simulate(scenario: &Scenario) -> Result<Comparison, Error> {
    simulate_on(scenario, scenario.plant)
}

/// The same on a plant that is not the arm of the specification, such as one that carries another load: both laws know
/// the arm of the specification.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_on(scenario: &Scenario, plant: &Arm) -> Result<Comparison, Error> {
    let (exact, law) =
        rayon::join(|| of_dimension(scenario, plant, false), || of_dimension(scenario, plant, true));
    let design = scenario.design;
    Ok(Comparison {
        exact: exact?,
        law: law?,
        law_kind: design.law,
        boundary_layer: design.boundary_layer.clone(),
    })
}

/// The run of the scenario's own law alone.
///
/// # Errors
/// As [`simulate`].
pub(crate) fn simulate_law(scenario: &Scenario) -> Result<Run, Error> {
    of_dimension(scenario, scenario.plant, true)
}

/// One run: of the scenario's own law, or of equation (16).
fn of_dimension(scenario: &Scenario, plant: &Arm, own: bool) -> Result<Run, Error> {
    macro_rules! dispatch {
        ($($n:literal)*) => {
            match scenario.arm.dof() {
                $($n => if own { law::<$n>(scenario, plant) } else { exact::<$n>(scenario, plant) },)*
                n => Err(Error::Internal(format!("an arm of {n} joints passed its check"))),
            }
        };
    }
    dispatch!(1 2 3 4 5 6 7 8)
}

/// Equation (16) with the exact model.
fn exact<const N: usize>(scenario: &Scenario, plant: &Arm) -> Result<Run, Error> {
    let rig = rig::<N>(scenario, plant)?;
    let model = GraphModel::<N>::exact(scenario.exact, scenario.arm)?;
    let law = ExactLaw { gains: rig.gains, coulomb: vector("Coulomb friction", &scenario.design.coulomb)? };
    rig.run(model, law, 0).map_err(|error| refused(scenario, &error))
}

/// The scenario's own law with the reduced model.
fn law<const N: usize>(scenario: &Scenario, plant: &Arm) -> Result<Run, Error> {
    let rig = rig::<N>(scenario, plant)?;
    let run = match scenario.scalar {
        ScalarSpec::F64 => Controlled::<f64, N>::new(scenario)?.run(&rig),
        ScalarSpec::F32 => Controlled::<f32, N>::new(scenario)?.run(&rig),
    };
    run.map_err(|error| refused(scenario, &error))
}

fn refused(scenario: &Scenario, error: &ConfigError) -> Error {
    let help = "correct the number of the control or simulation section that it comes from";
    Error::input(scenario.file, "control", error.to_string(), help)
}

fn rig<'a, const N: usize>(scenario: &Scenario<'a>, plant: &'a Arm) -> Result<Rig<'a, N>, Error> {
    let Scenario { motion, design, initial, .. } = *scenario;
    let coulomb: Vec<[f64; 2]> = plant.joints.iter().map(|joint| joint.coulomb_friction).collect();
    let (steps, substeps) = steps(scenario)?;
    Ok(Rig {
        plant: ArmModel::new(plant)?,
        coulomb: vector("the arm", &coulomb)?,
        reference: MotionReference::new(motion)?,
        initial: JointState {
            q: vector("the initial error", &initial.position)?,
            qd: vector("the initial error", &initial.velocity)?,
        },
        gains: Gains {
            p12: matrix("P12", &design.gains.p12)?,
            damping: matrix("K", &design.gains.damping)?,
            pqq: matrix("Pqq", &design.gains.pqq)?,
        },
        settings: Settings {
            period: design.period,
            torque_limit: vector("the torque limits", &design.torque_limit)?,
            on_fault: match design.on_fault {
                OnFaultSpec::Hold => OnFault::Hold,
                OnFaultSpec::Zero => OnFault::Zero,
                OnFaultSpec::Gravity => OnFault::Gravity,
            },
        },
        substeps,
        steps,
    })
}

/// Control periods of the run, and Runge–Kutta steps in each.
fn steps(scenario: &Scenario) -> Result<(u32, u32), Error> {
    let Scenario { file, motion, design, simulation, .. } = *scenario;
    let duration = simulation.duration.unwrap_or(motion.duration());
    let refuse = |field: &str, problem: String, help: &str| Err(Error::input(file, field, problem, help));
    if !(duration.is_finite() && duration > 0.0) {
        return refuse(
            "simulation.duration",
            format!("is {} s", scientific(duration)),
            "write a positive number of seconds",
        );
    }
    let substeps = simulation.substeps.unwrap_or(SUBSTEPS);
    if substeps == 0 {
        return refuse("simulation.substeps", "is 0".to_string(), "write at least 1, or leave it out for 10");
    }
    // A duration of whole periods must not get one more from rounding.
    let periods = libm::ceil(duration / design.period - 1e-9).max(1.0);
    let total = periods * substeps as f64;
    // A period of zero gives infinity or NaN.
    if total.is_nan() || total > MOST_STEPS {
        return refuse(
            "simulation",
            format!(
                "{} s in periods of {} s with {substeps} substeps are {} steps",
                scientific(duration),
                scientific(design.period),
                scientific(total)
            ),
            "simulate a shorter time, or take fewer substeps, to stay under 1e8 steps",
        );
    }
    if periods > MOST_PERIODS {
        return refuse(
            "simulation.duration",
            format!("takes {} control periods of {} s", scientific(periods), scientific(design.period)),
            "simulate a shorter time, to stay under 1e6 periods: each of them is recorded",
        );
    }
    Ok((periods as u32, substeps as u32))
}

#[cfg(test)]
mod tests;
