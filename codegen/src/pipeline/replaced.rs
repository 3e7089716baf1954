//! Why the exact model stands in place of a reduced one.

/// Why the exact model is emitted, although the specification leaves the choice open and a reduced one was found.
#[derive(Clone, Debug)]
pub(super) enum Replaced {
    /// A step with the cheapest reduced model saves too little.
    SavesTooLittle(Saving),
    /// The controller is refused with the cheapest reduced model: what of the specification it breaks, in words.
    Refused(String),
}

/// Costs of two steps, by [`crate::graph::Operations::cost`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Saving {
    /// With the reduced model.
    pub reduced: usize,
    /// With the exact one.
    pub exact: usize,
}

impl Saving {
    /// Whether a reduction pays: it saves a twentieth of the step at least.
    pub fn pays(&self) -> bool {
        20 * self.reduced <= 19 * self.exact
    }
}
