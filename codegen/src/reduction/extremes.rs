//! Points of a domain where residuals are largest.

use crate::measure::{Domain, Measure};
use crate::motion::Motion;
use crate::spread::{Spread, corner, in_box};

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
                let sides: Vec<[f64; 2]> = q.iter().zip(errors).map(|(q, e)| [q - e, q + e]).collect();
                let corners = (first..1 << errors.len()).step_by(stride);
                points.extend(corners.map(|index| in_box(&sides, &corner(index, errors.len()))));
            }
        }
        (Domain::Workspace(limits), _) => {
            let spread = Spread::new(limits.len());
            // The measure has the sequence's first points.
            let inner = (0..WORKSPACE_POINTS).map(|i| spread.point(measure.points.len() + i));
            let corners = (0..1 << limits.len()).map(|index| corner(index, limits.len()));
            points.extend(inner.chain(corners).map(|unit| in_box(limits, &unit)));
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
