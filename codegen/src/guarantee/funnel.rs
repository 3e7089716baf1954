//! The sets of errors from sample to sample, along the motion and after it.

use super::course::Course;
use super::local::Local;
use super::period::{During, Stop};
use super::problem::{Problem, Wrong};
use super::set::ErrorSet;
use crate::parallel::Parallelize;

/// Periods whose dynamics are enclosed together, by several threads.
const TOGETHER: usize = 64;
/// Periods after which generators are boxed.
const OFTEN: usize = 24;
/// Periods that are looked ahead.
const AHEAD: usize = 128;
/// How much larger than the set a box of displacements is made.
const ROOM: f64 = 3.0;
/// How often a box may be made larger for one period.
const TRIES: usize = 12;

/// The errors while they are followed.
#[derive(Clone, Debug)]
pub(super) struct Funnel<'a> {
    problem: &'a Problem<'a>,
    /// What the emitted step is wrong by from now on.
    pub(super) wrong: Wrong,
    pub(super) set: ErrorSet,
    /// Number of the period that comes next.
    pub(super) index: usize,
    /// Guess of |q̈_e|.
    guess: Vec<f64>,
    ready: Vec<Local>,
}

/// What is known after a period.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Time at the end of the period, s.
    pub(super) time: f64,
    /// Bound on |q_e| at any time of the period.
    pub(super) during: Vec<f64>,
    /// Bounds on |q_e|, then on |q̇_e|, at its end.
    pub(super) hull: Vec<f64>,
    /// Range of the torque that the law asks for at the start of the period.
    pub(super) torque: Vec<[f64; 2]>,
}

/// Where the errors cannot be followed any further.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Lost {
    /// A joint may leave the tube.
    Tube { joint: usize, time: f64 },
    /// D, or the accelerations, are not enclosed.
    Inertia { time: f64 },
}

impl<'a> Funnel<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, wrong: Wrong) -> Self {
        let [position, velocity] = problem.initial;
        Self::from(problem, wrong, ErrorSet::new(position, velocity, problem.numbers.len()), 0)
    }

    /// From the set at the start of period `index`.
    pub(super) fn from(problem: &'a Problem<'a>, wrong: Wrong, set: ErrorSet, index: usize) -> Self {
        Self { problem, wrong, set, index, guess: vec![0.0; problem.arm.dof()], ready: Vec::new() }
    }

    /// The linear map of the errors over the first period of the loop; `None` where D cannot be inverted.
    pub(super) fn frozen(&self) -> Option<Vec<Vec<f64>>> {
        let problem = self.problem;
        let course = Course::new(problem.motion, self.time(self.index), problem.period, problem.slack());
        let half = vec![1e-3; 2 * problem.arm.dof()];
        Some(self.set.frozen(problem, &self.wrong, &Local::new(problem, course, half)?))
    }

    fn time(&self, index: usize) -> f64 {
        index as f64 * self.problem.period
    }

    /// Follows the errors through one more period.
    pub(super) fn step(&mut self) -> Result<Step, Lost> {
        let n = self.problem.arm.dof();
        let before = self.set.hull();
        let mut room: Option<Vec<f64>> = None;
        for _ in 0..TRIES {
            if self.ready.is_empty() || room.is_some() {
                self.enclose(room.as_deref().unwrap_or(&before))?;
            }
            let Some(local) = self.ready.last() else { break };
            let mut set = self.set.clone();
            match set.advance(self.problem, &self.wrong, local, &self.guess) {
                Err(Stop::Beyond(away)) => {
                    if let Some(joint) = (0..n).find(|&i| before[i] > self.problem.tube[i]) {
                        return Err(Lost::Tube { joint, time: self.time(self.index) });
                    }
                    room = Some(away);
                }
                Err(_) => return Err(Lost::Inertia { time: self.time(self.index) }),
                Ok(during) => return self.passed(&before, set, during),
            }
        }
        Err(Lost::Inertia { time: self.time(self.index) })
    }

    /// The largest of the bounds on |q_e|, then |q̇_e|, now and at the ends of the next periods. Nothing may be claimed of these: the
    /// torque error grows with them.
    pub(super) fn ahead(&self) -> Vec<f64> {
        let mut next = self.clone();
        let mut most = self.set.hull();
        for _ in 0..AHEAD {
            let Ok(step) = next.step() else { break };
            most.iter_mut().zip(step.hull).for_each(|(most, x)| *most = most.max(x));
        }
        most
    }

    /// Takes `set` where no joint may have left the tube on the way; otherwise all stays as it was.
    fn passed(&mut self, before: &[f64], mut set: ErrorSet, during: During) -> Result<Step, Lost> {
        let n = self.problem.arm.dof();
        let next = self.index + 1;
        if next.is_multiple_of(OFTEN) {
            set.reduce(self.problem.gains);
        }
        let hull = set.hull();
        let bent = 0.125 * self.problem.period * self.problem.period;
        let most = |i: usize| before[i].max(hull[i]) + bent * during.acceleration[i];
        let most: Vec<f64> = (0..n).map(most).collect();
        if let Some(joint) = (0..n).find(|&i| most[i].is_nan() || most[i] > self.problem.tube[i]) {
            return Err(Lost::Tube { joint, time: self.time(next) });
        }
        if !self.ready.last().is_some_and(|local| local.course.is_still()) {
            self.ready.pop();
        }
        (self.index, self.set, self.guess) = (next, set, during.acceleration);
        Ok(Step { time: self.time(next), during: most, hull, torque: during.torque })
    }

    /// Encloses the dynamics of the periods that come next, for displacements a few times `x`; the last one is the next.
    fn enclose(&mut self, x: &[f64]) -> Result<(), Lost> {
        let (problem, n) = (self.problem, self.problem.arm.dof());
        let first = self.index;
        let courses: Vec<Course> = {
            let made =
                |k: usize| Course::new(problem.motion, self.time(first + k), problem.period, problem.slack());
            let mut courses: Vec<Course> = (0..TOGETHER).map(made).collect();
            if let Some(still) = courses.iter().position(Course::is_still) {
                courses.truncate(still + 1);
            }
            courses
        };
        let largest = x.iter().fold(0.0, |most: f64, x| most.max(*x));
        let locals: Vec<Option<Local>> = courses
            .into_par_iter()
            .map(|course| {
                let t = problem.period;
                let half = (0..2 * n).map(|k| {
                    let range = if k < n { course.span.q[k] } else { course.span.qd[k - n] };
                    let own = ROOM * x[k] + 1e-3 * largest + 1e-12 + 1.1 * (range.high - range.low);
                    let grown = if k < n { t * x[n + k] } else { t * self.guess[k - n] };
                    own + ROOM * grown
                });
                Local::new(problem, course.clone(), half.collect())
            })
            .collect();
        self.ready = locals.into_iter().rev().collect::<Option<Vec<Local>>>().unwrap_or_default();
        if self.ready.is_empty() { Err(Lost::Inertia { time: self.time(first) }) } else { Ok(()) }
    }
}
