//! The whole claim: along the motion, and after it for as long as it holds.

use super::declared::Declared;
use super::funnel::{Funnel, Lost, Step};
use super::problem::Problem;
use super::set::ErrorSet;
use super::settling::settling;
use crate::bounds::{down, six_digits_up};

/// Most periods that are followed one by one.
const MOST: f64 = 4e5;
/// Most periods after the motion in which the errors are to settle.
const LATE: f64 = 10_000.0;
/// How much larger than the set a box is that is to hold for ever.
const ROOM: f64 = 1.05;
/// The same of a box that is to hold after a repetition: the errors come back into it only as fast as they die away.
const ROOMS: [f64; 4] = [1.05, 1.5, 2.5, 6.0];
/// Trials to find such a box, the time before each, s, and most periods that it may take to come back into it.
const TRIALS: usize = 12;
const BETWEEN: f64 = 0.25;
const RETURN: usize = 4000;

/// What is proved of the sampled loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Bound by joint on |q_e| at any time, rad or m.
    pub reach: Vec<f64>,
    /// Time from which the errors count as settled, s.
    pub settle: f64,
    /// Bound by joint on |q_e| from `settle` on; `None` where the claim ends before.
    pub settled_error: Option<Vec<f64>>,
    /// Bound by joint on |q_e| at the end of the motion.
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
    }
    claim.out.end_error = funnel.set.hull()[..n].to_vec();
    if rests {
        claim.rest(&mut funnel);
    } else if let Some(repetition) = repetition {
        let offset = last * problem.period;
        for room in ROOMS {
            if claim.repeat(&funnel, offset, repetition.periods, room) {
                break;
            }
        }
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

    /// After the motion: until a box is found from which the errors come back into it, or until they cannot be followed.
    fn rest(&mut self, funnel: &mut Funnel<'a>) {
        let period = self.problem.period;
        let between = (BETWEEN / period).max(1.0) as usize;
        // What holds for ever holds once the errors have settled, as small as they are then. At the end of the motion they may still
        // grow, and a box around them is larger than they ever get: it is first looked for a while later.
        let settled = libm::ceil(self.out.settle / period).min(funnel.index as f64 + LATE);
        let mut before = (libm::fmax(settled - funnel.index as f64, 0.0) as usize).max(between);
        for _ in 0..TRIALS {
            for _ in 0..before {
                let follows = funnel.step().is_ok_and(|step| self.take(&step, funnel).is_ok());
                if !follows {
                    self.out.valid_until = Some(funnel.index as f64 * period);
                    return;
                }
            }
            if self.returns(funnel) {
                return;
            }
            before = between;
        }
        self.out.valid_until = Some(funnel.index as f64 * period);
    }

    /// Whether some box around the set of `settled` holds the errors again after a number of periods at rest.
    fn returns(&mut self, settled: &Funnel<'a>) -> bool {
        let (mut funnel, around) = self.boxed(settled, ROOM, settled.index);
        let mut declared = self.declared.clone();
        let mut steps = Vec::new();
        for k in 0..RETURN {
            if declared.widen(&mut funnel).is_err() {
                return false;
            }
            let Ok(step) = funnel.step() else { return false };
            steps.push(step);
            if k % 8 == 7 && self.holds(&around, &funnel.set) {
                steps.iter().for_each(|step| self.count_for_ever(step));
                return true;
            }
        }
        false
    }

    /// Whether a box around the set of `settled`, that at the end of a repetition, `offset` s, holds the errors again at the end of the
    /// next.
    fn repeat(&mut self, settled: &Funnel<'a>, offset: f64, periods: usize, room: f64) -> bool {
        let (mut funnel, around) = self.boxed(settled, room, 0);
        let mut declared = self.declared.clone();
        let duration = self.problem.motion.duration();
        self.out.valid_until = Some(offset.min(duration));
        let mut steps = Vec::new();
        for _ in 0..periods {
            if declared.widen(&mut funnel).is_err() {
                return false;
            }
            let Ok(step) = funnel.step() else { return false };
            steps.push(Step { time: step.time + offset, ..step });
        }
        if !self.holds(&around, &funnel.set) {
            return false;
        }
        self.out.valid_until = Some(duration);
        for step in &steps {
            self.count_for_ever(step);
        }
        for (i, end) in self.out.end_error.iter_mut().enumerate() {
            *end = steps.iter().map(|step| step.during[i]).fold(0.0, f64::max);
        }
        true
    }

    /// The errors of all (q_e, s) in a box `room` times as large as that around the set of `funnel`, at the start of period `index`,
    /// and its half sides.
    fn boxed(&self, funnel: &Funnel<'a>, room: f64, index: usize) -> (Funnel<'a>, Vec<f64>) {
        let gains = self.problem.gains;
        let around: Vec<f64> = funnel.set.turned_hull(gains).iter().map(|x| room * x + 1e-13).collect();
        let still = vec![0.0; self.problem.arm.dof()];
        let mut start = ErrorSet::new(&still, &still, self.problem.numbers.len());
        start.add_box(gains, &around);
        (Funnel::from(self.problem, funnel.wrong.clone(), start, index), around)
    }

    /// Whether `set` lies in the box with the half sides `around`.
    fn holds(&self, around: &[f64], set: &ErrorSet) -> bool {
        set.turned_hull(self.problem.gains).iter().zip(around).all(|(x, around)| x <= around)
    }

    fn finished(mut self) -> Sampled {
        let ends = self.out.valid_until;
        if ends.is_none_or(|end| end > self.out.settle) {
            self.out.settled_error = Some(self.settled);
        }
        self.out
    }
}
