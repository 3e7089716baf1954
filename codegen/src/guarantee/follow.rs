//! The whole claim: along the motion, and after it for as long as it holds.

mod after;

use super::declared::Declared;
use super::funnel::{Funnel, Lost, Step};
use super::problem::Problem;
use super::settling::settling;
use crate::bounds::{down, six_digits_up};

/// Part of the time by which a sample may be off the end of the motion and still be at it: rounding.
const SAME: f64 = 1e-12;
/// Most periods that are followed one by one.
const MOST: f64 = 4e5;

/// What is proved of the sampled loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Bound by joint on |q_e| at any time, rad or m.
    pub reach: Vec<f64>,
    /// Time from which the errors count as settled, s.
    pub settle: f64,
    /// Bound by joint on |q_e| from `settle` on; `None` where the claim ends before.
    pub settled_error: Option<Vec<f64>>,
    /// Bound by joint on |q_e| at the end of the motion, also where that is between two samples; where the motion does not rest at its
    /// end, at `valid_until`, and at any time of its repetitions.
    pub end_error: Vec<f64>,
    /// Bound by joint on |q̇_e| at the samples, rad/s or m/s.
    pub speed_error: Vec<f64>,
    /// Time until which all that holds, s; `None` for ever.
    pub valid_until: Option<f64>,
    /// Range of the torque that the law asks for, by joint, N·m or N.
    pub torque: Vec<[f64; 2]>,
    /// What the emitted step is allowed to be wrong by, rounding included, at least, from each time on, s, by joint, N·m or N: its torque
    /// less that of the law about the arm as specified.
    pub torque_error: Vec<(f64, Vec<f64>)>,
    /// When the torque comes nearest to its limits, by joint, s.
    pub torque_time: Vec<f64>,
    /// Bound by joint on |q_e| during each period that was followed, with its end, s.
    pub course: Vec<(f64, Vec<f64>)>,
}

impl Sampled {
    /// Least and largest torque that the law asks for, by joint, N·m or N, rounded outwards.
    pub fn torque_range(&self) -> [Vec<f64>; 2] {
        let outwards = |x: f64| if x >= 0.0 { six_digits_up(x) } else { -down(-x, 6) };
        let high = self.torque.iter().map(|range| outwards(range[1])).collect();
        [self.torque.iter().map(|range| -outwards(-range[0])).collect(), high]
    }
}

/// Why nothing is proved.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Open {
    Lost(Lost),
    /// The errors go beyond all that the step's own error was bounded for: of position, then of speed.
    Growing(Vec<f64>),
    /// The motion takes this many periods.
    Long(f64),
    /// The motion ends before the first period does, and nothing is known of the time after it.
    Short,
}

/// The claim while it grows.
struct Claim<'a> {
    problem: &'a Problem<'a>,
    declared: Declared<'a>,
    out: Sampled,
    settled: Vec<f64>,
}

/// Follows the loop of `problem`, whose step is wrong by what `declared` says.
pub(super) fn follow(problem: &Problem, declared: Declared, settle: Option<f64>) -> Result<Sampled, Open> {
    let n = problem.arm.dof();
    let motion = problem.motion;
    let periods = motion.duration() / problem.period;
    let repetition = problem.repetition.as_ref();
    let (whole, rests) = (libm::ceil(periods - 1e-9).max(1.0), motion.rests());
    // A motion that does not rest at its end is claimed for as long as it was planned.
    let last = if rests { whole } else { libm::floor(periods + 1e-9) };
    let mut funnel = Funnel::new(problem, declared.wrong());
    let settle = settle.unwrap_or_else(|| settling(problem, &funnel));
    // Whole repetitions until the errors have settled: what is closed then holds errors as small as they are.
    let last = repetition.map_or(last, |repetition| {
        let own = repetition.periods as f64;
        let settled = libm::ceil(settle / (own * problem.period)).max(1.0);
        if settled * own <= last { settled * own } else { own * libm::floor(last / own) }
    });
    if last > MOST {
        return Err(Open::Long(last));
    }
    if last < 1.0 {
        return Err(Open::Short);
    }
    let mut claim = Claim::new(problem, declared, settle, n);
    claim.start(&mut funnel)?;
    while (funnel.index as f64) < last {
        let step = funnel.step().map_err(Open::Lost)?;
        claim.take(&step, &mut funnel)?;
        claim.out.end_error = step.during;
    }
    if !rests || (whole - periods).abs() <= SAME * whole {
        claim.out.end_error = funnel.set.hull()[..n].to_vec();
    }
    if rests {
        claim.rest(&mut funnel);
    } else if let Some(repetition) = repetition {
        claim.again_and_again(&funnel, last * problem.period, repetition.periods);
    } else {
        claim.out.valid_until = Some(last * problem.period);
    }
    Ok(claim.finished())
}

impl<'a> Claim<'a> {
    fn new(problem: &'a Problem<'a>, declared: Declared<'a>, settle: f64, n: usize) -> Self {
        let out = Sampled {
            reach: vec![0.0; n],
            settle,
            settled_error: None,
            end_error: vec![0.0; n],
            speed_error: vec![0.0; n],
            valid_until: None,
            torque: vec![[f64::INFINITY, f64::NEG_INFINITY]; n],
            torque_error: Vec::new(),
            torque_time: vec![0.0; n],
            course: Vec::new(),
        };
        Self { problem, declared, out, settled: vec![0.0; n] }
    }

    /// The set at the start.
    fn start(&mut self, funnel: &mut Funnel) -> Result<(), Open> {
        let n = self.problem.arm.dof();
        self.out.course.push((0.0, funnel.set.hull()[..n].to_vec()));
        self.admit(funnel)
    }

    /// Makes what the next step is wrong by hold for the set.
    fn admit(&mut self, funnel: &mut Funnel) -> Result<(), Open> {
        self.declared.widen(funnel).map_err(Open::Growing)?;
        if self.out.torque_error.last().is_none_or(|(_, last)| *last != funnel.wrong.torque) {
            let time = funnel.index as f64 * self.problem.period;
            self.out.torque_error.push((time, funnel.wrong.torque.clone()));
        }
        Ok(())
    }

    /// Takes the period that `funnel` has just followed.
    fn take(&mut self, step: &Step, funnel: &mut Funnel) -> Result<(), Open> {
        self.count(step);
        self.out.course.push((step.time, step.during.clone()));
        self.admit(funnel)
    }

    fn count(&mut self, step: &Step) {
        let settled = step.time > self.out.settle;
        let n = step.during.len();
        for i in 0..n {
            self.out.reach[i] = self.out.reach[i].max(step.during[i]);
            self.out.speed_error[i] = self.out.speed_error[i].max(step.hull[n + i]);
            if settled {
                self.settled[i] = self.settled[i].max(step.during[i]);
            }
            let range = &mut self.out.torque[i];
            let [low, high] = step.torque[i];
            if high.max(-low) > range[1].max(-range[0]) || range[1] < range[0] {
                self.out.torque_time[i] = step.time - self.problem.period;
            }
            *range = [range[0].min(low), range[1].max(high)];
        }
    }

    /// What comes again and again has settled whenever it is looked at.
    fn count_for_ever(&mut self, step: &Step) {
        self.count(step);
        for (settled, during) in self.settled.iter_mut().zip(&step.during) {
            *settled = settled.max(*during);
        }
    }

    fn finished(mut self) -> Sampled {
        let ends = self.out.valid_until;
        if ends.is_none_or(|end| end > self.out.settle) {
            self.out.settled_error = Some(self.settled);
        }
        self.out
    }
}
