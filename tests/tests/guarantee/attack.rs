//! Runs that seek the worst.

use gramforge_tests::plant::{MOST, Row, row};
use gramforge_tests::random::Random;
use rayon::prelude::*;

use super::found::Found;
use super::frozen::{Aim, Frozen, Sensitivity};
use super::looped::{Attack, Loop};

/// Times at which an error that starts with the run may be largest, s.
const EARLY: [f64; 6] = [0.005, 0.02, 0.05, 0.1, 0.2, 0.4];
/// Distance of later aims of one run, s.
const APART: f64 = 0.6;

/// Attacks on `own` from initial errors of at most `initial`: first those that the frozen loop gives, then random ones, `most` in all;
/// if they are fewer than those of the frozen loop, some of these.
pub fn attacks(own: &Loop, initial: &[Row; 2], most: usize) -> Vec<Attack> {
    let frozen = Frozen::new(own);
    let mut out = Vec::new();
    for (aim, first) in aims(own) {
        let made = windows(own, &frozen, aim, first);
        for side in [1.0, -1.0] {
            for arm in 0..own.family.len() {
                out.push(attack(own, initial, &made, side, arm));
            }
        }
    }
    if most < out.len() {
        let count = out.len();
        return (0..most).map(|k| out[k * count / most].clone()).collect();
    }
    let mut random = Random::new(17);
    let directed = out.len();
    while out.len() < most {
        let base = (random.signed().abs() * directed as f64) as usize;
        let mut next = out[base.min(directed - 1)].clone();
        // A corner, or a point inside.
        let inside = out.len() % 4 == 3;
        let mut part = |largest: &Row| -> Row {
            std::array::from_fn(|i| {
                let x = random.signed();
                largest[i] * if inside { x } else { x.signum() }
            })
        };
        next.position = part(&initial[0]);
        next.velocity = part(&initial[1]);
        next.arm = out.len() % own.family.len();
        let turned: [bool; MOST] = std::array::from_fn(|_| random.signed() < -0.5);
        for sides in &mut next.sides {
            (0..MOST).filter(|&i| turned[i]).for_each(|i| sides[i] = -sides[i]);
        }
        out.push(next);
    }
    out
}

/// Runs them, on all threads.
pub fn attacked(own: &Loop, attacks: &[Attack]) -> Found {
    let found: Vec<Found> = attacks.par_iter().map(|attack| own.run(attack)).collect();
    found.iter().fold(Found::default(), |all, one| all.with(one))
}

/// What to move, and at which sample first.
fn aims(own: &Loop) -> Vec<(Aim, usize)> {
    let sample = |t: f64| ((t / own.period).ceil() as usize).clamp(1, own.periods);
    let mut out = Vec::new();
    let late = [sample(own.promised.settle), own.end.min(own.periods), own.periods];
    for first in EARLY.map(sample).into_iter().chain(late) {
        out.extend((0..own.n).map(|i| (Aim::Position(i), first)));
    }
    let settled = sample(own.promised.settle);
    for i in 0..own.n {
        // Where the promise is largest.
        let promised = |k: &usize| own.promised.course[*k].1[i];
        let within = |from: usize| {
            (from..own.promised.course.len().min(own.periods))
                .max_by(|a, b| promised(a).total_cmp(&promised(b)))
        };
        let widest = [1, settled].into_iter().filter_map(within);
        out.extend(widest.map(|k| (Aim::Position(i), k)));
        let asked = |k: &usize| own.asked(*k, &own.desired[*k].q, &own.desired[*k].qd)[i];
        let samples = || 0..own.periods;
        let more = |a: &usize, b: &usize| asked(a).total_cmp(&asked(b));
        let peaks = [Some(0), samples().max_by(more), samples().min_by(more)];
        out.extend(peaks.into_iter().flatten().map(|k| (Aim::Torque(i), k)));
    }
    out
}

/// The sensitivities of one run: of `aim` at sample `first`, then of the same joint's position again and again.
fn windows(own: &Loop, frozen: &Frozen, aim: Aim, first: usize) -> Vec<Sensitivity> {
    let gap = (APART / own.period).ceil() as usize;
    let joint = match aim {
        Aim::Position(i) | Aim::Torque(i) => i,
    };
    let settle = (own.promised.settle / own.period).ceil() as usize;
    let mut later: Vec<usize> =
        (settle..own.periods).step_by(gap).filter(|k| k.abs_diff(own.end) > gap / 2).collect();
    later.extend([own.end.min(own.periods), own.periods]);
    later.sort_unstable();
    later.retain(|&k| k > first && k <= own.periods);
    let mut out = vec![frozen.sensitivity(aim, 0, first)];
    let mut from = first;
    for until in later {
        out.push(frozen.sensitivity(Aim::Position(joint), from, until));
        from = until;
    }
    out
}

fn attack(own: &Loop, initial: &[Row; 2], windows: &[Sensitivity], side: f64, arm: usize) -> Attack {
    let start = windows[0].start.as_slice();
    let corner = |k: usize| -> Row {
        std::array::from_fn(|i| {
            let of = start.get(k * own.n + i).filter(|_| i < own.n).copied().unwrap_or(1.0);
            initial[k][i] * if side * of < 0.0 { -1.0 } else { 1.0 }
        })
    };
    let sides_of = |push: &Row| push.map(|x| if side * x < 0.0 { -1 } else { 1 });
    let mut sides: Vec<[i8; MOST]> =
        windows.iter().flat_map(|window| window.pushes.iter().map(sides_of)).collect();
    sides.resize(own.periods, sides.last().copied().unwrap_or([1; MOST]));
    Attack { position: corner(0), velocity: corner(1), arm, sides }
}

/// The same largest position error at every joint, none in velocity.
pub fn at_rest(position: f64) -> [Row; 2] {
    [[position; MOST], row(&[])]
}
