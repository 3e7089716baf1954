//! Points of a domain where residuals are largest.

use crate::measure::{Domain, Measure, Spread};
use crate::motion::Motion;

/// Intervals of the desired motion.
const INTERVALS: u32 = 200;
/// Most corners of the box of position errors at each instant.
const CORNERS: usize = 16;
/// Points of a workspace, besides those of the measure and the corners.
const WORKSPACE_POINTS: usize = 8192;

/// The points of the measure, and those where a residual tends to be largest: over a tube the corners of the box of position
/// errors at every instant, of a large arm's box a changing subset; over a workspace the corners and more inner points.
pub fn extremes(measure: &Measure, domain: &Domain, motion: Option<&Motion>) -> Vec<Vec<f64>> {
    let mut points = measure.points.clone();
    match (domain, motion) {
        (Domain::Tube(errors), Some(motion)) if errors.iter().any(|&e| e > 0.0) => {
            let stride = stride(errors.len());
            for k in 0..=INTERVALS {
                let q = motion.at(motion.duration() * f64::from(k) / f64::from(INTERVALS)).q;
                // The ends of a motion are extremes of the path itself: all corners there.
                let (first, stride) =
                    if k == 0 || k == INTERVALS { (0, 1) } else { (k as usize % stride, stride) };
                for corner in (first..1 << errors.len()).step_by(stride) {
                    let side = |i: usize| if (corner >> i) & 1 == 1 { 1.0 } else { -1.0 };
                    points.push((0..q.len()).map(|i| q[i] + side(i) * errors[i]).collect());
                }
            }
        }
        (Domain::Workspace(limits), _) => {
            let spread = Spread::new(limits.len());
            let at = |unit: &[f64]| -> Vec<f64> {
                limits.iter().zip(unit).map(|([low, high], u)| low + (high - low) * u).collect()
            };
            // The measure has the sequence's first points.
            points.extend((0..WORKSPACE_POINTS).map(|i| at(&spread.point(measure.points.len() + i))));
            points.extend((0..1_usize << limits.len()).map(|corner| {
                at(&(0..limits.len()).map(|i| ((corner >> i) & 1) as f64).collect::<Vec<_>>())
            }));
        }
        _ => {}
    }
    points
}

/// Every how manieth corner of a box in `n` dimensions is taken; odd, so that the instants take turns.
fn stride(n: usize) -> usize {
    let corners = 1_usize << n;
    if corners <= CORNERS { 1 } else { corners / CORNERS }
}
