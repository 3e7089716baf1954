//! Second-order enclosures of a function over a cell, from its jet at the centre and bounds on its derivatives.

use super::polynomial::Jet;
use super::region::{Frame, MAX_VARIABLES};
use super::rounding::ENCLOSURE;
use super::tensors::Tensors;
use crate::lagrangian::MAX_JOINTS;

/// What all enclosures of one function share.
///
/// The jets may be those of a polynomial p near f: then |f − p| ≤ remainder and |∂(f − p)/∂q_i| ≤ slack_i.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// Bounds on the derivatives of p.
    tensors: Tensors,
    /// Absolute rounding error of any enclosure of p.
    rounding: f64,
    /// Bound on |f − p|.
    remainder: f64,
    /// Bounds on the slopes of f − p, by joint.
    slack: Vec<f64>,
}

/// What a cell is known to hold.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    /// σf at the centre is at least this.
    pub least: f64,
    /// σf exceeds this nowhere in the cell.
    pub upper: f64,
    /// The variable whose halving promises most.
    pub split: usize,
    /// By variable +1 or −1 where σf only rises or only falls, else 0.
    pub slope: [i8; MAX_VARIABLES],
}

impl Envelope {
    /// For a p with the given bounds on its derivatives, over cells whose positions are no further than `widest` from
    /// their centres and than `position_bound` from 0.
    pub fn new(
        tensors: Tensors,
        widest: &[f64],
        position_bound: &[f64],
        remainder: f64,
        slack: Vec<f64>,
    ) -> Self {
        let steps: f64 = (0..position_bound.len())
            .map(|i| tensors.gradient[i] * (widest[i] + 1.0 + position_bound[i]))
            .sum();
        let third = tensors.third(widest);
        let cubic: f64 = (0..position_bound.len()).map(|i| third[i] * widest[i]).sum();
        let scale = tensors.value + steps + tensors.second(widest) + cubic;
        Self { tensors, rounding: ENCLOSURE * scale, remainder, slack }
    }

    /// Encloses σf, σ = `sign`, over the positions of `frame`, given the jet at its centre.
    ///
    /// With δ = e + v s + o, |o| ≤ off, f(q + δ) = f + g·δ + ½δᵀHδ + R, |R| ≤ ⅙ Σ T_ijk |δ_iδ_jδ_k|. The linear
    /// and the square part of each variable are maximised together, so that a cell around an inner maximum has no
    /// first-order excess; the motion enters by its direction v, so that neither has one in time.
    pub fn enclose(&self, frame: &Frame, jet: &Jet, sign: f64) -> Enclosure {
        let k = self.slack.len();
        let (w, h, v) = (&frame.width, frame.half, &frame.speed);
        let third = self.tensors.third(&frame.total[..k]);
        // What the gradient can change by within the cell, and H v.
        let mut change = [0.0; MAX_JOINTS];
        let mut along = [0.0; MAX_JOINTS];
        for i in 0..k {
            for j in 0..k {
                change[i] += jet.hessian[i][j].abs() * frame.total[j];
                along[i] += jet.hessian[i][j] * v[j];
            }
        }
        let (mut upper, mut linear) = (sign * jet.value, sign * jet.value);
        let mut score = [0.0; MAX_VARIABLES];
        let mut slope = [0; MAX_VARIABLES];
        let (mut time_linear, mut time_square) = (0.0, 0.0);
        let (mut time_change, mut drift) = (0.0, 0.0);
        for i in 0..k {
            let g = sign * jet.gradient[i];
            time_linear += g * v[i];
            time_square += sign * along[i] * v[i];
            drift += (g.abs() + change[i]) * frame.off[i];
            let gradient_change =
                change[i] + 0.5 * third[i] + ENCLOSURE * self.tensors.gradient[i] + self.slack[i];
            time_change += gradient_change * (v[i].abs() + frame.acceleration[i] * h);
            time_change += g.abs() * frame.acceleration[i] * h;
            upper += rise(g, sign * jet.hessian[i][i], w[i]) + third[i] * frame.total[i] / 6.0;
            linear += g.abs() * w[i];
            let mut cross = h * along[i].abs();
            for j in 0..k {
                if j != i {
                    cross += 0.5 * jet.hessian[i][j].abs() * w[j];
                }
            }
            upper += w[i] * cross;
            if w[i] > 0.0 {
                score[i] = w[i] * (g.abs() + change[i] + h * along[i].abs() + third[i]);
                slope[i] = steep(g, gradient_change);
            }
        }
        upper += rise(time_linear, time_square, h) + drift;
        linear += time_linear.abs() * h + drift + 0.5 * self.tensors.second(&frame.total[..k]);
        if h > 0.0 {
            let crossing: f64 = (0..k).map(|i| w[i] * along[i].abs() + third[i] * v[i].abs()).sum();
            score[k] = h * (time_linear.abs() + time_square.abs() * h + crossing) + 2.0 * drift;
            slope[k] = steep(time_linear, time_change);
        }
        let split = (0..=k).fold(0, |best, i| if score[i] > score[best] { i } else { best });
        let upper = upper.min(linear).min(self.tensors.value) + self.rounding + self.remainder;
        Enclosure { least: sign * jet.value - self.remainder, upper, split, slope }
    }
}

/// max of g x + ½ H x² over |x| ≤ w.
fn rise(g: f64, h: f64, w: f64) -> f64 {
    let g = g.abs();
    if h < 0.0 && g < -h * w { 0.5 * g * g / -h } else { (g + 0.5 * h * w) * w }
}

/// The sign of a slope `g` that can change by at most `change`.
fn steep(g: f64, change: f64) -> i8 {
    if g > change {
        1
    } else if -g > change {
        -1
    } else {
        0
    }
}
