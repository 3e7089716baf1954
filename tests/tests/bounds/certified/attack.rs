//! Attempts to exceed published bounds: random states, ascents of their own, and the certificates' witnesses.

use gramforge::Generation;
use rayon::prelude::*;

use super::errors::Errors;
use super::space::Space;

/// The largest errors seen of one coefficient.
pub struct Seen {
    /// The coefficient.
    pub m: usize,
    /// At any state.
    pub largest: f64,
    /// By the random states and the ascents alone.
    pub independent: f64,
    /// Where the certificate says that it found its largest value.
    pub witness: f64,
    /// Whether that is in the domain.
    pub inside: bool,
}

/// Sees `states` random states, ascends from the worst of each coefficient and from `starts` more, and looks at the
/// witnesses.
pub fn attack(generation: &Generation, states: usize, starts: usize) -> Vec<Seen> {
    let (space, errors) = (Space::new(generation), Errors::new(generation));
    let worst = survey(&space, &errors, states);
    let see = |(index, worst): (usize, (f64, usize))| {
        let m = errors.simplified[index];
        let certificate = &generation.certificates()[m];
        let f = |q: &[f64]| errors.one(index, q);
        let from = std::iter::once(worst.1).chain((0..starts).map(|start| states + start * 131 + index));
        let climbed = from.map(|start| ascend(&space, space.point(start), f)).fold(worst.0, f64::max);
        let witness = f(&certificate.witness);
        let inside = space.contains(&certificate.witness, certificate.time);
        Seen { m, largest: climbed.max(witness), independent: climbed, witness, inside }
    };
    worst.into_par_iter().enumerate().map(see).collect()
}

/// The coefficients whose bound is exceeded, given a bound for each.
pub fn violations(bounds: &[f64], seen: &[Seen]) -> Vec<usize> {
    // A NaN exceeds every bound.
    let exceeded = |seen: &&Seen| seen.largest.is_nan() || seen.largest > bounds[seen.m];
    seen.iter().filter(exceeded).map(|seen| seen.m).collect()
}

/// The largest error of each simplified coefficient over random states, and the number of the state.
fn survey(space: &Space, errors: &Errors, states: usize) -> Vec<(f64, usize)> {
    let none = || vec![(0.0, 0); errors.simplified.len()];
    let worse = |a: (f64, usize), b: (f64, usize)| if b.0 > a.0 || b.0.is_nan() { b } else { a };
    let merge = |mut a: Vec<(f64, usize)>, b: Vec<(f64, usize)>| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a = worse(*a, b));
        a
    };
    (0..states)
        .into_par_iter()
        .with_min_len(256)
        .fold(none, |mut largest, index| {
            let seen = errors.all(&space.position(&space.point(index)));
            largest.iter_mut().zip(seen).for_each(|(most, error)| *most = worse(*most, (error, index)));
            largest
        })
        .reduce(none, merge)
}

/// The largest value on the way up from `x`, by pattern search (Hooke and Jeeves 1961): steps along single variables,
/// and once more along what they made together.
fn ascend(space: &Space, mut x: Vec<f64>, f: impl Fn(&[f64]) -> f64) -> f64 {
    let value = |x: &[f64]| f(&space.position(x));
    let hold = |i: usize, x: f64| x.clamp(space.sides[i][0], space.sides[i][1]);
    let explore = |x: &[f64], mut best: f64, step: f64| {
        let mut x = x.to_vec();
        for i in 0..x.len() {
            for direction in [step, -step] {
                let before = x[i];
                x[i] = hold(i, before + direction * (space.sides[i][1] - space.sides[i][0]));
                let there = if x[i] == before { best } else { value(&x) };
                if there > best {
                    best = there;
                    break;
                }
                x[i] = before;
            }
        }
        (x, best)
    };
    let mut best = value(&x);
    let mut step = 0.25;
    while step > 5e-4 {
        let (next, there) = explore(&x, best, step);
        if there <= best {
            step *= 0.4;
            continue;
        }
        let beyond: Vec<f64> = (0..x.len()).map(|i| hold(i, 2.0 * next[i] - x[i])).collect();
        let (far, further) = explore(&beyond, value(&beyond), step);
        (x, best) = if further > there { (far, further) } else { (next, there) };
    }
    best
}
