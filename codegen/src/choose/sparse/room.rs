//! The torque errors of a model, and the room that they leave below a level for an exchange.

use std::sync::Arc;

use super::descent::Descent;
use super::exchange::Exchange;
use super::fitting::{Form, Table};

/// Exchanges whose error is above the step's by no more than this factor are fitted again to the room that the other
/// coefficients leave.
const NEARLY: f64 = 1.6;
/// Longer forms are not.
const REFITTED: usize = 6;
/// The room of a point is at least this part of the level, so that one point does not decide alone.
const LEAST_ROOM: f64 = 0.02;

impl Descent<'_> {
    /// The form of the exchange, or its functions fitted again, where that keeps all errors within `level`.
    pub(super) fn admitted(&self, exchange: &Exchange, level: f64) -> Option<Arc<Form>> {
        let old = self.forms_of(&exchange.slots);
        let form = &exchange.form;
        let refits = old.len() == 1 && form.members.len() == 1 && (1..=REFITTED).contains(&form.kept.len());
        let most = if refits { NEARLY * level } else { level };
        let reached = self.largest_with(&old, form, most)?;
        if reached <= level { Some(form.clone()) } else { self.refitted(&old, form, level).map(Arc::new) }
    }

    /// As [`Self::fitted_to_room`], where that keeps all errors within `level`.
    fn refitted(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let inverse = self.inverse_room(old, form, level)?;
        let new = Form::within(self.table, form.members.clone(), form.kept.clone(), &inverse)?;
        self.largest_with(old, &new, level).map(|_| new)
    }

    /// The form with the parameters that keep it furthest within what the others leave of `level`.
    pub(super) fn fitted_to_room(&self, old: &[&Form], form: &Form, level: f64) -> Option<Form> {
        let inverse = self.inverse_room(old, form, level)?;
        Some(Form::fitted(self.table, form.members.clone(), form.kept.clone(), Some(&inverse)))
    }

    /// By point what the others leave of `level`, inverted; `None` for forms that are not fitted to it.
    fn inverse_room(&self, old: &[&Form], form: &Form, level: f64) -> Option<Vec<f64>> {
        let ([before], [(m, _)]) = (old, form.members.as_slice()) else { return None };
        if form.kept.is_empty() || form.kept.len() > REFITTED {
            return None;
        }
        let residual = before.residuals.first()?;
        let room = |point: usize| {
            let left =
                |&(i, share): &(usize, f64)| (level - self.errors[i][point]) / share + residual[point].abs();
            self.table.shares[*m].iter().map(left).fold(f64::INFINITY, f64::min)
        };
        let floor = LEAST_ROOM * level / self.table.weights[*m];
        Some((0..residual.len()).map(|point| 1.0 / room(point).max(floor)).collect())
    }

    /// The largest error with `new` in the place of `old`, where that is no more than `most`.
    fn largest_with(&self, old: &[&Form], new: &Form, most: f64) -> Option<f64> {
        let residuals: Vec<&Vec<f64>> = old.iter().flat_map(|form| &form.residuals).collect();
        let mut largest = 0.0_f64;
        let mut changed = vec![0.0; self.table.points()];
        for (i, errors) in self.errors.iter().enumerate() {
            let parts: Vec<(f64, &[f64], &[f64])> = new
                .members
                .iter()
                .enumerate()
                .filter_map(|(place, &(m, _))| {
                    let share = self.table.shares[m].iter().find(|share| share.0 == i)?.1;
                    Some((share, new.residuals[place].as_slice(), residuals[place].as_slice()))
                })
                .collect();
            if parts.is_empty() {
                continue;
            }
            let change = |point: usize| -> f64 {
                parts.iter().map(|(u, r, s)| u * (r[point].abs() - s[point].abs())).sum()
            };
            // Where the new form leaves most, errors are likely to be too large.
            if new.worst.iter().any(|&point| errors[point] + change(point) > most) {
                return None;
            }
            match parts.as_slice() {
                [(u, r, s)] => {
                    for (((out, e), r), s) in changed.iter_mut().zip(errors).zip(*r).zip(*s) {
                        *out = e + u * (r.abs() - s.abs());
                    }
                }
                _ => changed
                    .iter_mut()
                    .zip(errors)
                    .enumerate()
                    .for_each(|(point, (out, e))| *out = e + change(point)),
            }
            largest = largest_of(&changed, largest);
            if largest > most {
                return None;
            }
        }
        Some(largest)
    }
}

/// By joint and point.
pub(super) fn errors(dof: usize, table: &Table, forms: &[Arc<Form>]) -> Vec<Vec<f64>> {
    let mut out = vec![vec![0.0; table.points()]; dof];
    for form in forms {
        for (&(m, _), residual) in form.members.iter().zip(&form.residuals) {
            for &(i, share) in &table.shares[m] {
                out[i].iter_mut().zip(residual).for_each(|(e, r)| *e += share * r.abs());
            }
        }
    }
    out
}

pub(super) fn largest(errors: &[Vec<f64>]) -> f64 {
    errors.iter().fold(0.0, |most, row| largest_of(row, most))
}

/// The largest of `values` and `least`; comparisons side by side do not wait for one another.
fn largest_of(values: &[f64], least: f64) -> f64 {
    let mut most = [least; 8];
    let (eights, rest) = values.as_chunks::<8>();
    for eight in eights {
        for (most, x) in most.iter_mut().zip(eight) {
            *most = if x > most { *x } else { *most };
        }
    }
    most.iter().chain(rest).fold(least, |most, &x| most.max(x))
}
