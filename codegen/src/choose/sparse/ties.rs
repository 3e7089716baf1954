//! Equal parameters where they are nearly equal: products with them are computed once.

use std::sync::Arc;

use super::fitting::{Form, Table};

/// How much two parameters may differ to be tied, relatively.
const NEAR: f64 = 0.1;

/// Ties parameters of the same function in different forms as long as no error exceeds `most`.
pub(super) fn tied(table: &Table, forms: &[Arc<Form>], errors: &[Vec<f64>], most: f64) -> Vec<Arc<Form>> {
    let mut forms = forms.to_vec();
    let mut errors = errors.to_vec();
    for a in 0..forms.len() {
        for b in 0..forms.len() {
            if a == b {
                continue;
            }
            for place in 0..forms[b].kept.len() {
                let f = forms[b].kept[place];
                let Some(other) = forms[a].kept.iter().position(|&kept| kept == f) else { continue };
                let (k, own) = (forms[a].parameters[other], forms[b].parameters[place]);
                let wanted = k.abs() * own.signum();
                if wanted == own || (wanted - own).abs() > NEAR * own.abs() {
                    continue;
                }
                // What is tied already stays so.
                let elsewhere = |form: &Form| {
                    form.kept.iter().zip(&form.parameters).any(|(&g, k)| g == f && k.abs() == own.abs())
                };
                if forms.iter().enumerate().any(|(c, form)| c != b && elsewhere(form)) {
                    continue;
                }
                let mut parameters = forms[b].parameters.clone();
                parameters[place] = wanted;
                let new = Form::with(table, forms[b].members.clone(), forms[b].kept.clone(), parameters);
                let after = exchanged(table, &errors, &[&forms[b]], &new);
                if after.iter().flatten().all(|&e| e <= most) {
                    errors = after;
                    forms[b] = Arc::new(new);
                }
            }
        }
    }
    forms
}

/// The errors by joint and point when `new` takes the place of `old`; the members of `new` are those of `old` in order.
pub(super) fn exchanged(table: &Table, errors: &[Vec<f64>], old: &[&Form], new: &Form) -> Vec<Vec<f64>> {
    let mut out = errors.to_vec();
    let before = old.iter().flat_map(|form| &form.residuals);
    for ((&(m, _), before), after) in new.members.iter().zip(before).zip(&new.residuals) {
        for &(i, share) in &table.shares[m] {
            for ((e, r), s) in out[i].iter_mut().zip(after).zip(before) {
                *e += share * (r.abs() - s.abs());
            }
        }
    }
    out
}
