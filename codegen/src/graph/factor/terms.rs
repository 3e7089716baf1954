//! Sums of products: coefficient · Π factors.

/// A leaf or a named sum, by index.
pub(super) type Atom = usize;

/// coefficient · Π factors; the factors sorted, none for a constant.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term {
    pub coefficient: f64,
    pub factors: Vec<Atom>,
}

/// A term without its sign.
pub(super) type Key = (u64, Vec<Atom>);

pub(super) fn atom(index: Atom) -> Term {
    Term { coefficient: 1.0, factors: vec![index] }
}

/// True for ± one atom, and for a constant.
pub(super) fn is_alias(sum: &[Term]) -> bool {
    match sum {
        [] => true,
        [term] => term.factors.is_empty() || (term.factors.len() == 1 && term.coefficient.abs() == 1.0),
        _ => false,
    }
}

pub(super) fn product(a: &Term, b: &Term) -> Term {
    let mut factors = [a.factors.as_slice(), &b.factors].concat();
    factors.sort_unstable();
    Term { coefficient: a.coefficient * b.coefficient, factors }
}

/// a + sign·b with like terms collected.
pub(super) fn joined(a: &[Term], b: &[Term], sign: f64) -> Vec<Term> {
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
pub(super) fn costs(term: &Term) -> usize {
    (term.factors.len() + usize::from(term.coefficient.abs() != 1.0)).saturating_sub(1)
}

pub(super) fn key(term: &Term) -> Key {
    (term.coefficient.abs().to_bits(), term.factors.clone())
}
