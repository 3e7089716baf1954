//! The exchange with the best return among those that the step's error admits.

use std::sync::Arc;

use super::descent::Descent;
use super::fitting::Form;
use crate::parallel::Parallelize;

/// Exchanges that are tried at a time.
const TOGETHER: usize = 4;

/// An exchange: the form for the slots.
pub(super) struct Exchange {
    pub(super) slots: Arc<[usize]>,
    pub(super) form: Arc<Form>,
    /// Operations saved per burden added.
    score: f64,
}

/// The cost of the model as it stands, and how often it needs what.
struct Now {
    cost: usize,
    uses: Vec<usize>,
}

impl Descent<'_> {
    /// Of the exchanges that leave all errors within `level` the one that saves most operations per burden added.
    pub(super) fn best(&mut self, level: f64) -> Option<Exchange> {
        self.refresh();
        let now = Now {
            cost: self.cost(),
            uses: self.costs.uses(self.forms.iter().map(|form| form.kept.as_slice())),
        };
        let slots = (0..self.forms.len()).into_par_iter();
        let single =
            slots.filter_map(|s| Some(self.cheaper(&[s], self.simpler[s].as_deref()?.as_slice(), &now)));
        let pairs: Vec<_> = self.united.iter().collect();
        let double = pairs.par_iter().map(|((a, b), forms)| self.cheaper(&[*a, *b], forms, &now));
        let mut found: Vec<Exchange> =
            single.chain(double).collect::<Vec<_>>().into_iter().flatten().collect();
        // Of equal ones the first.
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        found.chunks(TOGETHER).find_map(|some| {
            let admitted: Vec<_> = some.par_iter().map(|exchange| self.admitted(exchange, level)).collect();
            let (exchange, form) = some.iter().zip(admitted).find_map(|(e, form)| Some((e, form?)))?;
            Some(Exchange { slots: exchange.slots.clone(), form, score: exchange.score })
        })
    }

    /// The exchanges that save something.
    fn cheaper(&self, slots: &[usize], forms: &[Arc<Form>], now: &Now) -> Vec<Exchange> {
        let old = self.forms_of(slots);
        let burden: f64 = old.iter().map(|form| form.burden).sum();
        let barred = |form: &Form| {
            let of = |(slot, kept): &(usize, Vec<usize>)| slots.first() == Some(slot) && form.kept == *kept;
            self.barred.as_ref().is_some_and(of)
        };
        let shared: Arc<[usize]> = slots.into();
        let mut out = Vec::new();
        for form in forms.iter().filter(|form| !barred(form)) {
            let cost = match old.as_slice() {
                // One group with the same members: rates and rows are as they were.
                [old] if !form.kept.is_empty() && !old.kept.is_empty() => {
                    self.costs.exchanged(now.cost, &now.uses, &old.kept, &form.kept)
                }
                _ => self.cost_with(slots, form),
            };
            debug_assert_eq!(cost, self.cost_with(slots, form));
            if cost >= now.cost {
                continue;
            }
            let score = libm::pow((now.cost - cost) as f64, self.keen) / (form.burden - burden).max(1e-9);
            out.push(Exchange { slots: shared.clone(), form: form.clone(), score });
        }
        out
    }

    pub(super) fn forms_of(&self, slots: &[usize]) -> Vec<&Form> {
        slots.iter().map(|&s| &*self.forms[s]).collect()
    }

    /// The cost with `form` in the first of the slots and nothing in the others.
    fn cost_with(&self, slots: &[usize], form: &Form) -> usize {
        self.costs.of(self.forms.iter().enumerate().map(|(s, old)| {
            match slots.iter().position(|&t| t == s) {
                Some(0) => (form.members.as_slice(), form.kept.as_slice()),
                Some(_) => ([].as_slice(), [].as_slice()),
                None => (old.members.as_slice(), old.kept.as_slice()),
            }
        }))
    }
}
