//! Numbers as people read them, in messages, documentation and tables.

/// What stands where there is no number.
const NONE: &str = "not available";

/// `x` with four significant digits; powers of ten only where the number would run long.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        NONE.to_string()
    } else if x == 0.0 {
        "0".to_string()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{x:.3e}")
    } else {
        let whole = [1.0, 10.0, 100.0, 1000.0].iter().filter(|&&power| size >= power).count();
        let leading_zeros = [0.1, 0.01].iter().filter(|&&power| size < power).count();
        format!("{x:.*}", 4 - whole + leading_zeros)
    }
}

/// A percentage `x` ≥ 0 with four significant digits and without powers of ten, such as `56.67 %`. A very small one is
/// only said to be small.
pub fn percent(x: f64) -> String {
    if !x.is_finite() {
        NONE.to_string()
    } else if x > 0.0 && x < 1e-3 {
        "less than 0.001 %".to_string()
    } else if x >= 1e5 {
        "more than 100000 %".to_string()
    } else {
        let digits = short(x);
        let digits =
            if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
        format!("{digits} %")
    }
}

/// `x` with so many decimals; powers of ten where the number would run long.
pub fn decimal(x: f64, decimals: usize) -> String {
    if x.is_infinite() {
        "without bound".to_string()
    } else if x.abs() < 1e7 {
        format!("{x:.decimals$}")
    } else {
        short(x)
    }
}

/// The smallest f32 that is not below `x`.
pub fn single_up(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}

/// The largest f32 that is not above `x`.
pub fn single_down(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// `x` as a file would give it: every digit, powers of ten where the number would run long otherwise.
pub fn scientific(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        NONE.to_string()
    } else if x == 0.0 || (1e-5..1e10).contains(&size) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_runs_long() {
        let cases = [
            (0.0, "0"),
            (0.01, "0.01"),
            (1e-9, "1e-9"),
            (-2500.0, "-2500"),
            (1e300, "1e300"),
            (-1.25e-310, "-1.25e-310"),
            (f64::INFINITY, "not available"),
        ];
        for (x, text) in cases {
            assert_eq!(scientific(x), text);
        }
        let decimals =
            [(1.5, "1.500"), (-1234.5, "-1234.500"), (1e300, "1.000e300"), (f64::INFINITY, "without bound")];
        for (x, text) in decimals {
            assert_eq!(decimal(x, 3), text);
        }
    }

    #[test]
    fn numbers_have_four_digits() {
        let cases = [
            (0.0, "0"),
            (0.06997, "0.06997"),
            (0.5, "0.5000"),
            (-12.345, "-12.35"),
            (1963.2, "1963"),
            (1.2e-5, "1.200e-5"),
            (2e7, "2.000e7"),
            (f64::INFINITY, "not available"),
            (f64::NAN, "not available"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn percentages_are_plain() {
        let cases = [
            (0.0, "0 %"),
            (1e-9, "less than 0.001 %"),
            (0.0125, "0.0125 %"),
            (1.0, "1 %"),
            (56.67, "56.67 %"),
            (100.0, "100 %"),
            (2.5e7, "more than 100000 %"),
            (f64::INFINITY, "not available"),
            (f64::NAN, "not available"),
        ];
        for (x, text) in cases {
            assert_eq!(percent(x), text);
        }
    }
}
