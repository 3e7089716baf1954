//! Reports on how far the work is, to be shown while it lasts.
//!
//! The generated code does not depend on them.

use std::fmt::Debug;
use std::sync::{Mutex, PoisonError};

/// Receives reports on the stages of a generation.
///
/// Every stage is reported first with nothing done and last with all done, in between never with less than before. A
/// stage may begin and end inside another. Reports of one stage may come from several threads, one after the other.
pub trait Progress: Debug + Send + Sync {
    /// `done` of the `total` parts of `stage` are done. A stage of one part is reported at its beginning and at its end only.
    fn report(&self, stage: &str, done: usize, total: usize);
}

/// Ignores all reports.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: &str, _done: usize, _total: usize) {}
}

/// Writes a name before every stage, such as the specification's if there are several.
#[derive(Debug)]
pub struct Titled<'a> {
    /// What stands before the stage's name.
    pub title: String,
    /// Where the reports go.
    pub progress: &'a dyn Progress,
}

impl Progress for Titled<'_> {
    fn report(&self, stage: &str, done: usize, total: usize) {
        self.progress.report(&format!("{}: {stage}", self.title), done, total);
    }
}

/// A running stage. When it is dropped, it is reported as done, even if parts of it were left out.
#[derive(Debug)]
pub struct Stage<'a> {
    progress: &'a dyn Progress,
    name: &'static str,
    total: usize,
    done: Mutex<usize>,
}

impl<'a> Stage<'a> {
    /// Begins a stage of `total` parts.
    pub fn new(progress: &'a dyn Progress, name: &'static str, total: usize) -> Self {
        progress.report(name, 0, total);
        Self { progress, name, total, done: Mutex::new(0) }
    }

    /// Begins a part. The part is done when the returned value is dropped.
    pub fn part(&self) -> Part<'_> {
        Part(self)
    }

    fn step(&self) {
        // The lock stays until the report has been made: no other thread's may come before it.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        if *done < self.total {
            *done += 1;
            self.progress.report(self.name, *done, self.total);
        }
    }
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        let done = *self.done.get_mut().unwrap_or_else(PoisonError::into_inner);
        if done < self.total {
            self.progress.report(self.name, self.total, self.total);
        }
    }
}

/// A running part of a stage; it is done when it is dropped.
#[derive(Debug)]
pub struct Part<'a>(&'a Stage<'a>);

impl Drop for Part<'_> {
    fn drop(&mut self) {
        self.0.step();
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use crate::parallel::Parallelize;

    use super::*;
    use crate::Generation;
    use crate::bounds::Effort;
    use crate::load::parse;
    use crate::spec::ModelSpec;

    #[derive(Debug, Default)]
    struct Heard(Mutex<Vec<(String, usize, usize)>>);

    impl Progress for Heard {
        fn report(&self, stage: &str, done: usize, total: usize) {
            self.0.lock().unwrap().push((stage.to_string(), done, total));
        }
    }

    impl Heard {
        fn counts(self) -> Vec<usize> {
            self.0.into_inner().unwrap().into_iter().map(|(_, done, _)| done).collect()
        }
    }

    #[test]
    fn reports_of_many_threads_come_in_order() {
        let heard = Heard::default();
        let stage = Stage::new(&heard, "work", 1000);
        (0..1000).into_par_iter().for_each(|_| drop(stage.part()));
        drop(stage);
        assert_eq!(heard.counts(), (0..=1000).collect::<Vec<_>>());
    }

    #[test]
    fn a_stage_that_is_cut_short_ends_at_its_total() {
        let heard = Heard::default();
        let stage = Stage::new(&heard, "work", 5);
        drop(stage.part());
        drop(stage);
        assert_eq!(heard.counts(), [0, 1, 5]);
    }

    #[test]
    fn no_stage_goes_beyond_its_total() {
        let heard = Heard::default();
        let stage = Stage::new(&heard, "work", 1);
        (0..3).for_each(|_| drop(stage.part()));
        drop(stage);
        drop(Stage::new(&heard, "nothing", 0));
        assert_eq!(heard.counts(), [0, 1, 0]);
    }

    #[test]
    fn every_stage_of_a_generation_ends_at_its_total() {
        let loaded = parse(include_str!("../specs/arm3.json"), Path::new("arm3.json")).unwrap();
        let mut chosen = loaded.clone();
        chosen.spec.model = ModelSpec::Auto;
        for (loaded, expected) in [(loaded, "guarantee"), (chosen, "models within the tolerance")] {
            let heard = Heard::default();
            let silent = Generation::new(loaded.clone()).unwrap().module().unwrap();
            let told = Generation::with_progress(loaded, &Effort::default(), &heard).unwrap();
            assert_eq!(told.module().unwrap(), silent);
            let mut stages: BTreeMap<String, Vec<[usize; 2]>> = BTreeMap::new();
            for (stage, done, total) in heard.0.into_inner().unwrap() {
                stages.entry(stage).or_default().push([done, total]);
            }
            assert!(stages.contains_key("expansion") && stages.contains_key(expected), "{stages:?}");
            for (stage, reports) in stages {
                let total = reports[0][1];
                assert_eq!((reports[0][0], reports[reports.len() - 1]), (0, [total; 2]), "{stage}");
                assert!(reports.is_sorted() && reports.iter().all(|r| r[1] == total), "{stage}: {reports:?}");
            }
        }
    }

    #[test]
    fn a_title_stands_before_the_stage() {
        let heard = Heard::default();
        drop(Stage::new(&Titled { title: "arm".to_string(), progress: &heard }, "work", 1));
        let reports = heard.0.into_inner().unwrap();
        assert_eq!(reports, [("arm: work".to_string(), 0, 1), ("arm: work".to_string(), 1, 1)]);
    }
}
