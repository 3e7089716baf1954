//! The emitted controller: model and step, interpreted.

use gramforge_runtime::ConfigError;

use super::Scenario;
use super::models::GraphModel;
use super::run::{Rig, Run};
use super::step_law::{MOST_LEARNT, StepLaw};
use crate::control::StepModel;
use crate::error::Error;
use crate::trig::Angle;

/// What a controller is made of.
#[derive(Clone)]
pub(super) struct Controlled<'a, T, const N: usize> {
    /// The emitted model.
    pub(super) model: GraphModel<'a, N>,
    /// The emitted step.
    pub(super) law: StepLaw<T>,
    /// Number of parameters that the law learns.
    pub(super) learnt: usize,
}

impl<'a, T: Angle, const N: usize> Controlled<'a, T, N> {
    pub(super) fn new(scenario: &Scenario<'a>) -> Result<Self, Error> {
        let Scenario { file, arm, design, .. } = *scenario;
        let model = GraphModel::<N>::new(scenario.code, scenario.bounds, arm)?;
        let viscous: Vec<f64> = arm.joints.iter().map(|joint| joint.viscous_friction).collect();
        let step = design.step(&StepModel {
            code: scenario.code,
            regressor: scenario.regressor,
            bounds: scenario.bounds,
            viscous: &viscous,
        });
        let adaptation = design.adaptation.as_ref();
        let learnt = adaptation.map_or(0, |adaptation| adaptation.rate.len());
        if learnt > MOST_LEARNT {
            let help = "learn the `uncertain` parameters";
            let problem = format!("are {learnt}; a simulation bears {MOST_LEARNT}");
            return Err(Error::input(file, "control.adaptation.parameters", problem, help));
        }
        Ok(Self { model, law: StepLaw::new(&step, adaptation), learnt })
    }
}

impl<T: Angle, const N: usize> Controlled<'_, T, N> {
    pub(super) fn run(self, rig: &Rig<N>) -> Result<Run, ConfigError> {
        rig.run(self.model, self.law, self.learnt)
    }
}
