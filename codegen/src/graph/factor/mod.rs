//! Fewer operations for the same values: common factors are taken out of sums, products and partial sums that occur
//! twice are computed once, constants are multiplied beforehand.
//!
//! The graph is taken apart into sums of products, and the change that saves most is made until none saves anything.
//! Values change by rounding alone.

mod change;
mod terms;
mod written;

use super::{Graph, Name, Node, Signs};
use crate::lagrangian::MAX_JOINTS;
use terms::{Atom, Term, atom, costs, is_alias, joined, product};

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
    parts: [u8; MAX_JOINTS],
}

impl Graph {
    /// The same function with fewer operations, products apart from sums, or this graph where nothing can be saved.
    pub fn factored(&self) -> Graph {
        let Some(mut system) = System::new(self) else { return self.clone() };
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
        let pays = out.operations().cost() < self.operations().cost();
        if pays && out.is_finite() { out } else { self.clone() }
    }
}

impl System {
    /// `None` for a graph that is no sum of products.
    fn new(graph: &Graph) -> Option<Self> {
        let uses = graph.uses();
        let mut system = Self { parts: graph.parts, ..Self::default() };
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
                Node::Abs(_) | Node::Clamp(..) | Node::Select(..) => return None,
                Node::Mul(a, b) => {
                    let (a, b) = (system.single(&sums[a]), system.single(&sums[b]));
                    vec![product(&a, &b)]
                }
                Node::MulAdd(signs, a, b, c) => {
                    let (a, b) = (system.single(&sums[a]), system.single(&sums[b]));
                    let product = vec![product(&a, &b)];
                    match signs {
                        Signs::Plus => joined(&product, &sums[c], 1.0),
                        Signs::Minus => joined(&product, &sums[c], -1.0),
                        Signs::From => joined(&sums[c], &product, -1.0),
                    }
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
        Some(system)
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
}
