//! What holds after the motion: at rest, and from one repetition of a motion to the next.

use super::super::funnel::{Funnel, Step};
use super::super::set::ErrorSet;
use super::Claim;

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
/// Time in which much of what a box is too large by dies away, s.
const FADES: f64 = 0.5;
/// Periods after which errors at rest are compared with what they were, and what counts as no change, relative.
const LOOK: usize = 50;
const STEADY: f64 = 1e-3;

impl<'a> Claim<'a> {
    /// After the motion: until a box is found from which the errors come back into it, or until they cannot be followed.
    pub(super) fn rest(&mut self, funnel: &mut Funnel<'a>) {
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

    /// Whether some box around the set of `funnel` holds the errors again after a number of periods at rest. What they are later is
    /// followed from both: the box for what holds for ever once much of what it is too large by has died away, the set until then.
    fn returns(&mut self, funnel: &mut Funnel<'a>) -> bool {
        let middle = steady(funnel);
        let (mut boxed, around) = self.boxed(funnel, &middle, ROOM, funnel.index);
        let mut declared = self.declared.clone();
        let mut steps = Vec::new();
        let mut until = RETURN;
        let mut again = None;
        while steps.len() < until {
            if declared.widen(&mut boxed).is_err() {
                return false;
            }
            let Ok(step) = boxed.step() else { return false };
            steps.push(step);
            let periods = steps.len();
            if again.is_none() && periods % 8 == 0 && self.holds(&around, &middle, &boxed.set) {
                // The box holds them at the start of each such number of periods: after several of these they are where the box has
                // gone in as many.
                let several = libm::ceil(FADES / (periods as f64 * self.problem.period)) as usize;
                again = Some(several * periods);
                until = (several + 1) * periods;
            }
        }
        let Some(again) = again else { return false };
        for _ in 0..again {
            if !funnel.step().is_ok_and(|step| self.take(&step, funnel).is_ok()) {
                return false;
            }
        }
        steps.iter().skip(again).for_each(|step| self.count_for_ever(step));
        true
    }

    /// After repetitions of a motion that ended at `offset` s: until a box is found to which the errors come back in the next one.
    pub(super) fn again_and_again(&mut self, settled: &Funnel<'a>, offset: f64, periods: usize) {
        for room in ROOMS {
            if self.repeat(settled, offset, periods, room) {
                break;
            }
        }
    }

    /// Whether a box around the set of `settled`, that at the end of a repetition, `offset` s, holds the errors again at the end of the
    /// next.
    fn repeat(&mut self, settled: &Funnel<'a>, offset: f64, periods: usize, room: f64) -> bool {
        let middle = self.nothing();
        let (mut funnel, around) = self.boxed(settled, &middle, room, 0);
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
        if !self.holds(&around, &middle, &funnel.set) {
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

    /// No errors.
    fn nothing(&self) -> ErrorSet {
        let still = vec![0.0; self.problem.arm.dof()];
        ErrorSet::new(&still, &still, self.problem.numbers.len())
    }

    /// The errors of all (q_e, s) around `middle` in a box `room` times as large as that around the set of `funnel`, at the start of
    /// period `index`, and its half sides.
    fn boxed(
        &self,
        funnel: &Funnel<'a>,
        middle: &ErrorSet,
        room: f64,
        index: usize,
    ) -> (Funnel<'a>, Vec<f64>) {
        let gains = self.problem.gains;
        let half = funnel.set.less(middle).turned_hull(gains);
        let around: Vec<f64> = half.iter().map(|x| room * x + 1e-13).collect();
        let mut start = middle.clone();
        start.add_box(gains, &around);
        (Funnel::from(self.problem, funnel.wrong.clone(), start, index), around)
    }

    /// Whether `set` lies in the box with the half sides `around` about `middle`, whatever the uncertain numbers are.
    fn holds(&self, around: &[f64], middle: &ErrorSet, set: &ErrorSet) -> bool {
        set.less(middle).turned_hull(self.problem.gains).iter().zip(around).all(|(x, around)| x <= around)
    }
}

/// Where the uncertain numbers hold the errors at rest, about: an estimate, which only makes the box around it small.
fn steady(settled: &Funnel) -> ErrorSet {
    let mut funnel = settled.clone();
    funnel.set = funnel.set.middle();
    for _ in 0..RETURN / LOOK {
        let before = funnel.set.clone();
        for _ in 0..LOOK {
            if funnel.step().is_err() {
                return settled.set.middle();
            }
            funnel.set = funnel.set.middle();
        }
        let (moved, whole) = (funnel.set.less(&before).hull(), settled.set.hull());
        if moved.iter().zip(whole).all(|(moved, whole)| *moved <= STEADY * whole) {
            break;
        }
    }
    funnel.set
}
