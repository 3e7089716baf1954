//! What is said where a certified torque error is above the tolerance that was asked for.

use super::rounding::printed_up;
use super::{ModelError, Torque, percent_up};
use crate::arm::ROUND_ANGLES;
use crate::error::Diagnostics;
use crate::number::{percent, scientific, short};

/// A joint whose torque error is above the tolerance.
struct Excess {
    joint: usize,
    /// Its error over its peak torque.
    fraction: f64,
    /// The part of that which rounding the arm's rotations makes.
    turned: f64,
}

impl ModelError<'_> {
    /// Adds a fault where the rounding of the arm's rotations takes more than the tolerance, and a warning where what is
    /// uncertain or rounding in f64 does.
    pub fn judge_tolerance(&self, torque: &Torque, faults: &mut Diagnostics, warnings: &mut Vec<String>) {
        let Some(tolerance) = self.loaded.spec.model.tolerance() else { return };
        if !self.uncertainty.parameters.is_empty() {
            warnings.extend(self.beyond_tolerance(tolerance, torque));
            return;
        }
        let Some(worst) = self.excess(tolerance, torque) else { return };
        // The model itself keeps what this rounding leaves of the tolerance.
        if 2.0 * worst.turned > worst.fraction {
            self.refuse_rounding(tolerance, &worst, faults);
        } else {
            warnings.push(format!(
                "{}: model: a torque error of {} of the peak torque is less than rounding{} leaves; the certified torque error \
                 is {} of it",
                self.loaded.path.display(),
                short(tolerance),
                &if self.sines.rounds() { format!(" in {}", self.loaded.spec.emit.scalar.name()) } else { " and the error of the sines".to_string() },
                printed_up(worst.fraction)
            ));
        }
    }

    /// The joint whose error is furthest above the tolerance; a joint without a torque has no part to allow.
    fn excess(&self, tolerance: f64, torque: &Torque) -> Option<Excess> {
        let angles = self.angles.map(|angles| angles.torque(&torque.rates));
        let of = |joint: usize| {
            let peak = torque.peak[joint];
            let turned = angles.as_ref().map_or(0.0, |angles| angles[joint]) / peak;
            Excess { joint, fraction: torque.error[joint] / peak, turned }
        };
        let above = (0..torque.peak.len()).filter(|&i| !torque.is_still(i)).map(of);
        above.filter(|excess| excess.fraction > tolerance).max_by(|a, b| a.fraction.total_cmp(&b.fraction))
    }

    fn refuse_rounding(&self, tolerance: f64, worst: &Excess, faults: &mut Diagnostics) {
        let own = self.loaded.spec.arm.round_angles.unwrap_or(ROUND_ANGLES);
        let smaller = if own > ROUND_ANGLES { ROUND_ANGLES } else { 0.0 };
        let problem = format!(
            "is {}, and rounding rotations by up to this costs {} of the peak torque of {}, but `model` allows {}",
            scientific(own),
            percent_up(worst.turned),
            self.arm.joints[worst.joint].name,
            percent(100.0 * tolerance)
        );
        let help = format!(
            "write a smaller value, such as {}, or a `model.tolerance.torque` above {}",
            scientific(smaller),
            printed_up(worst.fraction)
        );
        faults.push("arm.round_angles", problem, help);
    }

    /// What is said where a tolerance, kept by the arm as specified, is not kept by all that it may be.
    fn beyond_tolerance(&self, tolerance: f64, torque: &Torque) -> Option<String> {
        (torque.fraction() > tolerance).then(|| {
            format!(
                "{}: model: the tolerance of {} is kept by the arm as specified; over all that is uncertain the \
                 certified torque error is {}",
                self.loaded.path.display(),
                percent(100.0 * tolerance),
                percent_up(torque.fraction())
            )
        })
    }
}
