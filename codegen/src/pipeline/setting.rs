//! What every error of a model is judged in: the domain, the sines and the rounded rotations.

use crate::bounds::{Bounds, ModelError, position_bound, rounded_angles};
use crate::check::Checked;
use crate::domain::Domain;
use crate::lagrangian::Lagrangian;
use crate::model::Model;
use crate::trig::Trig;

/// What follows from a checked specification without its model.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    /// How sines are taken.
    pub sines: Trig,
    /// The domain within one turn of each joint, where bounds are sought.
    pub turn: Domain,
    /// Bounds on |q_j| there, rad or m.
    pub position_bound: Vec<f64>,
    /// What rounding the arm's rotations changes at most; `None` where it changes nothing.
    pub angles: Option<Bounds>,
}

impl Setting {
    /// That of `checked`.
    pub fn new(checked: &Checked) -> Self {
        let built = &checked.built;
        let turn = checked.domain.within_a_turn(&built.arm, 1.0);
        let position_bound = position_bound(&turn);
        let family = (&built.arm, &built.uncertainty);
        let angles = rounded_angles(family, (&built.given, &built.uncertain), &position_bound);
        Self { sines: Trig::new(&checked.loaded.spec.emit), turn, position_bound, angles }
    }

    /// What the bounds of `model` follow from.
    pub fn error<'a>(
        &'a self,
        checked: &'a Checked,
        lagrangian: &'a Lagrangian,
        model: &'a Model,
    ) -> ModelError<'a> {
        ModelError {
            loaded: &checked.loaded,
            arm: &checked.built.arm,
            uncertainty: &checked.built.uncertainty,
            lagrangian,
            reduced: &model.reduced,
            domain: &self.turn,
            form: model.form,
            code: &model.code,
            sines: &self.sines,
            angles: self.angles.as_ref(),
        }
    }
}
