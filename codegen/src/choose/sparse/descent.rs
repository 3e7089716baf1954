//! The descent: at each step every exchange that the step's error admits, the one with the best return first.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::cost::Costs;
use super::exchange::Exchange;
use super::fitting::{Form, Table};
use super::moves::Moves;
use super::room::{errors, largest};
use super::ties::{exchanged, tied};
use super::{STEP, STRICTEST, SparseCandidate, SparseProblem, start};
use crate::parallel::Parallelize;
use crate::reduction::{CandidateFunction, Group, Sparse};

/// Ratio of the levels at which the descent is polished.
const POLISH: f64 = 1.2;
/// Ties may bring the errors back up to this part of the level.
const TIED: f64 = 0.97;

/// Slots with the forms that an exchange took out of them.
type Before = Vec<(usize, Arc<Form>)>;

/// Where the descent stands. Cheap to copy.
#[derive(Clone)]
pub(super) struct Descent<'a> {
    pub table: &'a Table,
    pub(super) costs: &'a Costs,
    moves: &'a Moves<'a>,
    /// By slot.
    pub forms: Vec<Arc<Form>>,
    /// By joint and point.
    pub errors: Vec<Vec<f64>>,
    pub(super) simpler: Vec<Option<Arc<Vec<Arc<Form>>>>>,
    pub(super) united: BTreeMap<(usize, usize), Arc<Vec<Arc<Form>>>>,
    /// What each exchange took the place of, by the slot of its form.
    pub history: Vec<Vec<Before>>,
    /// A slot and the functions that it is not to keep again.
    pub barred: Option<(usize, Vec<usize>)>,
    /// Power of the operations saved in the score of an exchange; below 1 small steps are preferred.
    pub(super) keen: f64,
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
    pub(super) fn refresh(&mut self) {
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
