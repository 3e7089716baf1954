//! A plant under a sampled controller.

use super::{JointState, Plant, rk4_step};
use crate::{
    Command, ConfigError, Desired, Fault, PlantError, Real, Reference, Requirement, TorqueController,
};

/// A plant with its state and clock. The caller loops, one control period at a time, and observes.
#[derive(Clone, Copy, Debug)]
pub struct Simulation<P, T, const N: usize> {
    plant: P,
    state: JointState<T, N>,
    period: T,
    dt: T,
    substeps: u32,
    periods: u32,
}

/// One control instant of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record<T, const N: usize> {
    /// Time of the instant, s.
    pub time: T,
    /// The plant's state at the instant.
    pub state: JointState<T, N>,
    /// The desired motion at the instant.
    pub desired: Desired<T, N>,
    /// What the controller said; after a fault its safe command was applied.
    pub command: Result<Command<T, N>, Fault<T, N>>,
}

impl<T: Real, P: Plant<T, N>, const N: usize> Simulation<P, T, N> {
    /// A plant in a state at time 0, with a control period, s, and the number of Runge–Kutta steps in each.
    ///
    /// # Errors
    /// Names the period when it is not positive and finite, the substeps when there are none.
    pub fn new(plant: P, state: JointState<T, N>, period: T, substeps: u32) -> Result<Self, ConfigError> {
        let error =
            |parameter| Err(ConfigError { parameter, joint: None, requirement: Requirement::Positive });
        if !(period > T::ZERO && period.is_finite()) {
            return error("period");
        }
        if substeps == 0 {
            return error("substeps");
        }
        let dt = period / T::from_f64(f64::from(substeps));
        Ok(Self { plant, state, period, dt, substeps, periods: 0 })
    }

    /// The state now.
    pub fn state(&self) -> &JointState<T, N> {
        &self.state
    }

    /// The time now, s: the periods that have passed times the period, so that no rounding adds up.
    pub fn time(&self) -> T {
        T::from_f64(f64::from(self.periods)) * self.period
    }

    /// Moves the plant on by one control period under a held torque, N·m.
    ///
    /// # Errors
    /// The plant's own, or [`PlantError::Diverged`]; state and time then stay as they were.
    pub fn advance(&mut self, torque: &[T; N]) -> Result<(), PlantError> {
        let mut state = self.state;
        for _ in 0..self.substeps {
            state = rk4_step(&self.plant, &state, torque, self.dt)?;
        }
        self.state = state;
        self.periods = self.periods.saturating_add(1);
        Ok(())
    }

    /// Closes the loop for one control period, which must be the controller's: evaluates the reference, steps the
    /// controller, moves the plant on under its command, and returns what happened at the instant before.
    ///
    /// # Errors
    /// As [`advance`](Simulation::advance).
    pub fn step(
        &mut self,
        controller: &mut impl TorqueController<N, Scalar = T>,
        reference: &impl Reference<T, N>,
    ) -> Result<Record<T, N>, PlantError> {
        let (time, state) = (self.time(), self.state);
        let desired = reference.at(time);
        let command = controller.step(&state.q, &state.qd, &desired);
        let torque = match &command {
            Ok(command) => &command.torque,
            Err(fault) => &fault.command,
        };
        self.advance(torque)?;
        Ok(Record { time, state, desired, command })
    }
}

#[cfg(test)]
mod tests;
