//! The search from below: steps to larger |f| from many starts inside the domain.

use super::polynomial::{Jet, Scratch};
use super::region::{Cell, MAX_VARIABLES, Region};
use super::residual::Residual;
use crate::numerics::low_discrepancy::LowDiscrepancy;

/// Steps of one ascent at most.
const STEPS: usize = 40;

/// A large |f| and the variables where it stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summit {
    /// |f|.
    pub height: f64,
    /// Joint variables, then time.
    pub x: Vec<f64>,
}

impl Summit {
    /// The higher of two; this one where they tie.
    pub fn or(self, other: Self) -> Self {
        if other.height > self.height { other } else { self }
    }
}

/// The largest |f| found from at least one and `starts` points spread over the region.
pub fn search(residual: &Residual, region: &Region, starts: usize, scratch: &mut Scratch) -> Summit {
    let variables = region.variables();
    if variables == 0 {
        return climb(residual, region, &[], scratch);
    }
    let spread = LowDiscrepancy::new(variables);
    let mut best = Summit { height: -1.0, x: Vec::new() };
    for start in 0..starts.max(1) {
        let unit = spread.point(start);
        let at = |i: usize| region.root.low[i] + unit[i] * (region.root.high[i] - region.root.low[i]);
        let x: Vec<f64> = (0..variables).map(at).collect();
        best = best.or(climb(residual, region, &x, scratch));
    }
    best
}

/// The largest |f| on the way up from the variables `start`.
///
/// Each step maximises the separate quadratics of the variables inside a trust box that halves after a failure.
pub fn climb(residual: &Residual, region: &Region, start: &[f64], scratch: &mut Scratch) -> Summit {
    let variables = start.len();
    let root = &region.root;
    let mut x = start.to_vec();
    let mut at = Local::new(residual, region, &x, scratch);
    let sign = if at.jet.value < 0.0 { -1.0 } else { 1.0 };
    let mut trust = 0.25;
    let mut slow = 0;
    for _ in 0..STEPS {
        let step = |i: usize| {
            let size = trust * (root.high[i] - root.low[i]);
            let (low, high) = ((x[i] - size).max(root.low[i]), (x[i] + size).min(root.high[i]));
            x[i] + highest(sign * at.slope[i], sign * at.curvature[i], low - x[i], high - x[i])
        };
        let next: Vec<f64> = (0..variables).map(|i| step(i).clamp(root.low[i], root.high[i])).collect();
        if next == x {
            break;
        }
        let there = Local::new(residual, region, &next, scratch);
        let gain = sign * (there.jet.value - at.jet.value);
        if gain > 0.0 {
            slow = if gain < 1e-5 * at.jet.value.abs() { slow + 1 } else { 0 };
            (x, at) = (next, there);
            trust = (2.0_f64 * trust).min(1.0);
        } else {
            trust *= 0.3;
        }
        if slow > 2 || trust < 1e-5 {
            break;
        }
    }
    Summit { height: at.jet.value.abs(), x }
}

/// f at a point, with slope and curvature along each variable.
struct Local {
    jet: Jet,
    slope: [f64; MAX_VARIABLES],
    curvature: [f64; MAX_VARIABLES],
}

impl Local {
    fn new(residual: &Residual, region: &Region, x: &[f64], scratch: &mut Scratch) -> Self {
        let cell: Cell = Region::point(x);
        let frame = region.frame(&cell);
        let jet = residual.jet(&frame, scratch);
        let k = region.joints.len();
        let mut out = Self { slope: [0.0; MAX_VARIABLES], curvature: [0.0; MAX_VARIABLES], jet };
        for i in 0..k {
            out.slope[i] = out.jet.gradient[i];
            out.curvature[i] = out.jet.hessian[i][i];
            out.slope[k] += out.jet.gradient[i] * frame.speed[i];
            for j in 0..k {
                out.curvature[k] += frame.speed[i] * out.jet.hessian[i][j] * frame.speed[j];
            }
        }
        out
    }
}

/// Where g x + ½ H x² is largest on [low, high], low ≤ 0 ≤ high.
fn highest(g: f64, h: f64, low: f64, high: f64) -> f64 {
    if h < 0.0 {
        return (-g / h).clamp(low, high);
    }
    let value = |x: f64| (g + 0.5 * h * x) * x;
    if value(high) >= value(low) { high } else { low }
}
