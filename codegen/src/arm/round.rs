//! Rounding of whole rotations.
//!
//! Files write right angles with few digits, and products of rotations leave entries of 1e-17 where zeros belong. An
//! entry that is rounded by itself makes a matrix that is no rotation, and loses what the other entries still say. So a
//! rotation is replaced as a whole, by the nearest one with more exact zeros, or it stays as it is.

use super::body::Matrix;

/// What products of rotations leave behind, rad: a rotation nearer than this to a simpler one is taken to be that.
pub(crate) const NOISE: f64 = 4e-15;

/// The rotation with most exact zeros among those that `r` reaches by a turn of `angle` rad or less; `r` itself where
/// there is none.
///
/// Simpler rotations are, in this order: the 24 that take coordinate axes to coordinate axes; those that take one
/// coordinate axis to another; those that keep one axis square to another.
pub(super) fn rounded(r: &Matrix, angle: f64) -> Matrix {
    let near = |simple: &Matrix| distance(r, simple) <= angle;
    let candidates = [right, about_axis, square];
    candidates.iter().filter_map(|simpler| simpler(r)).find(near).unwrap_or(*r)
}

/// The angle between two rotations that are near each other, rad: 2√2 sin(angle/2) is the norm of their difference.
pub(crate) fn distance(a: &Matrix, b: &Matrix) -> f64 {
    let entries = a.iter().flatten().zip(b.iter().flatten());
    libm::sqrt(0.5 * entries.map(|(a, b)| (a - b) * (a - b)).sum::<f64>())
}

/// The rotation that takes each axis to the coordinate axis nearest to it; `None` where two go to the same.
fn right(r: &Matrix) -> Option<Matrix> {
    let mut out = [[0.0; 3]; 3];
    let mut taken = [false; 3];
    for (row, entries) in out.iter_mut().zip(r) {
        let column = largest(entries);
        if std::mem::replace(&mut taken[column], true) {
            return None;
        }
        row[column] = 1.0_f64.copysign(entries[column]);
    }
    Some(out)
}

/// The rotation whose largest entry is ±1.
fn about_axis(r: &Matrix) -> Option<Matrix> {
    let (i, j) = extreme(r, |a, b| a > b);
    let (k, l) = ((i + 1) % 3, (i + 2) % 3);
    let (m, n) = ((j + 1) % 3, (j + 2) % 3);
    let off = [r[i][m], r[i][n], r[k][j], r[l][j]];
    if off.iter().all(|entry| *entry == 0.0) {
        return None;
    }
    let along = 1.0_f64.copysign(r[i][j]);
    // What is left is a turn in the plane: with indices in cyclic order its determinant is that of the axis.
    let cos = r[k][m] + along * r[l][n];
    let sin = along * r[l][m] - r[k][n];
    let norm = libm::hypot(cos, sin);
    let (cos, sin) = (cos / norm, sin / norm);
    let mut out = [[0.0; 3]; 3];
    out[i][j] = along;
    (out[k][m], out[k][n], out[l][m], out[l][n]) = (cos, 0.0 - sin, along * sin, along * cos);
    Some(out)
}

/// The rotation whose smallest entry is 0: two rows are turned into each other until it is.
fn square(r: &Matrix) -> Option<Matrix> {
    let (i, j) = extreme(r, |a, b| a < b);
    if r[i][j] == 0.0 {
        return None;
    }
    let (k, l) = ((i + 1) % 3, (i + 2) % 3);
    let with = if r[k][j].abs() >= r[l][j].abs() { k } else { l };
    let norm = libm::hypot(r[i][j], r[with][j]);
    let (cos, sin) = (r[with][j] / norm, r[i][j] / norm);
    let mut out = *r;
    for column in 0..3 {
        out[i][column] = cos * r[i][column] - sin * r[with][column];
        out[with][column] = cos * r[with][column] + sin * r[i][column];
    }
    out[i][j] = 0.0;
    // The turn by π beside the small one.
    if cos < 0.0 {
        for row in [i, with] {
            out[row] = out[row].map(|entry| 0.0 - entry);
        }
    }
    Some(out)
}

fn largest(entries: &[f64; 3]) -> usize {
    let better = |best: usize, at: usize| if entries[at].abs() > entries[best].abs() { at } else { best };
    (1..3).fold(0, better)
}

/// The first entry whose magnitude no other is `better` than.
fn extreme(r: &Matrix, better: impl Fn(f64, f64) -> bool) -> (usize, usize) {
    let all = (0..9).map(|at| (at / 3, at % 3));
    all.fold((0, 0), |best, at| if better(r[at.0][at.1].abs(), r[best.0][best.1].abs()) { at } else { best })
}

#[cfg(test)]
mod tests {
    use super::super::Transform;
    use super::*;

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    fn turn(axis: usize, angle: f64) -> Matrix {
        Transform::rotation(axis, angle).rotation
    }

    fn assert_rotation(r: &Matrix) {
        let transposed: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]));
        let identity = turn(0, 0.0);
        assert!(distance(&product(r, &transposed), &identity) < 1e-15, "{r:?}");
        let det: f64 = (0..3)
            .map(|i| {
                r[0][i] * (r[1][(i + 1) % 3] * r[2][(i + 2) % 3] - r[1][(i + 2) % 3] * r[2][(i + 1) % 3])
            })
            .sum();
        assert!((det - 1.0).abs() < 1e-14, "{r:?}");
    }

    fn zeros(r: &Matrix) -> usize {
        r.iter().flatten().filter(|entry| **entry == 0.0).count()
    }

    #[test]
    fn a_rotation_is_rounded_as_a_whole_or_not_at_all() {
        let axes = || (0..3).flat_map(|a| (0..3).map(move |b| (a, b)));
        for (a, b) in axes().filter(|(a, b)| a != b) {
            for quarters in 0..16 {
                let right = product(
                    &turn(a, std::f64::consts::FRAC_PI_2 * f64::from(quarters % 4)),
                    &turn(b, std::f64::consts::FRAC_PI_2 * f64::from(quarters / 4)),
                );
                assert_eq!(zeros(&right), 6, "right angles are exact");
                for (simple, count) in [
                    (right, 6),
                    (product(&right, &turn(a, 0.4)), 4),
                    (product(&turn(b, -1.1), &right), 4),
                    (product(&product(&turn(a, 0.3), &right), &turn(b, 0.7)), 1),
                ] {
                    // The last one may be a turn about one axis.
                    if zeros(&simple) < count {
                        continue;
                    }
                    let count = zeros(&simple);
                    for off in [1e-12, 3e-9, 2e-6, 1e-3] {
                        let tilt =
                            product(&turn(0, off), &product(&turn(1, -0.6 * off), &turn(2, 0.3 * off)));
                        let near = product(&tilt, &simple);
                        let found = rounded(&near, 2.0 * off);
                        assert_rotation(&found);
                        assert_eq!(zeros(&found), count, "{simple:?} {off:e}");
                        assert!(distance(&near, &found) <= 2.0 * off);
                        assert_eq!(rounded(&near, 1e-3 * off), near, "nothing that near");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_simple_keeps_its_bits() {
        for r in [turn(0, 0.3), turn(1, -2.0), product(&turn(2, 0.3), &turn(0, 1.1))] {
            assert_eq!(rounded(&r, NOISE), r);
        }
    }
}
