//! Long curves, cut down to what a panel can show.

use crate::report::series::curve_of;

/// Most points of a curve in a panel.
const MOST: usize = 260;

/// The points that can be drawn: of each stretch of a long curve the lowest and the highest.
pub(super) fn thinned(x: &[f64], y: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    curve_of(x, y, MOST)
}

/// Of a bound over time the largest of each stretch, drawn as a level that lasts for the stretch: never below the bound.
pub(super) fn steps(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = points.collect();
    if points.len() <= MOST {
        return points;
    }
    let stretch = points.len().div_ceil(MOST / 2);
    let level = |stretch: &[(f64, f64)]| {
        let most = stretch.iter().fold(0.0_f64, |most, point| most.max(point.1));
        let [from, to] = [stretch.first(), stretch.last()].map(|point| point.map_or(0.0, |point| point.0));
        [(from, most), (to, most)]
    };
    points.chunks(stretch).flat_map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_bound_is_never_below_the_bound() {
        let bound = |k: u32| libm::exp(-0.01 * f64::from(k)) * (1.0 + 0.5 * libm::sin(f64::from(k)));
        let points: Vec<(f64, f64)> = (0..4000).map(|k| (f64::from(k), bound(k))).collect();
        let levels = steps(points.iter().copied());
        assert!(levels.len() <= MOST);
        for (x, y) in points {
            let pair = levels.chunks(2).find(|pair| pair[0].0 <= x && x <= pair[1].0).unwrap();
            assert!(pair[0].1 >= y && pair[1].1 == pair[0].1, "{x}");
        }
    }
}
