//! ψ functions from one sine and cosine a joint, by products.

use std::collections::BTreeMap;

use crate::graph::{Builder, Expr, Variable};
use crate::lagrangian::{Function, MAX_JOINTS, WHOLE};

type Kappa = [i8; MAX_JOINTS];

/// Builds ψ functions, each sum of angles once.
pub(super) struct Harmonics<'g> {
    builder: &'g Builder,
    part: [u8; MAX_JOINTS],
    known: BTreeMap<Kappa, (Expr<'g>, Expr<'g>)>,
}

impl<'g> Harmonics<'g> {
    /// Of whole angles, until a function of others is asked for.
    pub(super) fn new(builder: &'g Builder) -> Self {
        Self { builder, part: WHOLE, known: BTreeMap::new() }
    }

    /// Of parts of angles.
    pub(super) fn of_parts(builder: &'g Builder, part: [u8; MAX_JOINTS]) -> Self {
        builder.divide(part);
        Self { part, ..Self::new(builder) }
    }

    /// ψ as a node with a line of its own, named after the function.
    pub(super) fn function(&mut self, psi: &Function) -> Expr<'g> {
        if self.part != psi.part {
            self.part = psi.part;
            self.builder.divide(psi.part);
        }
        let mut value = self.builder.constant(1.0);
        for (j, &power) in psi.power.iter().enumerate() {
            for _ in 0..power {
                value = value * self.builder.input(Variable::Q(j));
            }
        }
        if psi.kappa != [0; MAX_JOINTS] {
            let (sin, cos) = self.sin_cos(psi.kappa);
            value = value * if psi.sine { sin } else { cos };
        }
        value.named(&psi.identifier(), true)
    }

    /// (sin κ·q, cos κ·q): the last joint's multiple is added to the angle of the joints before it.
    fn sin_cos(&mut self, kappa: Kappa) -> (Expr<'g>, Expr<'g>) {
        if let Some(&pair) = self.known.get(&kappa) {
            return pair;
        }
        let last = kappa.iter().rposition(|&k| k != 0);
        let pair = match last {
            None => (self.builder.constant(0.0), self.builder.constant(1.0)),
            Some(j) => {
                let mut before = kappa;
                before[j] = 0;
                let turned = self.multiple(j, kappa[j]);
                if before == [0; MAX_JOINTS] { turned } else { sum(self.sin_cos(before), turned) }
            }
        };
        let part = self.part;
        let named = |sine, value: Expr<'g>| {
            value.named(&Function { kappa, sine, part, ..Function::ONE }.identifier(), true)
        };
        let pair = if last.is_some() && kappa.iter().find(|&&k| k != 0).is_some_and(|&k| k > 0) {
            (named(true, pair.0), named(false, pair.1))
        } else {
            pair
        };
        self.known.insert(kappa, pair);
        pair
    }

    /// (sin k q_j, cos k q_j), or of that multiple of a part of q_j.
    pub(super) fn multiple(&mut self, j: usize, k: i8) -> (Expr<'g>, Expr<'g>) {
        if k < 0 {
            let (sin, cos) = self.multiple(j, -k);
            return (-sin, cos);
        }
        let single = self.builder.sin_cos(j);
        if k <= 1 {
            return single;
        }
        let mut kappa = [0; MAX_JOINTS];
        kappa[j] = k;
        if let Some(&pair) = self.known.get(&kappa) {
            return pair;
        }
        let (sin, cos) = single;
        let pair = if k == 2 {
            // A line of its own whether or not the cosine is needed too.
            let twice = (sin + sin).named(&format!("twice_sin_q{}", j + 1), true);
            (twice * cos, self.builder.constant(1.0) - twice * sin)
        } else {
            sum(self.multiple(j, k - 1), single)
        };
        let part = self.part;
        let named = |sine, value: Expr<'g>| {
            value.named(&Function { kappa, sine, part, ..Function::ONE }.identifier(), true)
        };
        let pair = (named(true, pair.0), named(false, pair.1));
        self.known.insert(kappa, pair);
        pair
    }
}

/// Sine and cosine of a + b.
pub(super) fn sum<'g>(a: (Expr<'g>, Expr<'g>), b: (Expr<'g>, Expr<'g>)) -> (Expr<'g>, Expr<'g>) {
    (a.0 * b.1 + a.1 * b.0, a.1 * b.1 - a.0 * b.0)
}
