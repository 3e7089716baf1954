//! Runs a plan, several sizes at a time, and tells of each row when it and those before it are there.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use super::{Entry, Plan, run};
use crate::error::{Error, problems};
use crate::progress::{Progress, Silent, Stage};

/// Runs the tasks `rows` of `plan`, `jobs` at a time, and calls `tell` with every row in the order of `rows`, as soon as it and
/// those before it are there.
///
/// # Errors
/// [`Error::Internal`] for defects, and what `tell` returns: nothing more is begun then. A size that is refused is a row.
pub fn sweep(
    plan: &Plan,
    rows: &[usize],
    jobs: usize,
    progress: &dyn Progress,
    tell: &mut (dyn FnMut(&Entry) -> Result<(), Error> + Send),
) -> Result<(), Error> {
    let stage = Stage::new(progress, "sizes", rows.len());
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let teller = Mutex::new(Teller { next: 0, waiting: BTreeMap::new(), outcome: Ok(()), tell });
    let work = || {
        while !stopped.load(Ordering::Relaxed) {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(&index) = rows.get(place) else { break };
            let entry = entry(plan, index);
            let mut teller = teller.lock().unwrap_or_else(PoisonError::into_inner);
            teller.take(place, entry);
            stopped.fetch_or(teller.outcome.is_err(), Ordering::Relaxed);
            drop(teller);
            drop(stage.part());
        }
    };
    thread::scope(|scope| {
        for _ in 1..jobs.clamp(1, rows.len().max(1)) {
            scope.spawn(work);
        }
        work();
    });
    teller.into_inner().unwrap_or_else(PoisonError::into_inner).outcome
}

/// Hands rows on in their order.
struct Teller<'a> {
    next: usize,
    waiting: BTreeMap<usize, Result<Entry, Error>>,
    outcome: Result<(), Error>,
    tell: &'a mut (dyn FnMut(&Entry) -> Result<(), Error> + Send),
}

impl Teller<'_> {
    fn take(&mut self, place: usize, entry: Result<Entry, Error>) {
        self.waiting.insert(place, entry);
        while let (Some(entry), true) = (self.waiting.remove(&self.next), self.outcome.is_ok()) {
            self.next += 1;
            self.outcome = entry.and_then(|entry| (self.tell)(&entry));
        }
    }
}

fn entry(plan: &Plan, index: usize) -> Result<Entry, Error> {
    let Some((loaded, size)) = plan.tasks.get(index) else {
        return Err(Error::Internal(format!("there is no row {index}")));
    };
    let (row, refused) = match run(loaded, size, plan.guarantee, &Silent) {
        Ok((row, _)) => (Some(row), None),
        Err(Error::Input(faults)) => (None, Some(problems(&faults))),
        Err(defect) => return Err(defect),
    };
    Ok(Entry { index, spec: loaded.spec.name.clone(), size: size.label(), refused, row })
}
