//! What a sparse model costs, counted on its structure as the code will compute it.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use crate::graph::TRIG_PAIR;
use crate::lagrangian::{Function, Lagrangian, MAX_JOINTS};
use crate::reduction::CandidateFunction;
use crate::reduction::{Rate, Term, grouped, rates, summed};

/// Costs of candidates and of the places where coefficients stand.
pub(super) struct Costs {
    /// Nodes that a candidate needs.
    needs: Vec<Vec<usize>>,
    /// Operations of each node.
    nodes: Vec<usize>,
    /// Operations of each candidate alone.
    pub alone: Vec<usize>,
    /// The candidate that is 1.
    constant: Vec<bool>,
    /// By coefficient and row: rates with signs.
    places: Vec<Vec<Vec<Term>>>,
    /// Their [`summed`] by coefficient, sign (1 where it is turned) and row.
    alone_in_group: Vec<[Vec<Vec<Term>>; 2]>,
    dof: usize,
    /// [`crate::lagrangian::Coordinates::onto`] of a model in absolute angles.
    onto: Vec<i8>,
}

impl Costs {
    pub fn new(lagrangian: &Lagrangian, candidates: &[CandidateFunction], onto: Option<&[i8]>) -> Self {
        let mut table = Nodes::default();
        let needs: Vec<Vec<usize>> =
            candidates.iter().map(|c| table.candidate(lagrangian, c).into_iter().collect()).collect();
        let alone = needs.iter().map(|needs| needs.iter().map(|&node| table.costs[node]).sum()).collect();
        let is_one =
            |c: &CandidateFunction| c.factors.iter().all(|&l| lagrangian.functions[l] == Function::ONE);
        let places: Vec<_> = (0..lagrangian.coefficients.len()).map(|m| rates(lagrangian, m)).collect();
        let of_sign = |rows: &Vec<Vec<Term>>, sign: f64| -> Vec<Vec<Term>> {
            rows.iter().map(|row| summed(row.iter().map(|term| turned(term, sign)).collect()).0).collect()
        };
        Self {
            alone_in_group: places.iter().map(|rows| [1.0, -1.0].map(|sign| of_sign(rows, sign))).collect(),
            needs,
            alone,
            constant: candidates.iter().map(is_one).collect(),
            nodes: table.costs,
            places,
            dof: lagrangian.dof,
            onto: onto.map_or(vec![0; lagrangian.dof], <[i8]>::to_vec),
        }
    }

    /// Operations of a model, given members and functions of its groups; an empty group costs nothing.
    pub fn of<'a>(&self, groups: impl Iterator<Item = (&'a [(usize, f64)], &'a [usize])>) -> usize {
        let mut cost = 0;
        let mut built = vec![false; self.nodes.len()];
        let mut in_row = vec![0_usize; self.dof];
        let mut single: BTreeSet<Rate> = BTreeSet::new();
        let mut sums: BTreeSet<Vec<Term>> = BTreeSet::new();
        let mut products: Vec<Cow<[Term]>> = Vec::new();
        for (members, functions) in groups.filter(|(_, functions)| !functions.is_empty()) {
            cost += functions.len() - 1;
            for &f in functions {
                cost += usize::from(!self.constant[f]);
                for &node in &self.needs[f] {
                    if !std::mem::replace(&mut built[node], true) {
                        cost += self.nodes[node];
                    }
                }
            }
            products.clear();
            for (row, count) in in_row.iter_mut().enumerate() {
                let terms = self.row(members, row);
                if terms.is_empty() {
                    continue;
                }
                *count += 1;
                if *terms == [(Rate::One, 1)] || products.contains(&terms) {
                    continue;
                }
                cost += 1;
                if let [(rate, _)] = *terms {
                    single.insert(rate);
                } else if !sums.contains(&*terms) {
                    sums.insert(terms.to_vec());
                }
                products.push(terms);
            }
        }
        let rates = single.iter().copied().chain(sums.iter().flatten().map(|term| term.0));
        cost += self.relative(rates, &in_row);
        cost += grouped(&sums, single).0;
        cost + in_row.iter().map(|count| count.saturating_sub(1)).sum::<usize>()
    }

    /// What the group of `members` is multiplied by in a row, as [`summed`] has it.
    fn row(&self, members: &[(usize, f64)], row: usize) -> Cow<'_, [Term]> {
        if let &[(m, sign)] = members {
            return Cow::Borrowed(&self.alone_in_group[m][usize::from(sign < 0.0)][row]);
        }
        let of = |&(m, sign): &(usize, f64)| self.places[m][row].iter().map(move |term| turned(term, sign));
        Cow::Owned(summed(members.iter().flat_map(of).collect()).0)
    }

    /// How often the groups need each node.
    pub fn uses<'a>(&self, groups: impl Iterator<Item = &'a [usize]>) -> Vec<usize> {
        let mut uses = vec![0; self.nodes.len()];
        groups.flatten().flat_map(|&f| &self.needs[f]).for_each(|&node| uses[node] += 1);
        uses
    }

    /// What a model of cost `now` whose groups need nodes as `uses` says costs with the functions `new` in place of `old`
    /// in one of its groups, neither of them empty, both ascending: rates and sums stay as they are.
    pub fn exchanged(&self, now: usize, uses: &[usize], old: &[usize], new: &[usize]) -> usize {
        let gone = || old.iter().copied().filter(|f| new.binary_search(f).is_err());
        let come = || new.iter().copied().filter(|f| old.binary_search(f).is_err());
        let terms = |f: usize| 2 - usize::from(self.constant[f]);
        let needs = |f: usize, node: usize| self.needs[f].binary_search(&node).is_ok();
        // Each node where it is first needed.
        let first = |some: &mut dyn Iterator<Item = usize>, f: usize, node: usize| {
            some.take_while(|&other| other != f).all(|other| !needs(other, node))
        };
        let mut cost = now + come().map(terms).sum::<usize>();
        for f in come() {
            let added = |&&node: &&usize| uses[node] == 0 && first(&mut come(), f, node);
            cost += self.needs[f].iter().filter(added).map(|&node| self.nodes[node]).sum::<usize>();
        }
        for f in gone() {
            let times = |node: usize| gone().filter(|&other| needs(other, node)).count();
            let lost = |&&node: &&usize| {
                uses[node] == times(node)
                    && first(&mut gone(), f, node)
                    && !come().any(|other| needs(other, node))
            };
            cost -= self.needs[f].iter().filter(lost).map(|&node| self.nodes[node]).sum::<usize>();
        }
        cost - gone().map(terms).sum::<usize>()
    }

    /// What it takes to have the rates in absolute angles, and the joints' torques from those of the rows.
    fn relative(&self, rates: impl Iterator<Item = Rate>, in_row: &[usize]) -> usize {
        let mut used = [[false; MAX_JOINTS]; 2];
        for rate in rates {
            match rate {
                Rate::One => {}
                Rate::Acceleration(j) => used[0][j] = true,
                Rate::Velocities(j, k) => {
                    used[1][j] = true;
                    used[1][k] = true;
                }
            }
        }
        let mut cost = 0;
        // From the last joint on: θ̇_j needs θ̇_{j−1}.
        for j in (1..self.dof).rev().filter(|&j| self.onto[j] != 0) {
            for (kind, each) in [1, 2].into_iter().enumerate() {
                if used[kind][j] {
                    cost += each;
                    used[kind][j - 1] = true;
                }
            }
        }
        let mut carried = false;
        for i in (0..self.dof).rev() {
            carried &= i + 1 < self.dof && self.onto[i + 1] != 0;
            cost += usize::from(carried && in_row[i] > 0);
            carried |= in_row[i] > 0;
        }
        cost
    }
}

fn turned(&(rate, s): &Term, sign: f64) -> Term {
    (rate, if sign < 0.0 { -s } else { s })
}

/// What is computed once however many candidates need it.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Node {
    Trig(usize),
    Function(Function),
    Product(Vec<usize>),
}

#[derive(Default)]
struct Nodes {
    known: BTreeMap<Node, usize>,
    costs: Vec<usize>,
}

impl Nodes {
    fn node(&mut self, node: Node, cost: usize) -> usize {
        let Self { known, costs } = self;
        *known.entry(node).or_insert_with(|| {
            costs.push(cost);
            costs.len() - 1
        })
    }

    fn candidate(&mut self, lagrangian: &Lagrangian, candidate: &CandidateFunction) -> BTreeSet<usize> {
        let mut out = BTreeSet::new();
        for &l in &candidate.factors {
            self.function(lagrangian.functions[l], &mut out);
        }
        for from in 0..candidate.factors.len().saturating_sub(1) {
            let mut factors = candidate.factors[from..].to_vec();
            if factors.len() == 2 {
                factors.sort_unstable();
            }
            out.insert(self.node(Node::Product(factors), 1));
        }
        out
    }

    /// As [`crate::torque`] builds it: the last joint's multiple is added to the angle of the joints before it.
    fn function(&mut self, psi: Function, out: &mut BTreeSet<usize>) {
        let powers: usize = psi.power.iter().map(|&p| usize::from(p)).sum();
        if powers > 0 {
            let bare = Function { power: [0; MAX_JOINTS], ..psi };
            let turning = usize::from(bare != Function::ONE);
            out.insert(self.node(Node::Function(psi), powers - 1 + turning));
            return self.function(bare, out);
        }
        let Some(last) = psi.kappa.iter().rposition(|&k| k != 0) else { return };
        let mut before = psi.kappa;
        before[last] = 0;
        let turned = psi.kappa[last];
        if before == [0; MAX_JOINTS] {
            out.insert(self.node(Node::Trig(last), TRIG_PAIR));
            if turned.abs() > 1 {
                out.insert(self.node(Node::Function(psi), if psi.sine { 2 } else { 3 }));
            }
            return;
        }
        out.insert(self.node(Node::Function(psi), 3));
        let mut multiple = [0; MAX_JOINTS];
        multiple[last] = turned.abs();
        for kappa in [before, multiple] {
            for sine in [true, false] {
                self.function(Function { kappa, sine, ..psi }, out);
            }
        }
    }
}
