//! Improving the result of a descent: exchanges are taken back, and parameters are fitted together.

use std::sync::Arc;

use super::descent::Descent;
use super::room::{errors, largest};
use super::ties::exchanged;

/// Exchanges of one slot that are taken back together.
const STEPS: usize = 1;
/// The same for models cheaper than this, where a trial costs little.
const STEPS_SHORT: usize = 2;
const SHORT: usize = 150;
/// Parts of the largest error by which a round of fits tries to lower it: the first, and the least worth trying.
const SHRINK: f64 = 0.03;
const LEAST_SHRINK: f64 = 0.002;
/// What of that must have been reached for the round to count.
const REACHED: f64 = 0.3;
/// Rounds at most, and times that each goes through the forms.
const ROUNDS: usize = 12;
const TIMES: usize = 3;

impl Descent<'_> {
    /// Takes back what was exchanged last in one slot after the other and goes on otherwise, where that ends cheaper.
    pub(super) fn polish(&mut self, level: f64) {
        for slot in 0..self.forms.len() {
            let steps = if self.cost() < SHORT { STEPS_SHORT } else { STEPS };
            for steps in 1..=steps {
                let Some(mut other) = self.without(slot, steps) else { break };
                other.descend(level);
                other.barred = None;
                if other.cost() < self.cost() && largest(&other.errors) <= level {
                    *self = other;
                    break;
                }
            }
        }
    }

    /// Before the last `steps` exchanges of a slot, which is not to keep the same functions again; `None` where there
    /// were not so many.
    fn without(&self, slot: usize, steps: usize) -> Option<Self> {
        let mut out = self.clone();
        out.barred = Some((slot, self.forms[slot].kept.clone()));
        for _ in 0..steps {
            for (s, form) in out.history[slot].pop()? {
                out.put(s, form);
            }
        }
        out.errors = errors(out.errors.len(), out.table, &out.forms);
        Some(out)
    }

    /// Fits form after form anew to the room that the others leave, towards ever smaller largest errors.
    pub(super) fn tighten(&mut self) {
        let mut shrink = SHRINK;
        for _ in 0..ROUNDS {
            let start = largest(&self.errors);
            let mut other = self.clone();
            other.press((1.0 - shrink) * start);
            if largest(&other.errors) < (1.0 - REACHED * shrink) * start {
                *self = other;
            } else {
                shrink *= 0.5;
            }
            if shrink < LEAST_SHRINK {
                break;
            }
        }
    }

    /// Lowers what exceeds `aim`, form by form.
    fn press(&mut self, aim: f64) {
        let excess = |errors: &[Vec<f64>]| {
            let mut sum = 0.0;
            for row in errors {
                row.iter().filter(|&&e| e > aim).for_each(|e| sum += e - aim);
            }
            sum
        };
        let exceeds = |errors: &[Vec<f64>]| -> Vec<bool> {
            errors.iter().map(|row| row.iter().any(|&e| e > aim)).collect()
        };
        let mut now = excess(&self.errors);
        let mut above = exceeds(&self.errors);
        for _ in 0..TIMES {
            let before = now;
            for slot in 0..self.forms.len() {
                let old = self.forms[slot].clone();
                let shares = |&(m, _): &(usize, f64)| &self.table.shares[m];
                // Where it enters no joint's torque that is off by more, it cannot help.
                if !old.members.iter().flat_map(shares).any(|&(i, _)| above[i]) {
                    continue;
                }
                let Some(new) = self.fitted_to_room(&[&old], &old, aim) else { continue };
                let errors = exchanged(self.table, &self.errors, &[&old], &new);
                let then = excess(&errors);
                if then < now {
                    now = then;
                    above = exceeds(&errors);
                    self.errors = errors;
                    self.put(slot, Arc::new(new));
                }
            }
            // Where nothing was gained nothing more would be.
            if now == before || largest(&self.errors) <= aim {
                return;
            }
        }
    }
}
