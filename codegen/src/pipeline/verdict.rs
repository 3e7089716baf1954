//! Whether the reduction pays.

use super::Generation;
use crate::choose::why_exact;
use crate::graph::Operations;

impl Generation {
    /// Whether the reduction pays, in one sentence; of an exact model, why it is one.
    ///
    /// Costs are compared as the search for a model compares them, by [`Operations::cost`].
    pub fn verdict(&self) -> String {
        if self.reduced().is_exact() {
            let peak = self.torque().map(|torque| torque.peak.as_slice());
            return match self.spec().model.tolerance() {
                Some(fraction) => why_exact(self.arm(), self.lagrangian(), peak, fraction),
                None => "This is the exact model.".to_string(),
            };
        }
        if !self.reduced().simplified.contains(&true) {
            return "No coefficient has more functions than are kept, so nothing was simplified.".to_string();
        }
        compared(&self.code().operations(), &self.exact_code().operations())
    }
}

fn compared(reduced: &Operations, exact: &Operations) -> String {
    let (mine, theirs) = (reduced.arithmetic(), exact.arithmetic());
    if reduced.cost() >= exact.cost() {
        format!(
            "The reduction does not pay: the exact model costs no more ({theirs} operations and {} sine-cosine pairs against \
             {mine} and {}).",
            exact.trig_pairs, reduced.trig_pairs
        )
    } else if mine < theirs {
        format!("The reduction pays: it saves {} of {theirs} operations.", theirs - mine)
    } else {
        let fewer = exact.trig_pairs.saturating_sub(reduced.trig_pairs);
        format!("The reduction pays: it saves {fewer} of {} sine-cosine pairs.", exact.trig_pairs)
    }
}
