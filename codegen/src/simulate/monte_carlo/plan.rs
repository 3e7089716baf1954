//! What each run starts from and is pushed by. Run number k is the same whatever the number of runs.

use super::frozen::{FrozenLoop, Sensitivity};
use crate::check::InitialError;
use crate::numerics::low_discrepancy::{LowDiscrepancy, in_box};

/// Instants by which an error that starts with the run may have grown most, s.
const EARLY: [f64; 6] = [0.0, 0.02, 0.05, 0.1, 0.2, 0.4];
/// Attacks of one sign on one joint: those begin at these instants, at settling, at the motion's end and at the run's.
const VARIANTS: usize = EARLY.len() + 3;
/// Kinds of runs after those that attack from the worst corner.
const KINDS: usize = 4;
/// Longest time for which a random push keeps its sign, s.
const LONGEST_BURST: f64 = 0.5;
/// Bursts of one run in the sequence of points: more than there are in any run that is drawn.
const BURSTS: usize = 1 << 20;

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan<const N: usize> {
    /// Initial errors, rad or m, and rad/s or m/s.
    pub position: [f64; N],
    pub velocity: [f64; N],
    /// The uncertain numbers, counted from the arm's own.
    pub parameters: Vec<f64>,
    /// By control period and joint, on which side of zero the model's error is held: 1 or −1.
    pub sides: Vec<[i8; N]>,
}

/// Makes plans.
pub(super) struct Planner<'a, const N: usize> {
    pub frozen: FrozenLoop<N>,
    pub initial: &'a InitialError,
    /// Box of the uncertain numbers.
    pub ranges: Vec<[f64; 2]>,
    pub period: f64,
    /// The instants, in periods, of settling, of the motion's end and of the run's end.
    pub settle: usize,
    pub end: usize,
    pub steps: usize,
}

impl<const N: usize> Planner<'_, N> {
    /// Run number `index`: first those that attack each joint at several instants from the worst corner, one sign after
    /// the other; then by turns attacks from other corners, random pushes, points inside the boxes, and held pushes.
    pub(super) fn plan(&self, index: usize) -> Plan<N> {
        let attacks = VARIANTS * N;
        if index < 2 * attacks {
            let (side, variant, joint) = (index / attacks, index % attacks / N, index % N);
            let side = if side == 0 { 1.0 } else { -1.0 };
            // Half of the attacks choose the arm for their first target, the others for their last.
            let first = variant.is_multiple_of(2) == (side > 0.0);
            let aim = match variant.checked_sub(EARLY.len()) {
                None => self.instant(EARLY[variant]),
                Some(0) => self.settle,
                Some(1) => self.end,
                Some(_) => self.steps,
            };
            return self.attack(joint, side, &self.targets(aim, variant), first);
        }
        let index = index - 2 * attacks;
        let (kind, round) = (index % KINDS, index / KINDS);
        let count = self.ranges.len();
        let point = LowDiscrepancy::new(2 * N + count + N + 1).point(index);
        let (start, rest) = point.split_at(2 * N);
        let (arm, rest) = rest.split_at(count);
        let inside = kind == 2;
        let ends = |unit: &[f64]| -> Vec<f64> {
            unit.iter().map(|&u| if inside { u } else { f64::from(u8::from(u >= 0.5)) }).collect()
        };
        let start = ends(start);
        let around = |largest: &[f64], unit: &[f64]| -> [f64; N] {
            std::array::from_fn(|i| (2.0 * unit[i] - 1.0) * largest[i])
        };
        let sides = match kind {
            0 => {
                let early = rest.last().map_or(0.0, |u| u * EARLY[EARLY.len() - 1]);
                let side = if start[0] >= 0.5 { 1.0 } else { -1.0 };
                self.attack(round % N, side, &self.targets(self.instant(early), round), false).sides
            }
            3 => vec![std::array::from_fn(|i| if rest[i] >= 0.5 { 1 } else { -1 }); self.steps],
            _ => self.bursts(index),
        };
        Plan {
            position: around(&self.initial.position, &start[..N]),
            velocity: around(&self.initial.velocity, &start[N..]),
            parameters: in_box(&self.ranges, &ends(arm)),
            sides,
        }
    }

    /// The first instant, in periods, from `time` on, s; not the very first.
    fn instant(&self, time: f64) -> usize {
        libm::ceil(time / self.period - 1e-9).max(1.0) as usize
    }

    /// Instants, in periods, at which an attack aims: `first`, then from settling on every half of the settling time,
    /// begun later from variant to variant, and the run's end; every other variant aims at the motion's end too.
    fn targets(&self, first: usize, variant: usize) -> Vec<usize> {
        let gap = (self.settle / 2).max(1);
        let begin = self.settle + gap * (variant % EARLY.len()) / EARLY.len();
        let mut out: Vec<usize> = (begin..self.steps.saturating_sub(gap / 4)).step_by(gap).collect();
        if variant.is_multiple_of(2) {
            out.retain(|step| step.abs_diff(self.end) > gap / 2);
            out.push(self.end);
        }
        let first = first.clamp(1, self.steps);
        out.retain(|step| *step > first);
        out.extend([first, self.steps]);
        out.sort_unstable();
        out.dedup();
        out
    }

    /// The initial error, the arm and the pushes that the frozen loop gives for errors of `joint` on the side `side` at
    /// the instants `targets`; the arm is the worst one for the first or the last of them.
    pub(super) fn attack(&self, joint: usize, side: f64, targets: &[usize], first: bool) -> Plan<N> {
        let mut from = 0;
        let windows: Vec<Sensitivity<N>> = targets
            .iter()
            .map(|&until| {
                let window = self.frozen.sensitivity(joint, from, until);
                from = until;
                window
            })
            .collect();
        let main = if first { windows.first() } else { windows.last() };
        let worst = |(range, &of): (&[f64; 2], &f64)| if side * of >= 0.0 { range[1] } else { range[0] };
        let parameters: Vec<f64> = main
            .map(|window| self.ranges.iter().zip(&window.parameters).map(worst).collect())
            .unwrap_or_default();
        let mut sides = Vec::with_capacity(self.steps);
        let mut start = [[0.0; N]; 2];
        for (number, window) in windows.iter().enumerate() {
            // What the arm itself does at that instant is not worked against.
            let own: f64 = window.parameters.iter().zip(&parameters).map(|(of, value)| of * value).sum();
            let side = if own == 0.0 { side } else { own.signum() };
            if number == 0 {
                let largest = [&self.initial.position, &self.initial.velocity];
                let corner = |k: usize, i: usize| largest[k][i].copysign(side * window.initial[k][i]);
                start = std::array::from_fn(|k| std::array::from_fn(|i| corner(k, i)));
            }
            let of = |x: f64| if side * x >= 0.0 { 1 } else { -1 };
            sides.extend(window.torque.iter().map(|torque| torque.map(of)));
        }
        sides.resize(self.steps, sides.last().copied().unwrap_or([1; N]));
        let [position, velocity] = start;
        Plan { position, velocity, parameters, sides }
    }

    /// Sides that change after random times, joint by joint: from one period to [`LONGEST_BURST`], short ones as often
    /// as long ones.
    fn bursts(&self, index: usize) -> Vec<[i8; N]> {
        let spread = LowDiscrepancy::new(2 * N);
        let longest = (LONGEST_BURST / self.period).max(1.0);
        let mut sides = vec![[1; N]; self.steps];
        for joint in 0..N {
            let (mut step, mut number) = (0, 0);
            while step < self.steps {
                let point = spread.point(index * BURSTS + number);
                let (length, side) = (point[2 * joint], point[2 * joint + 1]);
                let length = libm::pow(longest, length).max(1.0) as usize;
                let side = if side >= 0.5 { 1 } else { -1 };
                let until = (step + length).min(self.steps);
                sides[step..until].iter_mut().for_each(|sides| sides[joint] = side);
                (step, number) = (until, number + 1);
            }
        }
        sides
    }
}
