//! The descent: at each step every exchange that the step's error admits, the one with the best return first.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cost::Costs;
use super::fitting::{Form, Table};
use super::moves::{Moves, united};
use super::ties::{exchanged, tied};
use super::{STEP, STRICTEST, SparseCandidate, SparseProblem, start};
use crate::parallel::Parallelize;
use crate::reduction::{CandidateFunction, Group, Sparse};

/// Exchanges whose error is above the step's by no more than this factor are fitted again to the room that the other
/// coefficients leave.
const NEARLY: f64 = 1.6;
/// Longer forms are not.
const REFITTED: usize = 6;
/// The room of a point is at least this part of the level, so that one point does not decide alone.
const LEAST_ROOM: f64 = 0.02;
/// Ratio of the levels at which the descent is polished.
const POLISH: f64 = 1.2;
/// Ties may bring the errors back up to this part of the level.
const TIED: f64 = 0.97;

/// An exchange: the form for the slots.
struct Exchange {
    slots: Vec<usize>,
    form: Form,
    score: f64,
}

/// The price of the model as it stands, and how often it needs what.
struct Now {
    cost: usize,
    uses: Vec<usize>,
}

/// Slots with the forms that an exchange took out of them.
type Before = Vec<(usize, Arc<Form>)>;

/// Where the descent stands. Cheap to copy.
#[derive(Clone)]
pub(super) struct Descent<'a> {
    pub table: &'a Table,
    costs: &'a Costs,
    moves: &'a Moves<'a>,
    /// By slot.
    pub forms: Vec<Arc<Form>>,
    /// By joint and point.
    pub errors: Vec<Vec<f64>>,
    simpler: Vec<Option<Arc<Vec<Form>>>>,
    united: BTreeMap<(usize, usize), Arc<Vec<Form>>>,
    /// What each exchange took the place of, by the slot of its form.
    pub history: Vec<Vec<Before>>,
    /// A slot and the functions that it is not to keep again.
    pub barred: Option<(usize, Vec<usize>)>,
    /// Power of the operations saved in the score of an exchange; below 1 small steps are preferred.
    keen: f64,
}

/// The members with errors up to `most`, of a descent as `keen` on large steps as that.
pub(super) fn members(
    problem: &SparseProblem,
    candidates: &[CandidateFunction],
    table: &Table,
    most: f64,
    keen: f64,
) -> Vec<SparseCandidate> {
    let lagrangian = problem.lagrangian;
    let onto = problem.absolute.map(|absolute| absolute.coordinates.onto.as_slice());
    let costs = Costs::new(lagrangian, candidates, onto);
    let forms: Vec<Arc<Form>> = (0..lagrangian.coefficients.len())
        .into_par_iter()
        .map(|m| Arc::new(start::forms(lagrangian, table, m)))
        .collect();
    let moves = Moves::new(lagrangian, candidates, &costs);
    let mut descent = Descent {
        moves: &moves,
        errors: errors(lagrangian.dof, table, &forms),
        simpler: vec![None; forms.len()],
        history: vec![Vec::new(); forms.len()],
        barred: None,
        keen,
        united: BTreeMap::new(),
        costs: &costs,
        table,
        forms,
    };
    let mut out = Vec::new();
    let mut cheapest = usize::MAX;
    let (mut level, mut polished) = (STRICTEST, STRICTEST * POLISH);
    while level <= most {
        descent.descend(level);
        if level >= polished {
            polished = level * POLISH;
            descent.polish(level);
        }
        let cost = descent.cost();
        if cost < cheapest && largest(&descent.errors) <= level {
            cheapest = cost;
            let mut tight = descent.clone();
            tight.tighten();
            let room = (TIED * level).max(largest(&tight.errors));
            let forms = tied(table, &tight.forms, &tight.errors, room);
            let error = largest(&errors(lagrangian.dof, table, &forms));
            out.push(SparseCandidate {
                model: Sparse { absolute: problem.absolute.cloned(), ..sparse(candidates, &forms) },
                error,
                cost,
            });
        }
        level *= STEP;
    }
    out
}

impl Descent<'_> {
    /// Takes exchanges as long as one is admitted.
    pub(super) fn descend(&mut self, level: f64) {
        while let Some(exchange) = self.best(level) {
            self.take(exchange);
        }
    }

    /// The price of the model as it stands.
    pub(super) fn cost(&self) -> usize {
        self.costs.of(self.forms.iter().map(|form| (form.members.as_slice(), form.kept.as_slice())))
    }

    /// The price with `form` in the first of the slots and nothing in the others.
    fn price_with(&self, slots: &[usize], form: &Form) -> usize {
        self.costs.of(self.forms.iter().enumerate().map(|(s, old)| {
            match slots.iter().position(|&t| t == s) {
                Some(0) => (form.members.as_slice(), form.kept.as_slice()),
                Some(_) => ([].as_slice(), [].as_slice()),
                None => (old.members.as_slice(), old.kept.as_slice()),
            }
        }))
    }

    /// Operations saved per burden added, the most among the exchanges that leave all errors within `level`.
    fn best(&mut self, level: f64) -> Option<Exchange> {
        self.refresh();
        let now = Now {
            cost: self.cost(),
            uses: self.costs.uses(self.forms.iter().map(|form| form.kept.as_slice())),
        };
        let slots = (0..self.forms.len()).into_par_iter();
        let single =
            slots.filter_map(|s| self.better(&[s], self.simpler[s].as_deref()?.as_slice(), &now, level));
        let pairs: Vec<_> = self.united.iter().filter(|(_, forms)| !forms.is_empty()).collect();
        let double =
            pairs.par_iter().filter_map(|((a, b), forms)| self.better(&[*a, *b], forms, &now, level));
        let found: Vec<Exchange> = single.chain(double).collect();
        found.into_iter().reduce(|best, other| if other.score > best.score { other } else { best })
    }

    fn better(&self, slots: &[usize], forms: &[Form], now: &Now, level: f64) -> Option<Exchange> {
        let old: Vec<&Form> = slots.iter().map(|&s| &*self.forms[s]).collect();
        let burden: f64 = old.iter().map(|form| form.burden).sum();
        let mut best: Option<Exchange> = None;
        for form in forms {
            if self
                .barred
                .as_ref()
                .is_some_and(|(slot, kept)| slots.first() == Some(slot) && form.kept == *kept)
            {
                continue;
            }
            let cost = match old.as_slice() {
                // One group with the same members: rates and rows are as they were.
                [old] if !form.kept.is_empty() && !old.kept.is_empty() => {
                    self.costs.exchanged(now.cost, &now.uses, &old.kept, &form.kept)
                }
                _ => self.price_with(slots, form),
            };
            debug_assert_eq!(cost, self.price_with(slots, form));
            if cost >= now.cost {
                continue;
            }
            let score = libm::pow((now.cost - cost) as f64, self.keen) / (form.burden - burden).max(1e-9);
            if best.as_ref().is_some_and(|best| score <= best.score) {
                continue;
            }
            let reached = self.largest_with(&old, form);
            let admitted = if reached <= level {
                Some(form.clone())
            } else if reached <= NEARLY * level {
                self.refitted(&old, form, level)
            } else {
                None
            };
            if let Some(form) = admitted {
                best = Some(Exchange { slots: slots.to_vec(), form, score });
            }
        }
        best
    }

    /// As [`Self::fitted_to_room`], where that keeps all errors within `level`.
    fn refitted(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let new = self.fitted_to_room(old, form, level)?;
        (self.largest_with(old, &new) <= level).then_some(new)
    }

    /// The form with the parameters that keep it furthest within what the others leave of `level`.
    pub(super) fn fitted_to_room(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let ([before], [(m, _)]) = (old, form.members.as_slice()) else { return None };
        if form.kept.is_empty() || form.kept.len() > REFITTED {
            return None;
        }
        let residual = before.residuals.first()?;
        let room = |point: usize| {
            let left =
                |&(i, share): &(usize, f64)| (level - self.errors[i][point]) / share + residual[point].abs();
            self.table.shares[*m].iter().map(left).fold(f64::INFINITY, f64::min)
        };
        let floor = LEAST_ROOM * level / self.table.weights[*m];
        let inverse: Vec<f64> = (0..residual.len()).map(|point| 1.0 / room(point).max(floor)).collect();
        Some(Form::fitted(self.table, form.members.clone(), form.kept.clone(), Some(&inverse)))
    }

    fn largest_with(&self, old: &[&Form], new: &Form) -> f64 {
        let residuals: Vec<&Vec<f64>> = old.iter().flat_map(|form| &form.residuals).collect();
        let mut largest = 0.0_f64;
        for (i, errors) in self.errors.iter().enumerate() {
            let parts: Vec<(f64, &[f64], &[f64])> = new
                .members
                .iter()
                .enumerate()
                .filter_map(|(place, &(m, _))| {
                    let share = self.table.shares[m].iter().find(|share| share.0 == i)?.1;
                    Some((share, new.residuals[place].as_slice(), residuals[place].as_slice()))
                })
                .collect();
            if parts.is_empty() {
                continue;
            }
            for (point, &error) in errors.iter().enumerate() {
                let change: f64 = parts.iter().map(|(u, r, s)| u * (r[point].abs() - s[point].abs())).sum();
                largest = largest.max(error + change);
            }
        }
        largest
    }

    fn take(&mut self, exchange: Exchange) {
        let old: Vec<Arc<Form>> = exchange.slots.iter().map(|&s| self.forms[s].clone()).collect();
        let forms: Vec<&Form> = old.iter().map(|form| &**form).collect();
        self.errors = exchanged(self.table, &self.errors, &forms, &exchange.form);
        let Some(&first) = exchange.slots.first() else { return };
        self.history[first].push(exchange.slots.iter().copied().zip(old).collect());
        for &s in &exchange.slots {
            self.put(s, Arc::new(Form::nothing()));
        }
        self.put(first, Arc::new(exchange.form));
    }

    /// Puts `form` into a slot; the errors are not touched.
    pub(super) fn put(&mut self, slot: usize, form: Arc<Form>) {
        self.forms[slot] = form;
        self.simpler[slot] = None;
        self.united.retain(|(a, b), _| *a != slot && *b != slot);
    }

    /// Finds the exchanges of the forms that are new.
    fn refresh(&mut self) {
        let new: Vec<usize> = (0..self.forms.len()).filter(|&s| self.simpler[s].is_none()).collect();
        let (table, moves, forms) = (self.table, &self.moves, &self.forms);
        let simpler: Vec<Vec<Form>> = new.par_iter().map(|&s| moves.simpler(table, &forms[s])).collect();
        let keys: Vec<(usize, usize)> = new
            .iter()
            .flat_map(|&s| (0..forms.len()).filter(move |&t| t != s).map(move |t| (s.min(t), s.max(t))))
            .filter(|(a, b)| !forms[*a].kept.is_empty() && !forms[*b].kept.is_empty())
            .collect();
        let both: Vec<Vec<Form>> =
            keys.par_iter().map(|&(a, b)| united(table, &forms[a], &forms[b])).collect();
        for (s, forms) in new.into_iter().zip(simpler) {
            self.simpler[s] = Some(Arc::new(forms));
        }
        self.united.extend(keys.into_iter().zip(both.into_iter().map(Arc::new)));
    }
}

/// By joint and point.
pub(super) fn errors(dof: usize, table: &Table, forms: &[Arc<Form>]) -> Vec<Vec<f64>> {
    let mut out = vec![vec![0.0; table.points()]; dof];
    for form in forms {
        for (&(m, _), residual) in form.members.iter().zip(&form.residuals) {
            for &(i, share) in &table.shares[m] {
                out[i].iter_mut().zip(residual).for_each(|(e, r)| *e += share * r.abs());
            }
        }
    }
    out
}

pub(super) fn largest(errors: &[Vec<f64>]) -> f64 {
    errors.iter().flatten().fold(0.0, |m, &e| m.max(e))
}

fn sparse(candidates: &[CandidateFunction], forms: &[Arc<Form>]) -> Sparse {
    let mut used: Vec<usize> = forms.iter().flat_map(|form| form.kept.iter().copied()).collect();
    used.sort_unstable();
    used.dedup();
    let slot = |f: &usize| used.binary_search(f).ok();
    let group = |form: &Form| Group {
        members: form.members.clone(),
        terms: form.kept.iter().zip(&form.parameters).filter_map(|(f, &k)| Some((slot(f)?, k))).collect(),
    };
    let groups = forms.iter().filter(|form| !form.kept.is_empty()).map(|form| group(form)).collect();
    Sparse { functions: used.iter().map(|&f| candidates[f].clone()).collect(), groups, absolute: None }
}
