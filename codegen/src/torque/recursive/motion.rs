//! Outward: how the frames move.
//!
//! The gradient H = [ω̇]× + ½(ω ω_rᵀ + ω_r ωᵀ) − (ω·ω_r)·1 takes a point of a link to its polarised acceleration. Points
//! on a joint's axis belong to both its links, so H z is the parent's, turned; and H + Hᵀ holds products of velocities
//! alone. Between them they give every entry without the angular acceleration across the axis.

use super::choice::{Choice, Corner, Diagonal, Row};
use super::vector::{Matrix, Turn, Vector, add, apply, dot, inward, outward, seen_from};
use crate::arm::JointKind;
use crate::graph::Expr;

/// What one frame knows of a link's motion.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Frame<'g> {
    /// ω.
    pub w: Vector<'g>,
    /// ω_r.
    pub r: Vector<'g>,
    /// H.
    pub h: Matrix<'g>,
    /// Acceleration of the origin, less gravity.
    pub a: Vector<'g>,
}

/// Products of velocities that moments can be made of.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Products<'g> {
    /// ½(x y_r + y x_r).
    pub xy: Expr<'g>,
    /// x z_r + z x_r.
    pub xz: Expr<'g>,
    /// y z_r + z y_r.
    pub yz: Expr<'g>,
    /// ω̇_z.
    pub spin: Expr<'g>,
}

/// A link's motion.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Motion<'g> {
    /// In the frame that has not turned with the joint.
    pub still: Frame<'g>,
    pub still_products: Products<'g>,
    /// In the link's own frame.
    pub turned: Frame<'g>,
    pub turned_products: Products<'g>,
    /// From the still to the turned frame; `None` where they are the same.
    pub turn: Option<Turn<'g>>,
}

/// A joint's constants and inputs.
#[derive(Clone, Copy)]
pub(super) struct Step<'g> {
    pub kind: JointKind,
    /// Axes of the still frame in the frame it comes from.
    pub axes: [[f64; 3]; 3],
    /// Turn from the still to the own frame by the joint alone.
    pub own: Option<Turn<'g>>,
    /// Origin in the parent's own frame, at q = 0 of a prismatic joint, in the unit of accelerations.
    pub origin: Vector<'g>,
    /// The same in the unit of forces.
    pub lever: Vector<'g>,
    pub q: Option<Expr<'g>>,
    pub qd: Expr<'g>,
    pub vr: Expr<'g>,
    pub ar: Expr<'g>,
}

/// Motion of the link that `step` joins to one that moves as `parent`.
pub(super) fn advance<'g>(
    parent: &Motion<'g>,
    step: &Step<'g>,
    before: &Choice,
    choice: &Choice,
) -> Motion<'g> {
    let zero = step.qd.constant_like(0.0);
    let from = if choice.sum { &parent.still } else { &parent.turned };
    let axes = &step.axes;
    let mut w = inward(axes, from.w);
    let mut r = inward(axes, from.r);
    let m = seen_from(axes, &from.h);
    let (w0, r0) = (w, r);
    let swept = sweep(parent, step, before.still_lever, choice.sum);
    let mut a = inward(axes, add(from.a, swept));
    let angular = [from.h[2][1] - from.h[1][2], from.h[0][2] - from.h[2][0], from.h[1][0] - from.h[0][1]];
    let straight = axes.iter().flatten().all(|entry| entry.fract() == 0.0);
    let twice = if straight {
        m[1][0] - m[0][1]
    } else {
        dot(axes.map(|row| step.qd.constant_like(row[2])), angular)
    };
    let mut spin_own = zero;
    let mut rates = (zero, zero);
    match step.kind {
        JointKind::Revolute => {
            w[2] = w[2] + step.qd;
            r[2] = r[2] + step.vr;
            spin_own = step.ar;
            rates = (step.qd, step.vr);
        }
        JointKind::Prismatic => {
            let q = step.q.unwrap_or(zero);
            a = [
                a[0] + q * m[0][2] + (step.vr * w[1] + step.qd * r[1]),
                a[1] + q * m[1][2] - (step.vr * w[0] + step.qd * r[0]),
                a[2] + q * m[2][2] + step.ar,
            ];
        }
    }
    let half = zero.constant_like(0.5);
    let spin = half * twice + spin_own;

    let h = still_gradient(&m, (w0, r0), (w, r), (twice, spin_own), rates, choice);
    let still = Frame { w, r, h, a };
    let still_products = products(w, r, spin);
    let turn = match (choice.sum, parent.turn, step.own) {
        (true, Some(first), own) => {
            let first = if axes[2][2] < 0.0 { first.back() } else { first };
            Some(own.map_or(first, |own| first.then(&own)))
        }
        (_, _, own) => own,
    };
    let Some(turn) = turn else {
        return Motion { still, still_products, turned: still, turned_products: still_products, turn };
    };
    let (w, r) = (turn.inward(w), turn.inward(r));
    let h = turned_gradient(&still, (w, r), (twice, spin_own), &turn, choice);
    let turned = Frame { w, r, h, a: turn.inward(a) };
    Motion { still, still_products, turned, turned_products: products(w, r, spin), turn: Some(turn) }
}

fn products<'g>(w: Vector<'g>, r: Vector<'g>, spin: Expr<'g>) -> Products<'g> {
    let mixed = |i: usize, j: usize| w[i] * r[j] + w[j] * r[i];
    Products { xy: spin.constant_like(0.5) * mixed(0, 1), xz: mixed(0, 2), yz: mixed(1, 2), spin }
}

/// H p in the frame that the joint's still frame comes from.
fn sweep<'g>(parent: &Motion<'g>, step: &Step<'g>, still_lever: bool, sum: bool) -> Vector<'g> {
    let p = step.origin;
    let Some(turn) = parent.turn else { return apply(&parent.turned.h, p) };
    match (still_lever, sum) {
        (false, false) => apply(&parent.turned.h, p),
        (false, true) => turn.outward(apply(&parent.turned.h, p)),
        (true, true) => apply(&parent.still.h, turn.outward(p)),
        (true, false) => turn.inward(apply(&parent.still.h, turn.outward(p))),
    }
}

/// H in the still frame.
fn still_gradient<'g>(
    m: &Matrix<'g>,
    (w0, r0): (Vector<'g>, Vector<'g>),
    (w, r): (Vector<'g>, Vector<'g>),
    (twice, spin): (Expr<'g>, Expr<'g>),
    (qd, vr): (Expr<'g>, Expr<'g>),
    choice: &Choice,
) -> Matrix<'g> {
    let zz = w[2] * r[2];
    let mut h = *m;
    h[2] = match choice.row {
        Row::Parent => [m[2][0] + (vr * w0[0] + qd * r0[0]), m[2][1] + (vr * w0[1] + qd * r0[1]), m[2][2]],
        Row::Turned | Row::Still => {
            [w[0] * r[2] + r[0] * w[2] - m[0][2], w[1] * r[2] + r[1] * w[2] - m[1][2], m[2][2]]
        }
    };
    if choice.afresh {
        let sum = w[0] * r[1] + w[1] * r[0];
        h[0][0] = -(w[1] * r[1] + zz);
        h[1][1] = -(w[0] * r[0] + zz);
        h[1][0] = zz.constant_like(0.5) * (sum + twice) + spin;
        h[0][1] = sum - h[1][0];
    } else {
        let slow = qd * r[2] + vr * w0[2];
        h[0][0] = m[0][0] - slow;
        h[1][1] = m[1][1] - slow;
        h[1][0] = m[1][0] + spin;
        h[0][1] = m[0][1] - spin;
    }
    h
}

/// H in the turned frame, where the velocities are `w` and `r`.
fn turned_gradient<'g>(
    still: &Frame<'g>,
    (w, r): (Vector<'g>, Vector<'g>),
    (twice, spin): (Expr<'g>, Expr<'g>),
    turn: &Turn<'g>,
    choice: &Choice,
) -> Matrix<'g> {
    let (s, c) = (turn.sin, turn.cos);
    let n = &still.h;
    let mut h = *n;
    let column = turn.inward([n[0][2], n[1][2], n[2][2]]);
    for i in 0..3 {
        h[i][2] = column[i];
    }
    match choice.row {
        Row::Turned => {
            h[2][0] = w[0] * r[2] + w[2] * r[0] - h[0][2];
            h[2][1] = w[1] * r[2] + w[2] * r[1] - h[1][2];
        }
        Row::Still | Row::Parent => h[2] = turn.inward(n[2]),
    }
    // Rᵀ N R of the upper left block.
    let lean = s * (n[1][1] - n[0][0]) + c * (n[0][1] + n[1][0]);
    let (xx, yy, zz) = (w[0] * r[0], w[1] * r[1], w[2] * r[2]);
    match choice.diagonal {
        Diagonal::Trace => {
            h[0][0] = -(yy + zz);
            h[1][1] = h[2][2] + yy - zz;
        }
        Diagonal::Squares => {
            h[0][0] = -(yy + zz);
            h[1][1] = -(xx + zz);
        }
        Diagonal::Turned => {
            h[0][0] = n[0][0] + s * lean;
            h[1][1] = n[1][1] - s * lean;
        }
    }
    let sum = w[0] * r[1] + w[1] * r[0];
    let half = sum.constant_like(0.5);
    match choice.corner {
        Corner::Sum => {
            h[1][0] = half * (sum + twice) + spin;
            h[0][1] = sum - h[1][0];
        }
        Corner::Halves => {
            let rate = half * twice + spin;
            h[1][0] = half * sum + rate;
            h[0][1] = half * sum - rate;
        }
        Corner::Turned => {
            h[1][0] = c * lean - n[0][1];
            h[0][1] = c * lean - n[1][0];
        }
    }
    h
}

/// A vector of the parent's frame that the still frame comes from.
pub(super) fn to_parent<'g>(step: &Step<'g>, x: Vector<'g>) -> Vector<'g> {
    outward(&step.axes, x)
}
