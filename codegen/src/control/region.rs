//! The positions that a domain holds, as boxes, and whether a set of errors stays inside.

use super::inertia::Cell;
use crate::arm::{Arm, JointKind};
use crate::domain::Domain;
use crate::motion::Motion;
use crate::number::{decimal, scientific};

/// Fewest and most pieces of a motion.
const PIECES: [f64; 2] = [16.0, 200.0];

/// Boxes that together hold every position of the domain; around a motion with the errors `width` in place of the
/// domain's own.
pub(super) fn cells(domain: &Domain, width: &[f64]) -> Vec<Cell> {
    match domain {
        Domain::Workspace(limits) => vec![box_cell(limits)],
        Domain::Path(motion) | Domain::Tube(motion, _) => around(motion, width),
    }
}

/// Where the arm may start with the position errors `start`: about q_d(0), anywhere without a motion.
pub(super) fn start(domain: &Domain, motion: Option<&Motion>, start: &[f64]) -> Cell {
    match (domain, motion) {
        (Domain::Workspace(limits), None) => box_cell(limits),
        (Domain::Workspace(_), Some(motion)) => about(motion, start),
        (Domain::Path(motion) | Domain::Tube(motion, _), _) => about(motion, start),
    }
}

/// The box of errors `half` about q_d(0).
fn about(motion: &Motion, half: &[f64]) -> Cell {
    Cell { centre: motion.at(0.0).q, half: half.to_vec() }
}

/// Why q_d + E_q with |E_q| ≤ `error` is not inside the domain; nothing where it is.
///
/// A revolute joint that its box lets turn a full circle is inside everywhere, since the model has that period. A joint
/// with limits is inside as long as motion and error together stay between them.
pub(super) fn outside(domain: &Domain, motion: Option<&Motion>, arm: &Arm, error: &[f64]) -> Vec<String> {
    let exceeds = |value: f64, limit: f64| value > limit * (1.0 + 1e-9);
    if let Some(width) = domain.width() {
        let of = |i: usize| {
            exceeds(error[i], width[i]).then(|| {
                format!(
                    "the error of joint {} may reach {}, the tube holds {}",
                    i + 1,
                    decimal(error[i], 4),
                    decimal(width[i], 4)
                )
            })
        };
        return (0..arm.dof()).filter_map(of).collect();
    }
    let Domain::Workspace(limits) = domain else { return Vec::new() };
    let turns = |i: usize| turns(arm, limits, i);
    let Some(motion) = motion else {
        // The desired motion keeps away from the edges by the errors: that must leave a place for it.
        let of = |i: usize| {
            let room = 0.5 * (limits[i][1] - limits[i][0]);
            (!turns(i) && (error[i].is_nan() || error[i] >= room)).then(|| {
                format!(
                    "the error of joint {} may reach {}, and half of its workspace is {}",
                    i + 1,
                    decimal(error[i], 4),
                    decimal(room, 4)
                )
            })
        };
        return (0..arm.dof()).filter_map(of).collect();
    };
    let path = around(motion, error);
    let of = |i: usize| {
        let high = path.iter().map(|c| c.centre[i] + c.half[i]).fold(f64::MIN, f64::max);
        let low = path.iter().map(|c| c.centre[i] - c.half[i]).fold(f64::MAX, f64::min);
        (!turns(i) && (exceeds(high - limits[i][1], 0.0) || exceeds(limits[i][0] - low, 0.0))).then(|| {
            format!(
                "with its error joint {} may reach [{}, {}], beyond its limits [{}, {}]",
                i + 1,
                decimal(low, 4),
                decimal(high, 4),
                scientific(limits[i][0]),
                scientific(limits[i][1])
            )
        })
    };
    (0..arm.dof()).filter_map(of).collect()
}

/// How far the joints may be off the motion inside the domain, rad or m; a full turn has room for half of one.
pub fn room(domain: &Domain, motion: Option<&Motion>, arm: &Arm) -> Vec<f64> {
    let turn: Vec<f64> = (0..arm.dof()).map(|i| 0.5 * arm.period(i)).collect();
    let (limits, motion) = match (domain, motion) {
        (Domain::Workspace(limits), Some(motion)) => (limits, motion),
        _ => return domain.width().unwrap_or(turn),
    };
    let path = around(motion, &vec![0.0; arm.dof()]);
    let of = |i: usize| {
        let high = path.iter().map(|c| c.centre[i] + c.half[i]).fold(f64::MIN, f64::max);
        let low = path.iter().map(|c| c.centre[i] - c.half[i]).fold(f64::MAX, f64::min);
        if turns(arm, limits, i) { turn[i] } else { (limits[i][1] - high).min(low - limits[i][0]) }
    };
    (0..arm.dof()).map(of).collect()
}

/// Whether the box lets revolute joint `i` turn a full circle.
pub(super) fn turns(arm: &Arm, limits: &[[f64; 2]], i: usize) -> bool {
    arm.joints[i].kind == JointKind::Revolute
        && arm.joints[i].limits.position.is_none()
        && limits[i][1] - limits[i][0] >= arm.period(i) * (1.0 - 1e-12)
}

/// Largest |q_j| in the cells.
pub(super) fn position_bound(cells: &[Cell], n: usize) -> Vec<f64> {
    let of = |j: usize| cells.iter().map(|c| c.centre[j].abs() + c.half[j]).fold(0.0, f64::max);
    (0..n).map(of).collect()
}

fn box_cell(limits: &[[f64; 2]]) -> Cell {
    Cell {
        centre: limits.iter().map(|[low, high]| 0.5 * (low + high)).collect(),
        half: limits.iter().map(|[low, high]| 0.5 * (high - low)).collect(),
    }
}

/// Boxes about pieces of the motion, wide enough for its range there or for |q_d(t) − q_d(middle)| ≤ |q̇_d(middle)| h +
/// ½ max|q̈_d| h², and for `width` more.
fn around(motion: &Motion, width: &[f64]) -> Vec<Cell> {
    let (speed, acceleration) = (motion.largest_speed(), motion.largest_acceleration());
    let length = |i: usize| speed[i] * motion.duration() / (0.5 * width[i]).max(1e-3);
    let wanted = (0..width.len()).map(length).fold(0.0, f64::max);
    let pieces = wanted.clamp(PIECES[0], PIECES[1]) as u32;
    let h = 0.5 * motion.duration() / f64::from(pieces);
    let piece = |k: u32| {
        let middle = h * f64::from(2 * k + 1);
        let (target, span) = (motion.at(middle), motion.span(middle - h, middle + h));
        let half = |i: usize| {
            let near = (span.q[i].high - target.q[i]).max(target.q[i] - span.q[i].low);
            near.min(target.qd[i].abs() * h + 0.5 * acceleration[i] * h * h) + width[i]
        };
        Cell { half: (0..width.len()).map(half).collect(), centre: target.q }
    };
    (0..pieces).map(piece).collect()
}
