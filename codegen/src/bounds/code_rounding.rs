//! What computing the emitted code in its number type may be off by, over a domain.
//!
//! The domain is halved where the bound is largest, as an interval over all of it forgets that a sine and its cosine belong to
//! one angle. Every state lies in one of the cells that are left, so the largest bound of these is a bound.

use super::Rates;
use super::queue::Queue;
use super::region::{Cell, Frame, Region};
use crate::domain::Domain;
use crate::graph::{Graph, Inputs, Variable};
use crate::numerics::interval::Interval;
use crate::numerics::rounded::Format;

/// Cells that are divided at most.
const DIVIDED: usize = 400;

/// What is known of the states in one cell of a domain.
#[derive(Clone, Debug)]
pub(crate) struct Instant {
    /// q by joint.
    pub q: Vec<Interval>,
    /// q − q_d by joint; of a workspace 0 and without meaning.
    pub error: Vec<Interval>,
    /// q_d and q̇_d by joint, and the largest |q̈_d|; `None` where there is no motion.
    pub desired: Option<[Vec<Interval>; 3]>,
}

/// Bounds by output: the largest that `bound` gives over cells that cover `domain`.
pub(crate) fn largest(domain: &Domain, dof: usize, bound: impl Fn(&Instant) -> Vec<f64>) -> Vec<f64> {
    let joints: Vec<usize> = (0..dof).collect();
    let region = Region::new(domain, &joints);
    let evaluated = |cell: &Cell| {
        let frame = region.frame(cell);
        (bound(&instant(&region, cell, &frame)), frame)
    };
    let (first, frame) = evaluated(&region.root);
    let share = |bounds: &[f64]| {
        let part = |(bound, first): (&f64, &f64)| if *first > 0.0 { bound / first } else { 0.0 };
        bounds.iter().zip(&first).map(part).fold(0.0, f64::max)
    };
    let mut queue = Queue::new();
    queue.push(share(&first), (region.root, frame, first.clone()));
    for _ in 0..DIVIDED {
        let Some((_, (cell, frame, bounds))) = queue.pop() else { break };
        let Some(halves) = halved(&region, &cell, &frame) else {
            queue.push(0.0, (cell, frame, bounds));
            break;
        };
        for half in halves {
            let (within, frame) = evaluated(&half);
            // What holds in the whole holds in its halves.
            let bounds: Vec<f64> = within.iter().zip(&bounds).map(|(half, whole)| half.min(*whole)).collect();
            queue.push(share(&bounds), (half, frame, bounds));
        }
    }
    let mut most = vec![0.0; first.len()];
    while let Some((_, (_, _, bounds))) = queue.pop() {
        for (most, bound) in most.iter_mut().zip(bounds) {
            // NaN is no bound.
            *most = if bound.is_nan() { f64::INFINITY } else { f64::max(*most, bound) };
        }
    }
    most
}

/// Both halves of a cell, across what moves the joints most; `None` for a point.
fn halved(region: &Region, cell: &Cell, frame: &Frame) -> Option<[Cell; 2]> {
    let k = region.joints.len();
    let moved = |i: usize| frame.speed[i].abs() * frame.half + frame.off[i];
    let time = (0..k).map(moved).fold(0.0, f64::max);
    let widest = (0..k).max_by(|&a, &b| frame.width[a].total_cmp(&frame.width[b]).then(b.cmp(&a)))?;
    let across = if time >= frame.width[widest] && region.motion.is_some() { k } else { widest };
    let (low, high) = (cell.low[across], cell.high[across]);
    let middle = 0.5 * (low + high);
    if !(low < middle && middle < high) {
        return None;
    }
    let (mut lower, mut upper) = (*cell, *cell);
    (lower.high[across], upper.low[across]) = (middle, middle);
    Some([lower, upper])
}

fn instant(region: &Region, cell: &Cell, frame: &Frame) -> Instant {
    let joints = 0..region.joints.len();
    let about = |of: &dyn Fn(usize) -> (f64, f64)| -> Vec<Interval> {
        joints.clone().map(of).map(|(middle, radius)| Interval::about(middle, radius)).collect()
    };
    let error = |i: usize| (0.5 * (cell.low[i] + cell.high[i]), frame.width[i]);
    let desired = region.motion.map(|_| {
        let q = |i: usize| (frame.centre[i] - error(i).0, frame.total[i] - frame.width[i]);
        let qd = |i: usize| (frame.speed[i], frame.acceleration[i] * frame.half);
        let qdd = |i: usize| (0.0, frame.acceleration[i]);
        [about(&q), about(&qd), about(&qdd)]
    });
    Instant { q: about(&|i| (frame.centre[i], frame.total[i])), error: about(&error), desired }
}

/// Bounds by joint, N·m or N, on what the passivity torque `code` rounds by in `format`, over the domain and for rates up to
/// `rates`; its error is that against the same code in real numbers.
pub(crate) fn code_rounding(code: &Graph, domain: &Domain, rates: &Rates, format: Format) -> Vec<f64> {
    let dof = rates.speed.len();
    largest(domain, dof, |instant| code.rounding(&Passivity { q: &instant.q, rates }, format).outputs)
}

/// The inputs of a passivity torque.
struct Passivity<'a> {
    q: &'a [Interval],
    rates: &'a Rates,
}

impl Inputs for Passivity<'_> {
    fn input(&self, variable: Variable) -> Interval {
        let up_to = |most: &[f64], j: usize| most.get(j).map(|&most| Interval::about(0.0, most));
        let Rates { speed, reference_speed, reference_acceleration } = self.rates;
        let range = match variable {
            Variable::Q(j) => self.q.get(j).copied(),
            Variable::Qd(j) => up_to(speed, j),
            Variable::Vr(j) => up_to(reference_speed, j),
            Variable::Ar(j) => up_to(reference_acceleration, j),
            _ => None,
        };
        range.unwrap_or(Interval::ZERO)
    }

    fn error(&self, _measured: Variable) -> Option<Interval> {
        None
    }
}
