//! What is promised of a generated controller.

/// What is promised of a controller, as a constant of its generated module.
///
/// The conditions stand in the documentation of that constant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Guarantee<T, const N: usize> {
    /// Nothing is promised.
    None,
    /// Of the continuous law: the errors stay inside the domain of the bounds.
    Continuous {
        /// Bound on |q − q_d| by joint, rad or m, once the effect of the initial errors has died away.
        final_error: [T; N],
    },
    /// Of the loop that runs, sampled and held, along the planned motion.
    Sampled(SampledErrors<T, N>),
}

/// Bounds on the errors q − q_d of a sampled loop along its planned motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SampledErrors<T, const N: usize> {
    /// Bound on |q − q_d| at any time, by joint, rad or m.
    pub reach: [T; N],
    /// Time from which the errors count as settled, s.
    pub settle: T,
    /// Bound on |q − q_d| from `settle` on, by joint, rad or m; `None` where the promise ends before.
    pub settled_error: Option<[T; N]>,
    /// Bound on |q − q_d| at the end of the motion, by joint, rad or m.
    pub end_error: [T; N],
    /// Time until which all that holds, s; `None` for ever.
    pub valid_until: Option<T>,
    /// Least torque that the law asks for, by joint, N·m or N.
    pub torque_min: [T; N],
    /// Largest torque that the law asks for, by joint, N·m or N.
    pub torque_max: [T; N],
}

impl<T, const N: usize> Guarantee<T, N> {
    /// Whether anything is promised.
    pub const fn holds(&self) -> bool {
        !matches!(self, Self::None)
    }

    /// Whether the promise is about the loop that runs.
    pub const fn is_sampled(&self) -> bool {
        matches!(self, Self::Sampled(_))
    }
}
