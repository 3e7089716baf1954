//! Cheaper forms in place of the ones that a model has.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use super::cost::Costs;
use super::fitting::{Form, LARGE, Table};
use super::squares::{Squares, independent};
use crate::lagrangian::{Function, Lagrangian};
use crate::reduction::CandidateFunction;

/// Longer forms only lose functions.
const LONG: usize = 8;
/// Longer forms are not united.
const UNITED: usize = 5;
/// Parameters of the same function in two forms to be united differ by no more than this factor.
const ALIKE: f64 = 1.4;

/// So many forms are remembered at most; of a PUMA 560 they take some tens of megabytes.
const REMEMBERED: usize = 1 << 14;

/// Members, with the bits of their signs, and functions of a form.
type Key = (Vec<(usize, u64)>, Vec<usize>);

/// The candidates by the ψ that they contain.
pub(super) struct Moves<'a> {
    candidates: &'a [CandidateFunction],
    costs: &'a Costs,
    /// Products by ψ, without the constant.
    containing: Vec<Vec<usize>>,
    one: Option<usize>,
    /// Forms fitted before: a descent comes to the same ones again and again.
    fitted: Mutex<BTreeMap<Key, Arc<Form>>>,
}

impl<'a> Moves<'a> {
    pub fn new(lagrangian: &Lagrangian, candidates: &'a [CandidateFunction], costs: &'a Costs) -> Self {
        let one = lagrangian.functions.iter().position(|psi| *psi == Function::ONE);
        let mut containing = vec![Vec::new(); lagrangian.functions.len()];
        for (f, candidate) in candidates.iter().enumerate() {
            for &(l, _) in candidate.expansion.iter().filter(|(l, _)| Some(*l) != one) {
                containing[l].push(f);
            }
        }
        Self { candidates, costs, containing, one, fitted: Mutex::default() }
    }

    /// [`Form::fitted`] without regard to room.
    fn fitted(&self, table: &Table, members: Vec<(usize, f64)>, kept: Vec<usize>) -> Arc<Form> {
        let key = (members.iter().map(|&(m, sign)| (m, sign.to_bits())).collect(), kept);
        let known = || self.fitted.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(form) = known().get(&key) {
            return form.clone();
        }
        let form = Arc::new(Form::fitted(table, members, key.1.clone(), None));
        let mut known = known();
        if known.len() >= REMEMBERED {
            known.clear();
        }
        known.insert(key, form.clone());
        form
    }

    /// `form` with one function less, or with a cheaper function in place of one or more.
    pub fn simpler(&self, table: &Table, form: &Form) -> Vec<Arc<Form>> {
        if form.kept.len() > LONG.max(LARGE + 1)
            && let Some(shorter) = shorter(table, form)
        {
            return shorter;
        }
        let mut choices: BTreeSet<Vec<usize>> = BTreeSet::new();
        let without = |gone: &dyn Fn(usize) -> bool| -> Vec<usize> {
            form.kept.iter().copied().filter(|&f| !gone(f)).collect()
        };
        for &f in &form.kept {
            choices.insert(without(&|other| other == f));
            if form.kept.len() > LONG || Some(f) == self.one {
                continue;
            }
            let single = self.candidates[f].factors.len() == 1;
            let parts = &self.candidates[f].expansion;
            for &other in parts.iter().flat_map(|&(l, _)| &self.containing[l]) {
                if form.kept.contains(&other) || (single && self.candidates[other].factors.len() == 1) {
                    continue;
                }
                // A product takes the place of all the ψ in it, of another product alone.
                let covered = |l: usize| self.candidates[other].expansion.iter().any(|part| part.0 == l);
                let mut kept = if single {
                    without(&|f| Some(f) != self.one && self.candidates[f].factors.len() == 1 && covered(f))
                } else {
                    without(&|g| g == f)
                };
                kept.push(other);
                kept.sort_unstable();
                let dearer = self.costs.alone[other] > self.costs.alone[f];
                let gain =
                    if single { !dearer && self.costs.alone[other] < self.costs.alone[f] } else { !dearer };
                if kept.len() < form.kept.len() || gain {
                    choices.insert(kept);
                }
            }
        }
        choices.into_iter().map(|kept| self.fitted(table, form.members.clone(), kept)).collect()
    }

    /// One form for the coefficients of both, where theirs are alike.
    pub fn united(&self, table: &Table, a: &Form, b: &Form) -> Vec<Arc<Form>> {
        let alike = a.kept.len().abs_diff(b.kept.len()) <= 1 && a.kept.len().max(b.kept.len()) <= UNITED;
        let parameter = |form: &Form, f: usize| {
            form.kept.iter().position(|&kept| kept == f).map(|place| form.parameters[place])
        };
        let shared = a.kept.iter().find_map(|&f| Some(parameter(a, f)? / parameter(b, f)?));
        let Some(ratio) = shared.filter(|ratio| alike && ratio.abs() < ALIKE && ratio.abs() > 1.0 / ALIKE)
        else {
            return Vec::new();
        };
        let turned = b.members.iter().map(|&(m, sign)| (m, sign * ratio.signum()));
        let members: Vec<_> = a.members.iter().copied().chain(turned).collect();
        let mut choices = vec![&a.kept];
        if a.kept != b.kept {
            choices.push(&b.kept);
        }
        choices.into_iter().map(|kept| self.fitted(table, members.clone(), kept.clone())).collect()
    }
}

/// A form of one coefficient with one function less, by least squares; `None` where there are several coefficients.
fn shorter(table: &Table, form: &Form) -> Option<Vec<Arc<Form>>> {
    let &[(m, sign)] = form.members.as_slice() else { return None };
    let columns: Vec<&Vec<f64>> = form.kept.iter().map(|&f| &table.functions[f]).collect();
    let values: Vec<f64> = table.coefficients[m].iter().map(|alpha| sign * alpha).collect();
    let Some(squares) = Squares::new(&columns, &values) else {
        let kept: Vec<usize> = independent(&columns).into_iter().map(|i| form.kept[i]).collect();
        let fewer = kept.len() < form.kept.len();
        return fewer.then(|| vec![Arc::new(Form::fitted(table, form.members.clone(), kept, None))]);
    };
    let without = |gone: usize| {
        let rest = || (0..form.kept.len()).filter(move |&i| i != gone);
        let parameters = squares.without(gone);
        let kept = rest().map(|i| form.kept[i]).collect();
        Arc::new(Form::with(table, form.members.clone(), kept, rest().map(|i| parameters[i]).collect()))
    };
    Some((0..form.kept.len()).map(without).collect())
}
