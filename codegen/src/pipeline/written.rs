//! What is written of a generation: the module, the C interface, and the figures in the module's header.

use super::Generation;
use super::judged::switching_gain;
use crate::control::StepGraph;
use crate::emit::{CFile, Facts, Module, c_interface, emit, functions};
use crate::error::Error;
use crate::graph::Operations;
use crate::load::spec_hash;
use crate::spec::LawCodeSpec;

impl Generation {
    /// The text of the generated module.
    ///
    /// # Errors
    /// [`Error::Input`] where a named file has become unreadable, [`Error::Internal`] for defects.
    pub fn module(&self) -> Result<String, Error> {
        self.with_module(emit)
    }

    /// The files of the C interface; none without `emit.c_api`.
    ///
    /// # Errors
    /// As [`Generation::module`].
    pub fn c_files(&self) -> Result<Vec<CFile>, Error> {
        if self.spec().emit.c_api { self.with_module(c_interface) } else { Ok(Vec::new()) }
    }

    fn with_module<T>(&self, write: impl FnOnce(&Module) -> Result<T, Error>) -> Result<T, Error> {
        self.written(write).map_err(|error| error.pointing_into_files(&self.checked().loaded))
    }

    fn written<T>(&self, write: impl FnOnce(&Module) -> Result<T, Error>) -> Result<T, Error> {
        write(&Module {
            file: self.path(),
            name: &self.spec().name,
            hash: &spec_hash(&self.checked().loaded)?,
            arm: self.arm(),
            turned: self.arm() != self.given(),
            uncertainty: self.uncertainty(),
            lagrangian: self.lagrangian(),
            model: self.model(),
            bounds: self.bounds(),
            torque: self.torque(),
            met: self.met(),
            verdict: &self.verdict(),
            domain: self.domain(),
            regressor: self.regressor(),
            exact_code: self.exact_code(),
            motion: self.motion(),
            design: self.design(),
            statement: self.statement(),
            step: self.step().filter(|_| self.spec().emit.law == LawCodeSpec::Inline),
            rounding: self.rounding(),
            facts: &self.facts(),
            check_reference: self.spec().emit.check_reference,
            scalar: self.spec().emit.scalar,
        })
    }

    /// What the module says of itself for programs.
    fn facts(&self) -> Facts {
        let kept = functions(self.lagrangian(), self.reduced());
        let [operations, exact] = self.compared_operations();
        Facts {
            form: self.form().name().to_string(),
            psi: kept.into_iter().zip(self.shares().iter().copied()).collect(),
            operations: operations.unwrap_or_default(),
            exact_operations: exact,
            torque_error: self.torque().map(|torque| torque.error.clone()),
            switching_gain: self.switching_gain(),
            guarantee: self.statement().map(|statement| statement.kind.name().to_string()),
        }
    }

    /// The switching gain by joint, N·m or N: the constant one, or a bound on the law's own while the errors stay in their
    /// envelope. `None` without a controller, for a law that does not switch or that learns, or where no level of V holds the
    /// errors.
    pub fn switching_gain(&self) -> Option<Vec<f64>> {
        switching_gain(&self.designed.certified, self.design()?)
    }

    /// Operations as the verdict compares them: of the step, or of the passivity torque without a controller, and of the same with
    /// the exact model, which is `None` for a law that learns.
    pub fn compared_operations(&self) -> [Option<Operations>; 2] {
        match self.design() {
            Some(_) => [self.step(), self.exact_step()].map(|step| step.map(StepGraph::operations)),
            None => [self.code(), self.exact_code()].map(|code| Some(code.operations())),
        }
    }

    /// How much of the model stands on each kept function, in their order: see [`crate::reduction::shares`].
    pub fn shares(&self) -> &[f64] {
        &self.proved().shares
    }
}
