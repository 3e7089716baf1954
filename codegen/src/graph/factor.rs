//! Fewer operations for the same values: common factors are taken out of sums, products and partial sums that occur
//! twice are computed once, constants are multiplied beforehand.
//!
//! The graph is taken apart into sums of products, and the change that saves most is made until none saves anything.
//! Values change by rounding alone.

use std::collections::BTreeMap;

use super::{Builder, Expr, Graph, Name, Node};

/// A leaf or a named sum, by index.
type Atom = usize;

/// coefficient · Π factors; the factors sorted, none for a constant.
#[derive(Clone, Debug, PartialEq)]
struct Term {
    coefficient: f64,
    factors: Vec<Atom>,
}

/// What an atom stands for.
#[derive(Clone, Debug)]
enum Meaning {
    Leaf(Node),
    Sum(Vec<Term>),
}

/// A sum of products taken apart.
#[derive(Debug, Default)]
struct System {
    meanings: Vec<Meaning>,
    names: Vec<Option<Name>>,
    /// Atom and sign of each result.
    outputs: Vec<Vec<Term>>,
    output_names: Vec<Option<Name>>,
}

/// A change and the operations that it saves.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    /// Take an atom out of the terms of a sum that have it.
    Factor(Atom, Atom),
    /// Take a constant (its bits) out.
    Scale(Atom, u64),
    /// Compute the product of two atoms once.
    Product(Atom, Atom),
    /// Compute a constant multiple once.
    Multiple(u64, Atom),
    /// Compute the sum or difference of two products once.
    Pair(Key, Key, bool),
}

/// A term without its sign.
type Key = (u64, Vec<Atom>);

impl Graph {
    /// The same function with fewer operations, or this graph where nothing can be saved.
    pub fn factored(&self) -> Graph {
        let mut system = System::new(self);
        let mut least = usize::MAX;
        loop {
            system.sweep();
            system.fold();
            system.sweep();
            let cost = system.cost();
            if cost >= least {
                break;
            }
            least = cost;
            let Some(change) = system.best() else { break };
            system.make(&change);
        }
        let out = system.graph();
        let pays = out.operations().arithmetic() < self.operations().arithmetic();
        if pays && out.is_finite() { out } else { self.clone() }
    }
}

impl System {
    fn new(graph: &Graph) -> Self {
        let uses = graph.uses();
        let mut system = Self::default();
        let mut sums: Vec<Vec<Term>> = Vec::with_capacity(graph.nodes.len());
        for (id, node) in graph.nodes.iter().enumerate() {
            let name = graph.names[id].clone();
            let sum = match *node {
                Node::Constant(bits) => {
                    vec![Term { coefficient: f64::from_bits(bits), factors: Vec::new() }]
                }
                Node::Input(_) | Node::Sin(_) | Node::Cos(_) => {
                    vec![atom(system.add(Meaning::Leaf(*node), name.clone()))]
                }
                Node::Add(a, b) => joined(&sums[a], &sums[b], 1.0),
                Node::Sub(a, b) => joined(&sums[a], &sums[b], -1.0),
                Node::Neg(a) => joined(&[], &sums[a], -1.0),
                Node::Mul(a, b) => {
                    let (a, b) = (system.single(&sums[a]), system.single(&sums[b]));
                    vec![product(&a, &b)]
                }
            };
            sums.push(if uses[id] > 1 && !is_alias(&sum) {
                vec![atom(system.add(Meaning::Sum(sum), name))]
            } else {
                sum
            });
        }
        for &output in &graph.outputs {
            system.outputs.push(sums[output].clone());
            system.output_names.push(graph.names[output].clone());
        }
        system
    }

    fn add(&mut self, meaning: Meaning, name: Option<Name>) -> Atom {
        self.meanings.push(meaning);
        self.names.push(name);
        self.meanings.len() - 1
    }

    /// The sum as one term: itself, or an atom for it.
    fn single(&mut self, sum: &[Term]) -> Term {
        match sum {
            [term] => term.clone(),
            _ => atom(self.add(Meaning::Sum(sum.to_vec()), None)),
        }
    }

    /// All sums: those of the atoms, then the results.
    fn sums(&self) -> impl Iterator<Item = &Vec<Term>> {
        let inner = self.meanings.iter().filter_map(|meaning| match meaning {
            Meaning::Sum(terms) => Some(terms),
            Meaning::Leaf(_) => None,
        });
        inner.chain(&self.outputs)
    }

    fn sums_mut(&mut self) -> impl Iterator<Item = &mut Vec<Term>> {
        let inner = self.meanings.iter_mut().filter_map(|meaning| match meaning {
            Meaning::Sum(terms) => Some(terms),
            Meaning::Leaf(_) => None,
        });
        inner.chain(&mut self.outputs)
    }

    fn sum_mut(&mut self, index: usize) -> Option<&mut Vec<Term>> {
        let atoms = self.meanings.len();
        match self.meanings.get_mut(index) {
            Some(Meaning::Sum(terms)) => Some(terms),
            Some(Meaning::Leaf(_)) => None,
            None => self.outputs.get_mut(index - atoms),
        }
    }

    /// Empties the sums that no result needs.
    fn sweep(&mut self) {
        let mut needed = vec![false; self.meanings.len()];
        let mut open: Vec<Atom> = self.outputs.iter().flatten().flat_map(|t| t.factors.clone()).collect();
        while let Some(index) = open.pop() {
            if !std::mem::replace(&mut needed[index], true)
                && let Meaning::Sum(terms) = &self.meanings[index]
            {
                open.extend(terms.iter().flat_map(|term| &term.factors));
            }
        }
        for (meaning, needed) in self.meanings.iter_mut().zip(needed) {
            if let Meaning::Sum(terms) = meaning
                && !needed
            {
                terms.clear();
            }
        }
    }

    /// Writes atoms out where that costs nothing: what is used once, and k·x wherever other constants multiply it anyway;
    /// takes the sign of a product into what uses it.
    fn fold(&mut self) {
        for index in 0..self.meanings.len() {
            let Meaning::Sum(meaning) = &self.meanings[index] else { continue };
            let (mut uses, mut scaled, mut bare) = (0, 0, 0);
            for user in self.sums().flatten() {
                let times = user.factors.iter().filter(|&&factor| factor == index).count();
                let constant = user.coefficient.abs() != 1.0;
                uses += times;
                scaled += if constant { times } else { 0 };
                bare += usize::from(times == 1 && user.factors.len() == 1 && !constant);
            }
            match meaning.as_slice() {
                [] => {}
                [term] => {
                    let term = term.clone();
                    let constant = term.coefficient.abs() != 1.0;
                    let short = term.factors.len() <= 1;
                    if uses == 1 || (short && (!constant || scaled == uses)) {
                        self.write_out(index, &term);
                    } else if term.coefficient < 0.0 {
                        self.meanings[index] =
                            Meaning::Sum(vec![Term { coefficient: -term.coefficient, ..term }]);
                        self.write_out(index, &Term { coefficient: -1.0, factors: vec![index] });
                    }
                }
                terms if uses == 1 && bare == 1 => {
                    let terms = terms.to_vec();
                    for sum in self.sums_mut() {
                        if let Some(at) = sum.iter().position(|term| term.factors == [index]) {
                            let sign = sum.remove(at).coefficient;
                            *sum = joined(sum, &terms, sign);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    /// Puts `term` in the place of an atom everywhere.
    fn write_out(&mut self, index: Atom, term: &Term) {
        for sum in self.sums_mut() {
            let mut found = false;
            for user in sum.iter_mut() {
                let times = user.factors.iter().filter(|&&factor| factor == index).count();
                user.factors.retain(|&factor| factor != index);
                for _ in 0..times {
                    *user = product(user, term);
                }
                found |= times > 0;
            }
            if found {
                *sum = joined(sum, &[], 1.0);
            }
        }
    }

    /// Operations in all sums.
    fn cost(&self) -> usize {
        self.sums().map(|sum| sum.iter().map(costs).sum::<usize>() + sum.len().saturating_sub(1)).sum()
    }

    /// The change that saves most; of equals the first.
    fn best(&self) -> Option<Change> {
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
                    *within.entry(Change::Scale(index, bits)).or_default() += 1;
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

    fn make(&mut self, change: &Change) {
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
            Change::Scale(index, bits) => {
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

    fn graph(&self) -> Graph {
        let builder = Builder::new();
        let mut made: Vec<Option<Expr>> = vec![None; self.meanings.len()];
        // Names and lines in the order of the original; what it did not have, where it is needed first.
        for index in 0..self.meanings.len() {
            if self.names[index].is_some()
                && !matches!(&self.meanings[index], Meaning::Sum(terms) if terms.is_empty())
            {
                self.write(&builder, index, &mut made);
            }
        }
        let outputs: Vec<_> = self
            .outputs
            .iter()
            .zip(&self.output_names)
            .map(|(sum, name)| {
                let value = self.write_sum(&builder, sum, &mut made);
                name.iter().for_each(|name| {
                    value.named(&name.text, name.own_line);
                });
                value.id()
            })
            .collect();
        builder.finish(&outputs)
    }

    fn write<'g>(&self, builder: &'g Builder, index: Atom, made: &mut Vec<Option<Expr<'g>>>) -> Expr<'g> {
        if let Some(known) = made[index] {
            return known;
        }
        let value = match &self.meanings[index] {
            Meaning::Leaf(Node::Input(variable)) => builder.input(*variable),
            Meaning::Leaf(Node::Sin(joint)) => builder.sin_cos(*joint).0,
            Meaning::Leaf(Node::Cos(joint)) => builder.sin_cos(*joint).1,
            Meaning::Leaf(_) => builder.constant(0.0),
            Meaning::Sum(terms) => self.write_sum(builder, terms, made),
        };
        if let Some(name) = &self.names[index]
            && !value.is_constant()
        {
            value.named(&name.text, name.own_line);
        }
        made[index] = Some(value);
        value
    }

    fn write_sum<'g>(
        &self,
        builder: &'g Builder,
        terms: &[Term],
        made: &mut Vec<Option<Expr<'g>>>,
    ) -> Expr<'g> {
        // A positive term first: a sum that begins with a minus costs one more.
        let (plus, minus): (Vec<_>, Vec<_>) = terms.iter().partition(|term| term.coefficient > 0.0);
        let opposite = plus.is_empty();
        let mut sum = builder.constant(0.0);
        for term in plus.into_iter().chain(minus) {
            let mut value = builder.constant(1.0);
            for &factor in &term.factors {
                value = value * self.write(builder, factor, made);
            }
            value = value * builder.constant(term.coefficient.abs());
            sum = if term.coefficient > 0.0 || opposite { sum + value } else { sum - value };
        }
        if opposite { -sum } else { sum }
    }
}

fn atom(index: Atom) -> Term {
    Term { coefficient: 1.0, factors: vec![index] }
}

/// True for ± one atom, and for a constant.
fn is_alias(sum: &[Term]) -> bool {
    match sum {
        [] => true,
        [term] => term.factors.is_empty() || (term.factors.len() == 1 && term.coefficient.abs() == 1.0),
        _ => false,
    }
}

fn product(a: &Term, b: &Term) -> Term {
    let mut factors = [a.factors.as_slice(), &b.factors].concat();
    factors.sort_unstable();
    Term { coefficient: a.coefficient * b.coefficient, factors }
}

/// a + sign·b with like terms collected.
fn joined(a: &[Term], b: &[Term], sign: f64) -> Vec<Term> {
    let mut sum: Vec<Term> = Vec::with_capacity(a.len() + b.len());
    let second = b.iter().map(|term| Term { coefficient: sign * term.coefficient, ..term.clone() });
    for term in a.iter().cloned().chain(second) {
        match sum.iter_mut().find(|known| known.factors == term.factors) {
            Some(known) => known.coefficient += term.coefficient,
            None => sum.push(term),
        }
    }
    sum.retain(|term| term.coefficient != 0.0);
    sum
}

/// Multiplications in a term.
fn costs(term: &Term) -> usize {
    (term.factors.len() + usize::from(term.coefficient.abs() != 1.0)).saturating_sub(1)
}

fn key(term: &Term) -> Key {
    (term.coefficient.abs().to_bits(), term.factors.clone())
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
