//! What can be changed in a system of sums so that it costs less, and the changes themselves.

use std::collections::BTreeMap;

use super::terms::{Atom, Key, Term, atom, costs, joined, key, product};
use super::{Meaning, System};

/// A change and the operations that it saves.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Change {
    /// Take an atom out of the terms of a sum that have it.
    Factor(Atom, Atom),
    /// Take a constant (its bits) out.
    TorqueScale(Atom, u64),
    /// Compute the product of two atoms once.
    Product(Atom, Atom),
    /// Compute a constant multiple once.
    Multiple(u64, Atom),
    /// Compute the sum or difference of two products once.
    Pair(Key, Key, bool),
}

impl System {
    /// The change that saves most; of equals the first.
    pub(super) fn best(&self) -> Option<Change> {
        let mut within: BTreeMap<Change, usize> = BTreeMap::new();
        let mut products: BTreeMap<Change, usize> = BTreeMap::new();
        let mut pairs: BTreeMap<Change, (usize, usize)> = BTreeMap::new();
        let atoms = self.meanings.len();
        let inner = (0..atoms).filter_map(|index| match &self.meanings[index] {
            Meaning::Sum(terms) => Some((index, terms)),
            _ => None,
        });
        let results = self.outputs.iter().enumerate().map(|(i, terms)| (atoms + i, terms));
        for (index, terms) in inner.chain(results) {
            for (i, term) in terms.iter().enumerate() {
                let mut last = None;
                for &factor in &term.factors {
                    if last != Some(factor) {
                        if costs(term) > 0 {
                            *within.entry(Change::Factor(index, factor)).or_default() += 1;
                        }
                        if term.coefficient.abs() != 1.0 {
                            let bits = term.coefficient.abs().to_bits();
                            *products.entry(Change::Multiple(bits, factor)).or_default() += 1;
                        }
                    }
                    last = Some(factor);
                }
                if term.coefficient.abs() != 1.0 && !term.factors.is_empty() {
                    let bits = term.coefficient.abs().to_bits();
                    *within.entry(Change::TorqueScale(index, bits)).or_default() += 1;
                }
                let mut seen = Vec::new();
                for (at, &a) in term.factors.iter().enumerate() {
                    for &b in &term.factors[at + 1..] {
                        if !seen.contains(&(a, b)) {
                            seen.push((a, b));
                            *products.entry(Change::Product(a, b)).or_default() += 1;
                        }
                    }
                }
                for other in &terms[i + 1..] {
                    let (change, cost) = pair(term, other);
                    let entry = pairs.entry(change).or_default();
                    *entry = (entry.0 + 1, cost);
                }
            }
        }
        let mut best: Option<(usize, Change)> = None;
        let mut offer = |saved: usize, change: Change| {
            if saved > 0 && best.as_ref().is_none_or(|(most, _)| saved > *most) {
                best = Some((saved, change));
            }
        };
        for (change, (count, cost)) in pairs {
            offer((count - 1) * cost, change);
        }
        for (change, count) in products.into_iter().chain(within) {
            offer(count - 1, change);
        }
        best.map(|(_, change)| change)
    }

    pub(super) fn make(&mut self, change: &Change) {
        match change {
            Change::Factor(index, factor) => self.take_out(
                *index,
                |term| {
                    let at = term.factors.iter().position(|f| f == factor && costs(term) > 0)?;
                    let mut rest = term.clone();
                    rest.factors.remove(at);
                    Some(rest)
                },
                &Term { coefficient: 1.0, factors: vec![*factor] },
            ),
            Change::TorqueScale(index, bits) => {
                let constant = f64::from_bits(*bits);
                self.take_out(
                    *index,
                    |term| {
                        let fits = term.coefficient.abs() == constant && !term.factors.is_empty();
                        fits.then(|| Term { coefficient: term.coefficient.signum(), ..term.clone() })
                    },
                    &Term { coefficient: constant, factors: Vec::new() },
                );
            }
            Change::Product(a, b) => {
                let new = self.known(vec![Term { coefficient: 1.0, factors: vec![*a, *b] }]);
                for term in self.sums_mut().flatten() {
                    while let Some(rest) = without(&term.factors, *a, *b) {
                        *term = product(&Term { coefficient: term.coefficient, factors: rest }, &atom(new));
                    }
                }
                self.meanings[new] = Meaning::Sum(vec![Term { coefficient: 1.0, factors: vec![*a, *b] }]);
            }
            Change::Multiple(bits, a) => {
                let constant = f64::from_bits(*bits);
                let meaning = vec![Term { coefficient: constant, factors: vec![*a] }];
                let new = self.known(meaning.clone());
                for term in self.sums_mut().flatten() {
                    if term.coefficient.abs() == constant
                        && let Some(at) = term.factors.iter().position(|f| f == a)
                    {
                        term.factors.remove(at);
                        let sign =
                            Term { coefficient: term.coefficient.signum(), factors: term.factors.clone() };
                        *term = product(&sign, &atom(new));
                    }
                }
                self.meanings[new] = Meaning::Sum(meaning);
            }
            Change::Pair(a, b, opposite) => {
                let term = |key: &Key, sign: f64| Term {
                    coefficient: sign * f64::from_bits(key.0),
                    factors: key.1.clone(),
                };
                let meaning = vec![term(a, 1.0), term(b, if *opposite { -1.0 } else { 1.0 })];
                let new = self.known(meaning.clone());
                for terms in self.sums_mut() {
                    while let Some((first, second)) = place(terms, a, b, *opposite) {
                        let sign = terms[first].coefficient.signum();
                        terms[first] = Term { coefficient: sign, factors: vec![new] };
                        terms.remove(second);
                        *terms = joined(terms, &[], 1.0);
                    }
                }
                self.meanings[new] = Meaning::Sum(meaning);
            }
        }
    }

    /// Replaces the terms of sum `index` for which `rest` finds one by `factor` times the sum of what it finds.
    fn take_out(&mut self, index: usize, rest: impl Fn(&Term) -> Option<Term>, factor: &Term) {
        let Some(terms) = self.sum_mut(index) else { return };
        let mut inner: Vec<Term> = terms.iter().filter_map(&rest).collect();
        let first = terms.iter().position(|term| rest(term).is_some()).unwrap_or(0);
        let mut outer: Vec<Term> = terms.iter().filter(|term| rest(term).is_none()).cloned().collect();
        let sign = inner.first().map_or(1.0, |term| term.coefficient.signum());
        inner.iter_mut().for_each(|term| term.coefficient *= sign);
        let inner = joined(&inner, &[], 1.0);
        let atoms = self.meanings.len();
        let sum = match inner.as_slice() {
            [term] => term.clone(),
            _ => atom(self.known(inner)),
        };
        let grown = self.meanings.len() - atoms;
        let signed = Term { coefficient: sign * factor.coefficient, factors: factor.factors.clone() };
        outer.insert(first.min(outer.len()), product(&signed, &sum));
        let index = if index >= atoms { index + grown } else { index };
        if let Some(terms) = self.sum_mut(index) {
            *terms = joined(&outer, &[], 1.0);
        }
    }

    /// An atom that means `sum`: one that does already, or a new one.
    fn known(&mut self, sum: Vec<Term>) -> Atom {
        let found = self.meanings.iter().position(|meaning| match meaning {
            Meaning::Sum(terms) => terms.len() == sum.len() && sum.iter().all(|term| terms.contains(term)),
            Meaning::Leaf(_) => false,
        });
        found.unwrap_or_else(|| self.add(Meaning::Sum(sum), None))
    }
}

/// The two terms as a change, in a fixed order, and what computing them costs.
fn pair(a: &Term, b: &Term) -> (Change, usize) {
    let opposite = (a.coefficient < 0.0) != (b.coefficient < 0.0);
    let (first, second) = if key(a) <= key(b) { (key(a), key(b)) } else { (key(b), key(a)) };
    (Change::Pair(first, second, opposite), 1 + costs(a) + costs(b))
}

/// Where a sum has the two terms.
fn place(terms: &[Term], a: &Key, b: &Key, opposite: bool) -> Option<(usize, usize)> {
    if terms.len() < 2 {
        return None;
    }
    let find = |wanted: &Key| terms.iter().position(|term| key(term) == *wanted);
    let (first, second) = (find(a)?, find(b)?);
    let differ = (terms[first].coefficient < 0.0) != (terms[second].coefficient < 0.0);
    (first != second && differ == opposite).then_some((first, second))
}

/// `factors` without one `a` and one `b`.
fn without(factors: &[Atom], a: Atom, b: Atom) -> Option<Vec<Atom>> {
    let mut rest = factors.to_vec();
    rest.remove(rest.iter().position(|&f| f == a)?);
    rest.remove(rest.iter().position(|&f| f == b)?);
    Some(rest)
}
