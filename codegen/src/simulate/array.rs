//! From vectors whose length is known at run time to the runtime's arrays.

use crate::error::Error;

/// `values` as an array.
///
/// # Errors
/// [`Error::Internal`] where the length is not `N`; every stage before hands over one entry a joint.
pub(super) fn vector<T: Copy, const N: usize>(what: &str, values: &[T]) -> Result<[T; N], Error> {
    values
        .try_into()
        .map_err(|_| Error::Internal(format!("{what} has {} entries for {N} joints", values.len())))
}

/// `rows` as a square array.
///
/// # Errors
/// As [`vector`].
pub(super) fn matrix<const N: usize>(what: &str, rows: &[Vec<f64>]) -> Result<[[f64; N]; N], Error> {
    let rows: Vec<[f64; N]> = rows.iter().map(|row| vector(what, row)).collect::<Result<_, _>>()?;
    vector(what, &rows)
}

/// `layers` as a cubic array.
///
/// # Errors
/// As [`vector`].
pub(super) fn cube<const N: usize>(
    what: &str,
    layers: &[Vec<Vec<f64>>],
) -> Result<[[[f64; N]; N]; N], Error> {
    let layers: Vec<[[f64; N]; N]> =
        layers.iter().map(|rows| matrix(what, rows)).collect::<Result<_, _>>()?;
    vector(what, &layers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converts_what_fits_and_refuses_the_rest() {
        let rows = vec![vec![1.0, 2.0], vec![3.0, 4.0]];
        assert_eq!(matrix::<2>("m", &rows).unwrap(), [[1.0, 2.0], [3.0, 4.0]]);
        assert_eq!(cube::<2>("h", &[rows.clone(), rows.clone()]).unwrap()[1][1], [3.0, 4.0]);
        assert!(matches!(matrix::<3>("m", &rows), Err(Error::Internal(_))));
        assert!(matches!(matrix::<2>("m", &[vec![1.0], vec![2.0, 3.0]]), Err(Error::Internal(_))));
    }
}
