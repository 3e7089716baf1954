//! Inward: what moves the bodies.

use super::choice::{Choice, Round};
use super::motion::{Frame, Motion, Products};
use super::vector::{Matrix, Turn, Vector, add, apply, cross};
use crate::arm::Body;
use crate::graph::Expr;

/// Force, and moment about a frame's origin.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Wrench<'g> {
    pub force: Vector<'g>,
    pub moment: Vector<'g>,
}

impl<'g> Wrench<'g> {
    pub(super) fn zero(like: Expr<'g>) -> Self {
        let zero = [like.constant_like(0.0); 3];
        Self { force: zero, moment: zero }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self { force: add(self.force, other.force), moment: add(self.moment, other.moment) }
    }

    /// About the origin of a frame in which this one's origin stands at `lever`.
    pub(super) fn about(&self, lever: Vector<'g>) -> Self {
        Self { force: self.force, moment: add(self.moment, cross(lever, self.force)) }
    }

    pub(super) fn outward(&self, turn: &Turn<'g>) -> Self {
        Self { force: turn.outward(self.force), moment: turn.outward(self.moment) }
    }
}

/// Units of length for accelerations and for forces, m: torques do not depend on them, but constants become 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// Accelerations are divided by it.
    pub acceleration: f64,
    /// Forces are multiplied by it.
    pub force: f64,
}

/// What moves the body: in the still frame first, in the turned frame second.
pub(super) fn own<'g>(
    body: &Body,
    motion: &Motion<'g>,
    choice: &Choice,
    units: &Units,
) -> (Wrench<'g>, Wrench<'g>) {
    let like = motion.still.w[2];
    let constant = |x: f64| like.constant_like(x);
    let first = |unit: f64| body.first_moment.map(|s| constant(s * unit));
    let mass = constant(body.mass * (units.acceleration * units.force));
    let sigma = body.pseudo_inertia.map(|row| row.map(constant));
    let turn = motion.turn;
    let mut out = (Wrench::zero(like), Wrench::zero(like));
    {
        let (still, turned) = (&mut out.0, &mut out.1);
        match turn.filter(|_| choice.still_force) {
            Some(turn) => still.force = apply(&motion.still.h, turn.outward(first(units.force))),
            None => turned.force = apply(&motion.turned.h, first(units.force)),
        }
        match turn.filter(|_| choice.still_pull) {
            Some(turn) => {
                still.force = add(still.force, motion.still.a.map(|a| mass * a));
                still.moment = cross(turn.outward(first(units.acceleration)), motion.still.a);
            }
            None => {
                turned.force = add(turned.force, motion.turned.a.map(|a| mass * a));
                turned.moment = cross(first(units.acceleration), motion.turned.a);
            }
        }
        match turn {
            Some(turn) if choice.still_sigma => {
                let sigma = seen(&sigma, &turn);
                still.moment =
                    add(still.moment, turning(&sigma, &motion.still, &motion.still_products, choice));
            }
            Some(_) if choice.round != Round::None => {
                let (round, rest) = parted(&body.pseudo_inertia, choice.round);
                let (round, rest) = (round.map(|row| row.map(constant)), rest.map(|row| row.map(constant)));
                still.moment =
                    add(still.moment, turning(&round, &motion.still, &motion.still_products, choice));
                turned.moment =
                    add(turned.moment, turning(&rest, &motion.turned, &motion.turned_products, choice));
            }
            _ => {
                let moment = turning(&sigma, &motion.turned, &motion.turned_products, choice);
                turned.moment = add(turned.moment, moment);
            }
        }
    }
    out
}

/// Σ as a part that is round about z and the rest.
fn parted(sigma: &[[f64; 3]; 3], round: Round) -> ([[f64; 3]; 3], [[f64; 3]; 3]) {
    let across = match round {
        Round::None => 0.0,
        Round::X => sigma[0][0],
        Round::Y => sigma[1][1],
    };
    let mut rest = *sigma;
    rest[0][0] -= across;
    rest[1][1] -= across;
    rest[2][2] = 0.0;
    ([[across, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, sigma[2][2]]], rest)
}

/// Σ in the still frame.
fn seen<'g>(m: &Matrix<'g>, turn: &Turn<'g>) -> Matrix<'g> {
    let (s, c) = (turn.sin, turn.cos);
    let lean = c * (m[0][1] + m[1][0]) - s * (m[1][1] - m[0][0]);
    let xy = c * lean - m[0][1];
    let side = turn.outward([m[0][2], m[1][2], m[2][2]]);
    [[m[0][0] - s * lean, xy, side[0]], [xy, m[1][1] + s * lean, side[1]], [side[0], side[1], m[2][2]]]
}

/// The axial vector of HΣ − (HΣ)ᵀ.
fn turning<'g>(m: &Matrix<'g>, frame: &Frame<'g>, products: &Products<'g>, choice: &Choice) -> Vector<'g> {
    let h = &frame.h;
    let (xx, yy, zz) = (m[0][0], m[1][1], m[2][2]);
    let (about_x, about_y) = if choice.mixed {
        (yy * products.yz - (yy + zz) * h[1][2], (xx + zz) * h[0][2] - xx * products.xz)
    } else {
        (yy * h[2][1] - zz * h[1][2], zz * h[0][2] - xx * h[2][0])
    };
    let about_z = if choice.axial {
        (xx - yy) * products.xy + (xx + yy) * products.spin
    } else {
        xx * h[1][0] - yy * h[0][1]
    };
    [
        about_x + m[0][1] * h[2][0] - m[0][2] * h[1][0] + m[1][2] * (h[2][2] - h[1][1]),
        about_y - m[0][1] * h[2][1] + m[0][2] * (h[0][0] - h[2][2]) + m[1][2] * h[0][1],
        about_z + m[0][1] * (h[1][1] - h[0][0]) + m[0][2] * h[1][2] - m[1][2] * h[0][2],
    ]
}
