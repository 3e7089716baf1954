//! How much work bounds may take.

/// How much work a certificate may take.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Branch and bound stops when the bound and the largest value found differ by less than this fraction.
    pub tolerance: f64,
    /// Boxes for each residual; of those that are enclosed term by term, a residual of more than [`super::LONG`] terms gets
    /// accordingly fewer. When they are spent, the best bound so far is used. A box that waits takes 200 bytes.
    pub boxes: usize,
    /// Starts of the search from below.
    pub starts: usize,
    /// Whether the design also seeks the smallest sufficient tube, which costs more than all its other numbers; it does
    /// so in any case where a required guarantee fails.
    pub seek_tube: bool,
}

impl Default for Effort {
    /// What generation spends.
    fn default() -> Self {
        Self { tolerance: 0.01, boxes: 300_000, starts: 12, seek_tube: false }
    }
}

impl Effort {
    /// The same with another number of boxes for each residual.
    #[must_use]
    pub fn boxes(self, boxes: usize) -> Self {
        Self { boxes, ..self }
    }

    /// The same with another number of starts of the search from below.
    #[must_use]
    pub fn starts(self, starts: usize) -> Self {
        Self { starts, ..self }
    }

    /// The same, where the smallest sufficient tube is sought or not.
    #[must_use]
    pub fn seek_tube(self, seek_tube: bool) -> Self {
        Self { seek_tube, ..self }
    }
}
