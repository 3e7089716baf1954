//! The descent: at each step every exchange that the step's error admits, the one with the best return first.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cost::Costs;
use super::fitting::{Form, Table};
use super::moves::Moves;
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

/// Exchanges that are tried at a time.
const TOGETHER: usize = 4;

/// An exchange: the form for the slots.
struct Exchange {
    slots: Arc<[usize]>,
    form: Arc<Form>,
    /// Operations saved per burden added.
    score: f64,
}

/// The cost of the model as it stands, and how often it needs what.
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
    simpler: Vec<Option<Arc<Vec<Arc<Form>>>>>,
    united: BTreeMap<(usize, usize), Arc<Vec<Arc<Form>>>>,
    /// What each exchange took the place of, by the slot of its form.
    pub history: Vec<Vec<Before>>,
    /// A slot and the functions that it is not to keep again.
    pub barred: Option<(usize, Vec<usize>)>,
    /// Power of the operations saved in the score of an exchange; below 1 small steps are preferred.
    keen: f64,
}

impl<'a> Descent<'a> {
    /// Before the first exchange, all that may come first found.
    pub(super) fn new(
        problem: &SparseProblem,
        table: &'a Table,
        costs: &'a Costs,
        moves: &'a Moves<'a>,
    ) -> Self {
        let lagrangian = problem.lagrangian;
        let forms: Vec<Arc<Form>> = (0..lagrangian.coefficients.len())
            .into_par_iter()
            .map(|m| Arc::new(start::forms(lagrangian, table, m)))
            .collect();
        let mut descent = Descent {
            moves,
            errors: errors(lagrangian.dof, table, &forms),
            simpler: vec![None; forms.len()],
            history: vec![Vec::new(); forms.len()],
            barred: None,
            keen: 1.0,
            united: BTreeMap::new(),
            costs,
            table,
            forms,
        };
        descent.refresh();
        descent
    }
}

/// The members with errors up to `most`, of a descent from `start` as `keen` on large steps as that.
pub(super) fn members(
    problem: &SparseProblem,
    candidates: &[CandidateFunction],
    start: &Descent,
    most: f64,
    keen: f64,
) -> Vec<SparseCandidate> {
    let mut descent = Descent { keen, ..start.clone() };
    let (dof, table) = (problem.lagrangian.dof, start.table);
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
            let mut tight = descent.bare();
            tight.tighten();
            let room = (TIED * level).max(largest(&tight.errors));
            let forms = tied(table, &tight.forms, &tight.errors, room);
            let error = largest(&errors(dof, table, &forms));
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
    /// The same forms without past and future.
    fn bare(&self) -> Self {
        let count = self.forms.len();
        Self {
            forms: self.forms.clone(),
            errors: self.errors.clone(),
            simpler: vec![None; count],
            united: BTreeMap::new(),
            history: vec![Vec::new(); count],
            barred: None,
            ..*self
        }
    }

    /// Takes exchanges as long as one is admitted.
    pub(super) fn descend(&mut self, level: f64) {
        while let Some(exchange) = self.best(level) {
            self.take(exchange);
        }
    }

    /// The cost of the model as it stands.
    pub(super) fn cost(&self) -> usize {
        self.costs.of(self.forms.iter().map(|form| (form.members.as_slice(), form.kept.as_slice())))
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

    /// Of the exchanges that leave all errors within `level` the one that saves most operations per burden added.
    fn best(&mut self, level: f64) -> Option<Exchange> {
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

    fn forms_of(&self, slots: &[usize]) -> Vec<&Form> {
        slots.iter().map(|&s| &*self.forms[s]).collect()
    }

    /// The form of the exchange, or its functions fitted again, where that keeps all errors within `level`.
    fn admitted(&self, exchange: &Exchange, level: f64) -> Option<Arc<Form>> {
        let old = self.forms_of(&exchange.slots);
        let form = &exchange.form;
        let refits = old.len() == 1 && form.members.len() == 1 && (1..=REFITTED).contains(&form.kept.len());
        let most = if refits { NEARLY * level } else { level };
        let reached = self.largest_with(&old, form, most)?;
        if reached <= level { Some(form.clone()) } else { self.refitted(&old, form, level).map(Arc::new) }
    }

    /// As [`Self::fitted_to_room`], where that keeps all errors within `level`.
    fn refitted(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let inverse = self.inverse_room(old, form, level)?;
        let new = Form::within(self.table, form.members.clone(), form.kept.clone(), &inverse)?;
        self.largest_with(old, &new, level).map(|_| new)
    }

    /// The form with the parameters that keep it furthest within what the others leave of `level`.
    pub(super) fn fitted_to_room(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let inverse = self.inverse_room(old, form, level)?;
        Some(Form::fitted(self.table, form.members.clone(), form.kept.clone(), Some(&inverse)))
    }

    /// By point what the others leave of `level`, inverted; `None` for forms that are not fitted to it.
    fn inverse_room(&self, old: &[&Form], form: &Form, level: f64) -> Option<Vec<f64>> {
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
        Some((0..residual.len()).map(|point| 1.0 / room(point).max(floor)).collect())
    }

    /// The largest error with `new` in the place of `old`, where that is no more than `most`.
    fn largest_with(&self, old: &[&Form], new: &Form, most: f64) -> Option<f64> {
        let residuals: Vec<&Vec<f64>> = old.iter().flat_map(|form| &form.residuals).collect();
        let mut largest = 0.0_f64;
        let mut changed = vec![0.0; self.table.points()];
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
            let change = |point: usize| -> f64 {
                parts.iter().map(|(u, r, s)| u * (r[point].abs() - s[point].abs())).sum()
            };
            // Where the new form leaves most, errors are likely to be too large.
            if new.worst.iter().any(|&point| errors[point] + change(point) > most) {
                return None;
            }
            match parts.as_slice() {
                [(u, r, s)] => {
                    for (((out, e), r), s) in changed.iter_mut().zip(errors).zip(*r).zip(*s) {
                        *out = e + u * (r.abs() - s.abs());
                    }
                }
                _ => changed
                    .iter_mut()
                    .zip(errors)
                    .enumerate()
                    .for_each(|(point, (out, e))| *out = e + change(point)),
            }
            largest = largest_of(&changed, largest);
            if largest > most {
                return None;
            }
        }
        Some(largest)
    }

    fn take(&mut self, exchange: Exchange) {
        let old: Vec<Arc<Form>> = exchange.slots.iter().map(|&s| self.forms[s].clone()).collect();
        let forms: Vec<&Form> = old.iter().map(|form| &**form).collect();
        self.errors = exchanged(self.table, &self.errors, &forms, &exchange.form);
        let Some(&first) = exchange.slots.first() else { return };
        self.history[first].push(exchange.slots.iter().copied().zip(old).collect());
        for &s in exchange.slots.iter() {
            self.put(s, Arc::new(Form::nothing()));
        }
        self.put(first, exchange.form);
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
        let simpler: Vec<Vec<Arc<Form>>> = new.par_iter().map(|&s| moves.simpler(table, &forms[s])).collect();
        let keys: Vec<(usize, usize)> = new
            .iter()
            .flat_map(|&s| (0..forms.len()).filter(move |&t| t != s).map(move |t| (s.min(t), s.max(t))))
            .filter(|(a, b)| !forms[*a].kept.is_empty() && !forms[*b].kept.is_empty())
            .collect();
        let both: Vec<Vec<Arc<Form>>> =
            keys.par_iter().map(|&(a, b)| moves.united(table, &forms[a], &forms[b])).collect();
        for (s, forms) in new.into_iter().zip(simpler) {
            self.simpler[s] = Some(Arc::new(forms));
        }
        let both = keys.into_iter().zip(both.into_iter().map(Arc::new));
        self.united.extend(both.filter(|(_, forms)| !forms.is_empty()));
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
    errors.iter().fold(0.0, |most, row| largest_of(row, most))
}

/// The largest of `values` and `least`; comparisons side by side do not wait for one another.
fn largest_of(values: &[f64], least: f64) -> f64 {
    let mut most = [least; 8];
    let (eights, rest) = values.as_chunks::<8>();
    for eight in eights {
        for (most, x) in most.iter_mut().zip(eight) {
            *most = if x > most { *x } else { *most };
        }
    }
    most.iter().chain(rest).fold(least, |most, &x| most.max(x))
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
