//! The loop about a step that is written out.

use super::ControlStep;
use crate::reference::Desired;
use crate::vector::{first_not_finite, for_each_joint};
use crate::{Command, Estimate, Fault, OnFault, Quantity, Real, Reason, TorqueController};

/// A [`ControlStep`] with the little that must be remembered from one step to the next.
///
/// It is made at compile time and can be a `static`; nothing has to be checked at the start. One step is a fixed amount of
/// work: no allocation, no loop whose length depends on data.
#[derive(Debug)]
pub struct StepController<S: ControlStep<N, P>, const N: usize, const P: usize = 0> {
    estimate: Estimate<S::Scalar, P>,
    last_command: [S::Scalar; N],
    last_position: [S::Scalar; N],
    /// Whether there was a finite position.
    positioned: bool,
}

impl<S: ControlStep<N, P>, const N: usize, const P: usize> Clone for StepController<S, N, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: ControlStep<N, P>, const N: usize, const P: usize> Copy for StepController<S, N, P> {}

impl<S: ControlStep<N, P>, const N: usize, const P: usize> Default for StepController<S, N, P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: ControlStep<N, P>, const N: usize, const P: usize> StepController<S, N, P> {
    /// The loop before its first step.
    pub const fn new() -> Self {
        Self {
            estimate: Estimate::new(S::LEARNING.initial),
            last_command: [S::Scalar::ZERO; N],
            last_position: [S::Scalar::ZERO; N],
            positioned: false,
        }
    }

    /// Computes the torque to hold for the next period from the measured position, rad or m, the measured velocity,
    /// rad/s or m/s, and the desired motion.
    ///
    /// # Errors
    /// When a measured or desired number or the computed torque is infinite or NaN, or when the desired motion is beyond
    /// [`ControlStep::REFERENCE`]. The [`Fault`] carries the safe command that must be applied instead; the controller goes on
    /// with the next good measurement. How many faults in a row are too many is for the caller to say.
    // A firmware has one such call. Inside its loop nothing is copied, and what the loop does not read is not computed.
    #[inline(always)]
    pub fn step(
        &mut self,
        q: &[S::Scalar; N],
        qd: &[S::Scalar; N],
        desired: &Desired<S::Scalar, N>,
    ) -> Result<Command<S::Scalar, N>, Fault<S::Scalar, N>> {
        let torque = S::step(q, qd, desired, self.estimate.theta());
        // 0 times a finite number is 0, so one comparison does for all.
        let zero = S::Scalar::ZERO;
        let mut sum = torque.unread * zero;
        let mut saturated = [false; N];
        for_each_joint!(N, i => {
            sum += torque.asked[i] * zero;
            saturated[i] = torque.limited[i] != torque.asked[i];
        });
        if sum != zero {
            // Found here, so that the torques need not be in memory.
            let mut joint = 0;
            for_each_joint!(N, i => {
                let earlier = N - 1 - i;
                if !torque.asked[earlier].is_finite() {
                    joint = earlier;
                }
            });
            return Err(self.fault_of(q, qd, desired, joint));
        }
        let beyond = S::REFERENCE.as_ref().and_then(|limits| limits.beyond(desired));
        if let Some((quantity, joint)) = beyond {
            return Err(self.fault(q, quantity, Reason::BeyondLimits, joint));
        }
        if P > 0 {
            self.estimate.correct(&torque.correction, &S::LEARNING.low, &S::LEARNING.high);
        }
        self.last_command = torque.limited;
        if S::SETTINGS.on_fault == OnFault::Gravity {
            (self.last_position, self.positioned) = (*q, true);
        }
        Ok(Command { torque: torque.limited, saturated })
    }

    /// The command of the fault policy as things stand, N·m: finite and within the limits.
    pub fn safe_command(&self) -> [S::Scalar; N] {
        match S::SETTINGS.on_fault {
            OnFault::Hold => self.last_command,
            OnFault::Gravity if self.positioned => {
                let gravity = S::gravity_torque(&self.last_position);
                // A position may be finite and yet so large that its gravity torque is not.
                let finite = first_not_finite(&gravity).is_none();
                if finite { S::SETTINGS.limit(&gravity).torque } else { [S::Scalar::ZERO; N] }
            }
            OnFault::Gravity | OnFault::Zero => [S::Scalar::ZERO; N],
        }
    }

    /// θ̂, what the law has learnt so far; empty for a law that does not learn.
    pub fn learnt(&self) -> &[S::Scalar; P] {
        self.estimate.theta()
    }

    /// Puts back what was learnt before, such as from a storage that outlives the power. What is outside its box is brought
    /// into it; what is no number becomes the start.
    pub fn restore(&mut self, theta: [S::Scalar; P]) {
        self.estimate = Estimate::new(theta);
        self.estimate.project(&S::LEARNING.low, &S::LEARNING.high, &S::LEARNING.initial);
    }

    /// Forgets what was learnt and commanded, as after [`StepController::new`].
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// The fault behind the torque of a joint that is not finite.
    #[cold]
    #[inline(never)]
    fn fault_of(
        &mut self,
        q: &[S::Scalar; N],
        qd: &[S::Scalar; N],
        desired: &Desired<S::Scalar, N>,
        joint: usize,
    ) -> Fault<S::Scalar, N> {
        let torque = (Quantity::Torque, joint);
        let (quantity, joint) = not_finite(q, qd, desired).unwrap_or(torque);
        self.fault(q, quantity, Reason::NotFinite, joint)
    }

    #[cold]
    fn fault(
        &mut self,
        q: &[S::Scalar; N],
        quantity: Quantity,
        reason: Reason,
        joint: usize,
    ) -> Fault<S::Scalar, N> {
        if quantity != Quantity::Position {
            (self.last_position, self.positioned) = (*q, true);
        }
        Fault { quantity, reason, joint, command: self.safe_command() }
    }
}

impl<S: ControlStep<N, P>, const N: usize, const P: usize> TorqueController<N> for StepController<S, N, P> {
    type Scalar = S::Scalar;
    type Learnt = [S::Scalar; P];

    fn period(&self) -> S::Scalar {
        S::SETTINGS.period
    }

    fn learnt(&self) -> &[S::Scalar; P] {
        self.estimate.theta()
    }

    #[inline]
    fn step(
        &mut self,
        q: &[S::Scalar; N],
        qd: &[S::Scalar; N],
        desired: &Desired<S::Scalar, N>,
    ) -> Result<Command<S::Scalar, N>, Fault<S::Scalar, N>> {
        StepController::step(self, q, qd, desired)
    }
}

/// The first input that is infinite or NaN, and its joint.
fn not_finite<T: Real, const N: usize>(
    q: &[T; N],
    qd: &[T; N],
    desired: &Desired<T, N>,
) -> Option<(Quantity, usize)> {
    let inputs = [
        (q, Quantity::Position),
        (qd, Quantity::Velocity),
        (&desired.q, Quantity::DesiredPosition),
        (&desired.qd, Quantity::DesiredVelocity),
        (&desired.qdd, Quantity::DesiredAcceleration),
    ];
    inputs.into_iter().find_map(|(x, quantity)| first_not_finite(x).map(|joint| (quantity, joint)))
}
