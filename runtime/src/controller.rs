//! The fixed-step control loop.

use crate::law::{Law, Sample};
use crate::vector::first_not_finite;
use crate::{ConfigError, Desired, Fault, Model, Quantity, Real, Reason, Requirement};

/// What the controller commands when a number is infinite or NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum OnFault {
    /// The last command that was computed without a fault; no torque before the first.
    #[default]
    Hold,
    /// No torque.
    Zero,
    /// The gravity torque at the last position that was finite; no torque before the first.
    Gravity,
}

/// What the loop needs beside model and law.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings<T, const N: usize> {
    /// Time from one step to the next, s, positive.
    pub period: T,
    /// Largest torque of each joint, N·m, positive; `None` for a joint without limit.
    pub torque_limit: [Option<T>; N],
    /// What to command when a number is infinite or NaN.
    pub on_fault: OnFault,
}

impl<T: Real, const N: usize> Settings<T, N> {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Names the first number that is not positive and finite.
    pub fn check(&self) -> Result<(), ConfigError> {
        let positive = |x: T| x > T::ZERO && x.is_finite();
        let error =
            |parameter, joint| Err(ConfigError { parameter, joint, requirement: Requirement::Positive });
        if !positive(self.period) {
            return error("period", None);
        }
        match self.torque_limit.iter().position(|limit| limit.is_some_and(|x| !positive(x))) {
            None => Ok(()),
            joint => error("torque_limit", joint),
        }
    }

    pub(crate) fn limit(&self, torque: &[T; N]) -> Command<T, N> {
        let mut command = Command { torque: *torque, saturated: [false; N] };
        for ((torque, saturated), limit) in
            command.torque.iter_mut().zip(&mut command.saturated).zip(&self.torque_limit)
        {
            let Some(limit) = *limit else { continue };
            if torque.abs() > limit {
                *torque = if *torque > T::ZERO { limit } else { -limit };
                *saturated = true;
            }
        }
        command
    }
}

/// The outcome of one good step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command<T, const N: usize> {
    /// Torque to hold until the next step, N·m, within the limits.
    pub torque: [T; N],
    /// The joints whose torque the limit has cut.
    pub saturated: [bool; N],
}

/// What closes a loop: one torque for each measurement.
pub trait TorqueController<const N: usize> {
    /// Number type.
    type Scalar: Real;
    /// What the law learns.
    type Learnt: Copy;

    /// Time from one step to the next, s.
    fn period(&self) -> Self::Scalar;

    /// What the law has learnt so far.
    fn learnt(&self) -> &Self::Learnt;

    /// As [`Controller::step`].
    ///
    /// # Errors
    /// As [`Controller::step`].
    fn step(
        &mut self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        desired: &Desired<Self::Scalar, N>,
    ) -> Result<Command<Self::Scalar, N>, Fault<Self::Scalar, N>>;
}

impl<M: Model<N>, L: Law<M, N>, const N: usize> TorqueController<N> for Controller<M, L, N> {
    type Scalar = M::Scalar;
    type Learnt = L::State;

    fn period(&self) -> M::Scalar {
        self.settings.period
    }

    fn learnt(&self) -> &L::State {
        &self.memory.law
    }

    fn step(
        &mut self,
        q: &[M::Scalar; N],
        qd: &[M::Scalar; N],
        desired: &Desired<M::Scalar, N>,
    ) -> Result<Command<M::Scalar, N>, Fault<M::Scalar, N>> {
        Controller::step(self, q, qd, desired)
    }
}

/// A model, a law and a clock period, with the little that must be remembered between steps.
///
/// One step is a fixed amount of work: no allocation, no loop whose length depends on data.
#[derive(Clone, Copy, Debug)]
pub struct Controller<M: Model<N>, L: Law<M, N>, const N: usize> {
    model: M,
    law: L,
    settings: Settings<M::Scalar, N>,
    memory: Memory<M::Scalar, L::State, N>,
}

#[derive(Clone, Copy, Debug)]
struct Memory<T, S, const N: usize> {
    law: S,
    last_command: [T; N],
    last_position: Option<[T; N]>,
}

impl<M: Model<N>, L: Law<M, N>, const N: usize> Controller<M, L, N> {
    /// Puts the loop together, after checking every number in it.
    ///
    /// # Errors
    /// Names the first parameter of settings or law that cannot be used.
    pub fn new(model: M, law: L, settings: Settings<M::Scalar, N>) -> Result<Self, ConfigError> {
        settings.check()?;
        law.check()?;
        let memory =
            Memory { law: law.initial_state(), last_command: [M::Scalar::ZERO; N], last_position: None };
        Ok(Self { model, law, settings, memory })
    }

    /// Computes the torque to hold for the next period from the measured position, rad or m, the measured velocity,
    /// rad/s or m/s, and the desired motion.
    ///
    /// # Errors
    /// When a measured or desired number or the computed torque is infinite or NaN. The [`Fault`] carries the safe
    /// command that must be applied instead; the controller goes on with the next good measurement. How many faults in
    /// a row are too many is for the caller to say.
    pub fn step(
        &mut self,
        q: &[M::Scalar; N],
        qd: &[M::Scalar; N],
        desired: &Desired<M::Scalar, N>,
    ) -> Result<Command<M::Scalar, N>, Fault<M::Scalar, N>> {
        self.finite(q, Quantity::Position)?;
        self.memory.last_position = Some(*q);
        self.finite(qd, Quantity::Velocity)?;
        self.finite(&desired.q, Quantity::DesiredPosition)?;
        self.finite(&desired.qd, Quantity::DesiredVelocity)?;
        self.finite(&desired.qdd, Quantity::DesiredAcceleration)?;

        let sample = Sample { q: *q, qd: *qd, desired: *desired, period: self.settings.period };
        let mut state = self.memory.law;
        let torque = self.law.torque(&self.model, &mut state, &sample);
        self.finite(&torque, Quantity::Torque)?;
        let command = self.settings.limit(&torque);
        self.memory.law = state;
        self.memory.last_command = command.torque;
        Ok(command)
    }

    /// The command of the fault policy as things stand, N·m: finite and within the limits.
    pub fn safe_command(&self) -> [M::Scalar; N] {
        let zero = [M::Scalar::ZERO; N];
        match self.settings.on_fault {
            OnFault::Hold => self.memory.last_command,
            OnFault::Zero => zero,
            OnFault::Gravity => {
                let gravity = self.memory.last_position.map_or(zero, |q| self.model.gravity(&q));
                // A position may be finite and yet so large that its gravity torque is not.
                if first_not_finite(&gravity).is_some() { zero } else { self.settings.limit(&gravity).torque }
            }
        }
    }

    /// The model.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// Period, limits and fault policy.
    pub fn settings(&self) -> &Settings<M::Scalar, N> {
        &self.settings
    }

    /// What the law has learnt so far.
    pub fn law_state(&self) -> &L::State {
        &self.memory.law
    }

    /// Puts back what a law has learnt before, such as from a storage that outlives the power; an adaptive law brings it
    /// into its box before it uses it.
    pub fn restore(&mut self, state: L::State) {
        self.memory.law = state;
    }

    /// Forgets what was learnt and commanded, as after [`Controller::new`].
    pub fn reset(&mut self) {
        self.memory =
            Memory { law: self.law.initial_state(), last_command: [M::Scalar::ZERO; N], last_position: None };
    }

    fn finite(&self, x: &[M::Scalar; N], quantity: Quantity) -> Result<(), Fault<M::Scalar, N>> {
        match first_not_finite(x) {
            None => Ok(()),
            Some(joint) => {
                Err(Fault { quantity, reason: Reason::NotFinite, joint, command: self.safe_command() })
            }
        }
    }
}

#[cfg(test)]
mod tests;
