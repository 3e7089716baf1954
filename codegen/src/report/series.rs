//! Curves, cut down to what a plot can show, and the ticks beside them.

/// Most points of a curve: beyond it a plot 600 units wide gains nothing.
const MOST_POINTS: usize = 1200;

/// The points (x, y) that can be drawn; of a long curve the extremes of each stretch, so that no peak is lost.
pub(super) fn curve(x: &[f64], y: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    curve_of(x, y, MOST_POINTS)
}

/// The same with `most` points.
pub(super) fn curve_of(x: &[f64], y: impl Iterator<Item = f64>, most: usize) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = x.iter().copied().zip(y).filter(|(_, y)| y.is_finite()).collect();
    if points.len() <= most {
        return points;
    }
    let stretch = points.len().div_ceil(most / 2);
    let mut out = Vec::with_capacity(most);
    for stretch in points.chunks(stretch) {
        let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        if let (Some(&low), Some(&high)) =
            (stretch.iter().min_by(by_height), stretch.iter().max_by(by_height))
        {
            let (first, second) = if low.0 <= high.0 { (low, high) } else { (high, low) };
            out.push(first);
            if second != first {
                out.push(second);
            }
        }
    }
    out
}

/// An interval that holds every height with a margin of 6 %, never empty.
pub(super) fn range<'a>(points: impl Iterator<Item = &'a (f64, f64)>) -> (f64, f64) {
    let (low, high) =
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.1), high.max(p.1)));
    if low > high {
        return (-1.0, 1.0);
    }
    let span = high - low;
    let margin = if span > 0.0 && span.is_finite() { 0.06 * span } else { 0.5 * high.abs().max(1e-3) };
    (low - margin, high + margin)
}

/// A tick's number with as many decimals as an axis of length `span` needs.
pub(super) fn tick(value: f64, span: f64) -> String {
    if value.abs() < 1e-9 * span {
        return "0".to_string();
    }
    if !(2e-3..1e6).contains(&span) {
        return format!("{value:.1e}");
    }
    let decimals = [10.0, 1.0, 0.1, 0.01].iter().filter(|&&limit| span <= limit).count();
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_extremes() {
        let x: Vec<f64> = (0..100_000).map(f64::from).collect();
        let y = |k: f64| if k == 31_415.0 { 9.0 } else { (k % 7.0) / 7.0 };
        let thin = curve(&x, x.iter().map(|&k| y(k)));
        assert!(thin.len() <= MOST_POINTS);
        assert!(thin.contains(&(31_415.0, 9.0)));
        assert!(thin.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(curve(&[0.0, 1.0], [f64::NAN, 2.0].into_iter()), [(1.0, 2.0)]);
    }

    #[test]
    fn ranges_are_never_empty() {
        assert_eq!(range([].iter()), (-1.0, 1.0));
        let (low, high) = range([(0.0, 3.0), (1.0, 3.0)].iter());
        assert!(low < 3.0 && high > 3.0);
        let (low, high) = range([(0.0, 0.0)].iter());
        assert!(low < 0.0 && high > 0.0);
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!(tick(-1e-17, 0.2), "0");
        assert_eq!(tick(0.05, 0.2), "0.05");
        assert_eq!(tick(0.1, 0.1), "0.100");
        assert_eq!(tick(-20.0, 90.0), "-20");
        assert_eq!(tick(2.5, 5.0), "2.5");
        assert_eq!(tick(3e-7, 1e-6), "3.0e-7");
    }
}
