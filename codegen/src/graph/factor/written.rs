//! The system as a graph again.

use super::super::{Builder, Expr, Graph, Node};
use super::terms::{Atom, Term};
use super::{Meaning, System};

impl System {
    pub(super) fn graph(&self) -> Graph {
        let builder = Builder::new();
        builder.divide(self.parts);
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
