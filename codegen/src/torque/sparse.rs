//! The torque of a sparse model: products of functions, and rates summed before they meet a coefficient.

use std::collections::BTreeSet;

use super::expanded::signed;
use super::factors::{cofactor, common_factors};
use super::harmonics::Harmonics;
use super::relative::RelativeTo;
use crate::graph::{Builder, Expr, Graph, Variable};
use crate::lagrangian::Lagrangian;
use crate::reduction::{
    CandidateFunction, Group, Rate, Sparse, Term, Turned, columns, grouped, rates, summed,
};

/// τ_i = Σ α_g R_gi over the groups g, where R_gi sums what multiplies the group's coefficients in row i; rows and rates
/// of a model in absolute angles are those of the links.
pub fn sparse(lagrangian: &Lagrangian, model: &Sparse) -> Graph {
    let builder = Builder::new();
    let mut harmonics = Harmonics::new(&builder);
    let factors = common_factors(model);
    let written = model.written_in(lagrangian);
    let plan = Plan::new(written, model);
    let onto = model.absolute.as_ref().map(|absolute| absolute.coordinates.onto.as_slice());
    let motion = RelativeTo { builder: &builder, onto };
    let mut rows: Vec<Vec<Expr>> = vec![Vec::new(); lagrangian.dof];
    for ((group, factor), row_sums) in model.groups.iter().zip(factors).zip(&plan.sums) {
        // A sum of negative terms alone would end in a negation.
        let minus = group.terms.iter().all(|&(_, k)| k < 0.0);
        let first = group.members.first().map_or(String::new(), |&(m, _)| written.coefficients[m].name());
        let first = motion.name(first);
        let name = match first.strip_prefix("minus_") {
            Some(plain) if minus => plain.to_string(),
            None if minus => format!("minus_{first}"),
            _ => first,
        };
        let (mut apart, mut within) = (Vec::new(), Vec::new());
        for &(f, k) in &group.terms {
            let k = builder.constant(if minus { -k } else { k });
            match factor.and_then(|l| cofactor(model, f, l)) {
                Some(other) => within.push(k * harmonics.function(&lagrangian.functions[other])),
                None => apart.push(k * function(&builder, &mut harmonics, lagrangian, &model.functions[f])),
            }
        }
        if let (Some(l), Some(sum)) = (factor, total(within.into_iter())) {
            apart.push(harmonics.function(&lagrangian.functions[l]) * sum);
        }
        let Some(value) = total(apart.into_iter()) else { continue };
        let value = if value.is_constant() { value } else { value.named(&name, true) };
        for (row, sum) in rows.iter_mut().zip(row_sums) {
            let Some((terms, sign)) = sum else { continue };
            row.push(signed(minus != (*sign < 0), value * plan.rate(&motion, terms)));
        }
    }
    let outputs: Vec<_> = motion
        .torque(rows)
        .into_iter()
        .enumerate()
        .map(|(i, torque)| torque.named(&format!("tau{}", i + 1), true).id())
        .collect();
    builder.finish(&outputs).factored()
}

/// Which rates each group meets in each row, and which sums are built by columns.
struct Plan {
    sums: Vec<Vec<Option<Turned>>>,
    by_columns: BTreeSet<Vec<Term>>,
}

impl Plan {
    fn new(written: &Lagrangian, model: &Sparse) -> Self {
        let sums: Vec<Vec<_>> = model.groups.iter().map(|group| row_sums(written, group)).collect();
        let all = || sums.iter().flatten().flatten().map(|(terms, _)| terms);
        let single = all().filter(|terms| terms.len() == 1).map(|terms| terms[0].0).collect();
        let several = all().filter(|terms| terms.len() > 1).cloned().collect();
        Self { by_columns: grouped(&several, single).1, sums }
    }

    fn rate<'g>(&self, motion: &RelativeTo<'g, '_>, terms: &[Term]) -> Expr<'g> {
        let builder = motion.builder;
        if self.by_columns.contains(terms) {
            return columns(terms).map_or(builder.constant(0.0), |columns| {
                let mut products = columns.into_iter().map(|(column, ends)| {
                    let own = (0..).zip(column).filter(|(_, sign)| *sign != 0);
                    total(own.map(|(j, sign)| signed(sign < 0, motion.of(Variable::Qd, j))))
                        .zip(total(ends.iter().map(|&(k, s)| signed(s < 0, motion.of(Variable::Vr, k)))))
                        .map_or(builder.constant(0.0), |(a, b)| a * b)
                });
                total(&mut products).unwrap_or(builder.constant(0.0))
            });
        }
        let one = |&(rate, sign): &Term| {
            let value = match rate {
                Rate::One => builder.constant(1.0),
                Rate::Acceleration(j) => motion.of(Variable::Ar, j),
                Rate::Velocities(j, k) => motion.velocity_product(j, k),
            };
            signed(sign < 0, value)
        };
        total(terms.iter().map(one)).unwrap_or(builder.constant(0.0))
    }
}

fn total<'g>(terms: impl Iterator<Item = Expr<'g>>) -> Option<Expr<'g>> {
    terms.reduce(|sum, term| sum + term)
}

fn row_sums(lagrangian: &Lagrangian, group: &Group) -> Vec<Option<Turned>> {
    let mut rows = vec![Vec::new(); lagrangian.dof];
    for &(m, sign) in &group.members {
        for (row, own) in rows.iter_mut().zip(rates(lagrangian, m)) {
            row.extend(own.into_iter().map(|(rate, s)| (rate, if sign < 0.0 { -s } else { s })));
        }
    }
    rows.into_iter().map(|terms: Vec<Term>| (!terms.is_empty()).then(|| summed(terms))).collect()
}

/// A function on a line of its own; of three factors the last two are multiplied first.
fn function<'g>(
    builder: &'g Builder,
    harmonics: &mut Harmonics<'g>,
    lagrangian: &Lagrangian,
    candidate: &CandidateFunction,
) -> Expr<'g> {
    let mut value: Option<(Expr<'g>, String)> = None;
    for &l in candidate.factors.iter().rev() {
        let psi = &lagrangian.functions[l];
        let factor = harmonics.function(psi);
        value = Some(match value {
            None => (factor, psi.identifier()),
            Some((product, name)) => {
                let name = format!("{}_x_{name}", psi.identifier());
                ((factor * product).named(&name, true), name)
            }
        });
    }
    value.map_or(builder.constant(1.0), |(value, _)| value)
}
