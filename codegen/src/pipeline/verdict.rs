//! Whether the reduction pays.

use super::Generation;
use super::replaced::{Replaced, Saving};
use crate::choose::why_exact;
use crate::graph::Operations;

impl Generation {
    /// Whether the reduction pays, in one sentence; of an exact model, why it is one.
    ///
    /// With a controller, whole control steps of the same law are compared, else the models; by [`Operations::cost`].
    pub fn verdict(&self) -> String {
        match &self.designed.replaced {
            Some(Replaced::SavesTooLittle(saving)) => return too_little(*saving),
            Some(Replaced::Refused(why)) => {
                return format!(
                    "This is the exact model, since the controller is refused with the cheapest reduced one that was found: {why}."
                );
            }
            None => {}
        }
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
        match self.designed.saving() {
            Some(saving) => of_steps(saving),
            None => compared(&self.code().operations(), &self.exact_code().operations()),
        }
    }
}

/// How steps are counted, for a person.
const COUNTED: &str = "operations, a sine-cosine pair counted as 12 and a clamp as 2";

fn too_little(saving: Saving) -> String {
    let Saving { reduced, exact } = saving;
    format!(
        "This is the exact model, since the cheapest reduced one that was found saves less than 5 %: a control step costs \
         {exact}, and {reduced} with that one ({COUNTED})."
    )
}

fn of_steps(saving: Saving) -> String {
    let Saving { reduced, exact } = saving;
    if saving.pays() {
        format!("The reduction pays: a control step costs {reduced} instead of {exact} ({COUNTED}).")
    } else {
        format!(
            "The reduction does not pay, since it saves less than 5 %: a control step costs {reduced}, and {exact} with the \
             exact model ({COUNTED})."
        )
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
