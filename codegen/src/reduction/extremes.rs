//! Points of a domain where residuals are largest.

use crate::domain::{Domain, Measure};
use crate::motion::Motion;
use crate::numerics::low_discrepancy::{LowDiscrepancy, corner, in_box};

/// Intervals of the desired motion.
const INTERVALS: u32 = 200;
/// Most corners of the box of position errors at an instant within the motion.
const CORNERS: usize = 16;
/// Other points of the box at each instant.
const OTHERS: usize = 16;
/// How far the other points are spread beyond the box before they are moved back to its sides.
const STRETCH: f64 = 1.5;
/// Points of a workspace, besides those of the measure and the corners.
const WORKSPACE_POINTS: usize = 8192;

/// Points where a residual tends to be largest, for a refit that minimises its maximum.
///
/// Over a trajectory the points of the measure. Over a tube, at every instant, corners of the box of position errors
/// (of a large arm's box a part that changes from instant to instant, but all at the ends of the motion) and points with some
/// coordinates on the sides of the box and the others within. Over a workspace the points of the measure, as many again twice
/// and the corners.
pub fn extremes(measure: &Measure, domain: &Domain) -> Vec<Vec<f64>> {
    match domain {
        Domain::Tube(motion, errors) if errors.iter().any(|&e| e > 0.0) => tube(motion, errors),
        Domain::Workspace(limits) => workspace(measure, limits),
        _ => measure.points.clone(),
    }
}

fn tube(motion: &Motion, errors: &[f64]) -> Vec<Vec<f64>> {
    let n = errors.len();
    let corners = 1_usize << n;
    let turns = (corners / CORNERS).max(1);
    let spread = LowDiscrepancy::new(n);
    let mut points = Vec::new();
    for k in 0..=INTERVALS {
        let q = motion.at(motion.duration() * f64::from(k) / f64::from(INTERVALS)).q;
        let moved = |side: &[f64]| q.iter().zip(errors).zip(side).map(|((q, e), s)| q + e * s).collect();
        let (first, step) = if k == 0 || k == INTERVALS { (0, 1) } else { (k as usize % turns, turns) };
        for index in (first..corners).step_by(step) {
            points.push(moved(&in_box(&vec![[-1.0, 1.0]; n], &corner(index, n))));
        }
        for other in 0..OTHERS {
            let unit = spread.point(k as usize * OTHERS + other);
            let side = |u: &f64| (STRETCH * (2.0 * u - 1.0)).clamp(-1.0, 1.0);
            points.push(moved(&unit.iter().map(side).collect::<Vec<f64>>()));
        }
    }
    points
}

fn workspace(measure: &Measure, limits: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let spread = LowDiscrepancy::new(limits.len());
    // The measure has the first points of the sequence.
    let from = measure.points.len();
    let more = (from..from + WORKSPACE_POINTS).map(|index| spread.point(index));
    let corners = (0..1 << limits.len()).map(|index| corner(index, limits.len()));
    let added = more.chain(corners).map(|unit| in_box(limits, &unit));
    measure.points.iter().cloned().chain(added).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::{INTERVALS, OTHERS, extremes};
    use crate::domain::{Domain, Measure};
    use crate::motion::Motion;

    #[test]
    fn every_point_is_in_the_tube_and_every_corner_is_visited() {
        let n = 6;
        let motion = Motion::Quintic { from: vec![0.5; n], to: vec![0.5; n], duration: 1.0 };
        let domain = Domain::Tube(Arc::new(motion), vec![0.25; n]);
        let nothing = Measure {
            points: Vec::new(),
            weights: Vec::new(),
            acceleration_square: Vec::new(),
            velocity_square: Vec::new(),
        };
        let points = extremes(&nothing, &domain);
        assert_eq!(points.len(), (INTERVALS as usize + 1) * (16 + OTHERS) + 2 * (64 - 16));
        assert!(points.iter().flatten().all(|q| (q - 0.5).abs() <= 0.25));
        let within = &points[64 + OTHERS..points.len() - 64 - OTHERS];
        let mut corners: Vec<String> = within
            .iter()
            .filter(|q| q.iter().all(|q| (q - 0.5).abs() == 0.25))
            .map(|q| format!("{q:?}"))
            .collect();
        corners.sort();
        corners.dedup();
        assert_eq!(corners.len(), 64);
    }

    #[test]
    fn without_errors_the_measure_is_enough() {
        let motion = Arc::new(Motion::Quintic { from: vec![0.0], to: vec![1.0], duration: 1.0 });
        let measure = Measure {
            points: vec![vec![0.5]],
            weights: vec![1.0],
            acceleration_square: Vec::new(),
            velocity_square: Vec::new(),
        };
        assert_eq!(extremes(&measure, &Domain::Tube(motion.clone(), vec![0.0])), measure.points);
        assert_eq!(extremes(&measure, &Domain::Path(motion)), measure.points);
    }
}
