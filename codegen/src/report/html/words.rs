//! Numbers for people: three digits, a unit, and a bound never on the wrong side.

use crate::arm::{Joint, JointKind};
use crate::bounds::down;
use crate::number::short;

/// A length or an angle with its unit: `20.3 mrad`, `1.57 rad`, `0.27 mm`. `up` for a bound: never below.
pub(super) fn position(x: f64, kind: JointKind, up: bool) -> String {
    let (whole, part) = match kind {
        JointKind::Revolute => ("rad", "mrad"),
        JointKind::Prismatic => ("m", "mm"),
    };
    let most = if kind == JointKind::Prismatic { 1.0 } else { 0.1 };
    if x == 0.0 {
        return format!("0 {whole}");
    }
    if x.abs() < most {
        format!("{} {part}", three(1e3 * x, up))
    } else {
        format!("{} {whole}", three(x, up))
    }
}

/// The largest of `errors` by joint, rad or m, with its unit and never below; that of each kind where the arm has both kinds.
pub(crate) fn worst(joints: &[Joint], errors: &[f64]) -> String {
    let of = |kind: JointKind| {
        let own = joints.iter().zip(errors).filter(|(joint, _)| joint.kind == kind).map(|(_, error)| *error);
        own.fold(None, |most: Option<f64>, error| Some(most.map_or(error, |most| most.max(error))))
            .map(|most| position(most, kind, true))
    };
    let kinds = [of(JointKind::Revolute), of(JointKind::Prismatic)];
    kinds.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

/// A time with its unit: `1 ms`, `2.35 s`.
pub(super) fn time(x: f64) -> String {
    if x != 0.0 && x.abs() < 0.1 { format!("{} ms", plain(1e3 * x)) } else { format!("{} s", plain(x)) }
}

/// The same, never later than `x`.
pub(super) fn time_down(x: f64) -> String {
    time(down(x, 3))
}

/// The same, never earlier than `x`.
pub(super) fn time_up(x: f64) -> String {
    if x != 0.0 && x.abs() < 0.1 {
        format!("{} ms", trimmed(three(1e3 * x, true)))
    } else {
        format!("{} s", trimmed(three(x, true)))
    }
}

/// A fraction as a percentage of three digits; `up` for a bound: never below.
pub(super) fn percent(fraction: f64, up: bool) -> String {
    if !fraction.is_finite() {
        return "no percentage".to_string();
    }
    let percent = 100.0 * fraction;
    if percent > 0.0 && percent < 1e-3 {
        "below 0.001 %".to_string()
    } else {
        format!("{} %", three(percent, up))
    }
}

/// `x` with three digits and no zeros at its end.
pub(super) fn plain(x: f64) -> String {
    trimmed(three(x, false))
}

/// `x` with three digits, never below it where `up`.
pub(super) fn three(x: f64, up: bool) -> String {
    if x == 0.0 {
        return "0".to_string();
    }
    if !x.is_finite() {
        return short(x);
    }
    let size = x.abs();
    let rounded = |size: f64| -> f64 { format!("{size:.2e}").parse().unwrap_or(size) };
    let mut shown = rounded(size);
    if up && shown < size {
        // One more in the last digit.
        let exponent = libm::floor(libm::log10(size));
        shown = rounded(shown + 1.0001 * libm::pow(10.0, exponent - 2.0));
    }
    let sign = if x < 0.0 { "−" } else { "" };
    if !(1e-3..1e5).contains(&shown) {
        return format!("{sign}{shown:.2e}");
    }
    let decimals = match shown {
        shown if shown >= 100.0 => 0,
        shown if shown >= 10.0 => 1,
        shown if shown >= 1.0 => 2,
        shown if shown >= 0.1 => 3,
        shown if shown >= 0.01 => 4,
        _ => 5,
    };
    format!("{sign}{shown:.decimals$}")
}

fn trimmed(digits: String) -> String {
    if !digits.contains('.') || digits.contains('e') {
        return digits;
    }
    digits.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// `count` of a thing: `1 run`, `2 runs`.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_and_a_unit() {
        let (turn, slide) = (JointKind::Revolute, JointKind::Prismatic);
        assert_eq!(position(0.020_251, turn, false), "20.3 mrad");
        assert_eq!(position(0.020_201, turn, true), "20.3 mrad");
        assert_eq!(position(1.6308, turn, false), "1.63 rad");
        assert_eq!(position(2.7e-4, slide, false), "0.270 mm");
        assert_eq!(position(0.0, slide, true), "0 m");
        assert_eq!((time(0.001), time(3.0)), ("1 ms".to_string(), "3 s".to_string()));
        assert_eq!((time_down(4.1079e-3), time_up(0.8371)), ("4.1 ms".to_string(), "0.838 s".to_string()));
        assert_eq!(percent(0.5667, false), "56.7 %");
        assert_eq!(percent(1e-9, true), "below 0.001 %");
        assert_eq!((three(-1234.0, false), plain(1e-9)), ("−1230".to_string(), "1.00e-9".to_string()));
        assert_eq!(counted(1, "run") + &counted(2, "run"), "1 run2 runs");
    }

    #[test]
    fn a_bound_is_never_shown_smaller() {
        let mut x = 1e-3;
        while x < 9e4 {
            let shown: f64 = three(x, true).parse().unwrap();
            assert!(shown >= x && shown <= 1.011 * x, "{x} {shown}");
            x *= 1.0137;
        }
        assert_eq!(three(99.91, true), "100");
    }
}
