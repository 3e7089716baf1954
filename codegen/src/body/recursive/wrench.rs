//! Inward: what moves the bodies.

use super::choice::Choice;
use super::motion::{Frame, Motion, Products};
use super::vector::{Matrix, Turn, Vector, add, apply, cross};
use crate::arm::Body;
use crate::graph::Expr;

/// Force, and moment about a frame's origin.
#[derive(Clone, Copy)]
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

/// A body's parameters as nodes.
struct Parameters<'g> {
    mass: Expr<'g>,
    first: Vector<'g>,
    sigma: Matrix<'g>,
}

/// What moves the body: in the still frame first, in the turned frame second, one of them zero.
pub(super) fn own<'g>(body: &Body, motion: &Motion<'g>, choice: &Choice) -> (Wrench<'g>, Wrench<'g>) {
    let like = motion.still.w[2];
    let parameters = Parameters {
        mass: like.constant_like(body.mass),
        first: body.first_moment.map(|s| like.constant_like(s)),
        sigma: body.pseudo_inertia.map(|row| row.map(|x| like.constant_like(x))),
    };
    match (choice.still_body, motion.turn) {
        (true, Some(turn)) => {
            let turned = turned(&parameters, &turn);
            (wrench(&turned, &motion.still, &motion.still_products, choice), Wrench::zero(like))
        }
        _ => (Wrench::zero(like), wrench(&parameters, &motion.turned, &motion.turned_products, choice)),
    }
}

/// The parameters in the still frame.
fn turned<'g>(body: &Parameters<'g>, turn: &Turn<'g>) -> Parameters<'g> {
    let m = &body.sigma;
    let (s, c) = (turn.sin, turn.cos);
    let lean = c * (m[0][1] + m[1][0]) - s * (m[1][1] - m[0][0]);
    let xy = c * lean - m[0][1];
    let side = turn.outward([m[0][2], m[1][2], m[2][2]]);
    let sigma =
        [[m[0][0] - s * lean, xy, side[0]], [xy, m[1][1] + s * lean, side[1]], [side[0], side[1], m[2][2]]];
    Parameters { mass: body.mass, first: turn.outward(body.first), sigma }
}

/// f = m a + H s, n = s × a + the axial vector of HΣ − (HΣ)ᵀ.
fn wrench<'g>(
    body: &Parameters<'g>,
    frame: &Frame<'g>,
    products: &Products<'g>,
    choice: &Choice,
) -> Wrench<'g> {
    let Frame { h, a, .. } = frame;
    let force = add(a.map(|a| body.mass * a), apply(h, body.first));
    let m = &body.sigma;
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
    let moment = [
        about_x + m[0][1] * h[2][0] - m[0][2] * h[1][0] + m[1][2] * (h[2][2] - h[1][1]),
        about_y - m[0][1] * h[2][1] + m[0][2] * (h[0][0] - h[2][2]) + m[1][2] * h[0][1],
        about_z + m[0][1] * (h[1][1] - h[0][0]) + m[0][2] * h[1][2] - m[1][2] * h[0][2],
    ];
    Wrench { force, moment: add(moment, cross(body.first, *a)) }
}
