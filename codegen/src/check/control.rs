//! Gains and the other numbers of the control law.

use nalgebra::DMatrix;

use super::shape::entries;
use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::{ControlSpec, CoriolisTermSpec, LawSpec, MatrixSpec, RobustGainSpec};
use crate::text::has;

/// Rounding that passes for symmetry or for zero, relative to the largest entry.
const SLACK: f64 = 1e-9;

/// Checks period, boundary layer, initial errors, and the gains: W, Pqq, Ω symmetric positive definite, P12 = Pqq⁻¹Ω
/// symmetric and element-wise nonnegative.
pub(super) fn check(control: &ControlSpec, joints: Option<usize>, faults: &mut Diagnostics) {
    if let Some(period) = control.period.filter(|period| *period <= 0.0) {
        faults.push("control.period", format!("is {}", scientific(period)), "write a number above 0, in s");
    }
    if let Some(layer) = &control.boundary_layer {
        let wanted = "a number above 0, or leave the field out for the sign function";
        entries("control.boundary_layer", layer, joints, |v| v > 0.0, wanted, faults);
    }
    let initial = &control.initial_error;
    let wanted = "a number of at least 0";
    let (position, velocity) = ("control.initial_error.position", "control.initial_error.velocity");
    entries(position, &initial.position, joints, |v| v >= 0.0, wanted, faults);
    entries(velocity, &initial.velocity, joints, |v| v >= 0.0, wanted, faults);
    if let Some(settle) = control.settle.filter(|settle| *settle < 0.0) {
        let help = "write a number of at least 0, in s, or leave the field out";
        faults.push("control.settle", format!("is {}", scientific(settle)), help);
    }
    delta_c1(control, joints, faults);
    robust_gain(control, faults);
    adaptation(control, faults);
    let mut gain = |field, spec: &Option<MatrixSpec>| {
        spec.as_ref().and_then(|spec| definite(field, spec, joints, faults))
    };
    gain("control.W", &control.w);
    let pqq = gain("control.Pqq", &control.pqq);
    let omega = gain("control.Omega", &control.omega);
    if let (Some(pqq), Some(omega)) = (pqq, omega) {
        p12(pqq, &omega, faults);
    }
}

/// ΔC1 has its place in one variant of one law; whether it is large enough takes the bounds to see.
fn delta_c1(control: &ControlSpec, joints: Option<usize>, faults: &mut Diagnostics) {
    if !control.law.has_bracket() && control.coriolis_term != CoriolisTermSpec::Matrix {
        let help = "remove it, or choose law `report`";
        faults.push("control.coriolis_term", "applies only to the laws `report` and `adaptive`", help);
    }
    let Some(spec) = &control.delta_c1 else { return };
    if !control.law.has_bracket() || control.coriolis_term != CoriolisTermSpec::Matrix {
        let help = "remove it, or choose law `report` with `coriolis_term` `matrix`";
        faults.push("control.delta_c1", "is not used by this law", help);
    }
    square("control.delta_c1", spec, joints, faults);
}

/// A constant gain replaces the bracket and ΔC1.
fn robust_gain(control: &ControlSpec, faults: &mut Diagnostics) {
    if control.robust_gain != RobustGainSpec::Constant {
        return;
    }
    if !control.law.has_choice() {
        let help = "remove it, or choose law `report` or `tight`";
        faults.push("control.robust_gain", "`constant` goes with the laws `report` and `tight` alone", help);
    } else if control.delta_c1.is_some() || control.coriolis_term != CoriolisTermSpec::Matrix {
        let help = "remove `delta_c1` and `coriolis_term`, or write `state`";
        faults.push(
            "control.robust_gain",
            "`constant` replaces what `delta_c1` and `coriolis_term` belong to",
            help,
        );
    }
}

/// What is to be learnt takes the intervals that it lies in, and a law that learns.
fn adaptation(control: &ControlSpec, faults: &mut Diagnostics) {
    if control.law == LawSpec::Adaptive && control.uncertainty.is_none() {
        faults.push(
            "control.uncertainty",
            "is missing, so law `adaptive` has nothing to learn",
            "write the intervals of the uncertain numbers, or take law `report` or `tight`",
        );
    }
    let Some(adaptation) = &control.adaptation else { return };
    if control.law != LawSpec::Adaptive {
        faults.push(
            "control.adaptation",
            "applies only to law `adaptive`",
            "remove it, or choose law `adaptive`",
        );
    }
    let field = "control.adaptation.Ptheta";
    entries(field, &adaptation.p_theta, None, |v| v > 0.0, "a number above 0", faults);
}

/// The matrix of a gain, if it is symmetric positive definite and of the right size.
fn definite(
    field: &str,
    spec: &MatrixSpec,
    joints: Option<usize>,
    faults: &mut Diagnostics,
) -> Option<DMatrix<f64>> {
    let wanted =
        "write a positive number, a list of positive numbers or a symmetric positive definite matrix";
    match spec {
        MatrixSpec::Scalar(value) if *value <= 0.0 => {
            faults.push(field, format!("is {}", scientific(*value)), wanted);
            return None;
        }
        MatrixSpec::Diagonal(list) if list.iter().any(|v| *v <= 0.0) => {
            for (i, value) in list.iter().enumerate().filter(|(_, v)| **v <= 0.0) {
                faults.push(
                    format!("{field}[{i}]"),
                    format!("is {}", scientific(*value)),
                    "write a positive number",
                );
            }
            return None;
        }
        _ => {}
    }
    let matrix = square(field, spec, joints, faults)?;
    if matrix.clone().cholesky().is_none() {
        faults.push(field, format!("is {}, which is not positive definite", show(&matrix)), wanted);
        return None;
    }
    Some(matrix)
}

/// The matrix, if it is symmetric and of the right size.
fn square(
    field: &str,
    spec: &MatrixSpec,
    joints: Option<usize>,
    faults: &mut Diagnostics,
) -> Option<DMatrix<f64>> {
    let n = joints?;
    let Some(rows) = spec.by_rows(n) else {
        let found = match spec {
            MatrixSpec::Full(rows) => {
                let widths: Vec<usize> = rows.iter().map(Vec::len).collect();
                format!("has {} rows of {widths:?} entries", rows.len())
            }
            MatrixSpec::Diagonal(list) => has(list.len()),
            MatrixSpec::Scalar(_) => String::new(),
        };
        faults.push(field, found, format!("write one number, {n} numbers or {n} rows of {n} numbers"));
        return None;
    };
    let matrix = DMatrix::from_fn(n, n, |i, j| rows.get(i).and_then(|r| r.get(j)).copied().unwrap_or(0.0));
    if let Some((i, j)) = asymmetry(&matrix) {
        let problem = format!("is not symmetric: {} and {}", matrix[(i, j)], matrix[(j, i)]);
        faults.push(
            format!("{field}[{i}][{j}]"),
            problem,
            "write the same number on both sides of the diagonal",
        );
        return None;
    }
    Some(matrix)
}

fn show(matrix: &DMatrix<f64>) -> String {
    let row = |i: usize| matrix.row(i).iter().copied().collect::<Vec<f64>>();
    format!("{:?}", (0..matrix.nrows()).map(row).collect::<Vec<_>>())
}

/// The first pair of entries that differ across the diagonal.
fn asymmetry(matrix: &DMatrix<f64>) -> Option<(usize, usize)> {
    let slack = SLACK * matrix.amax();
    let n = matrix.nrows();
    let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.find(|&(i, j)| (matrix[(i, j)] - matrix[(j, i)]).abs() > slack)
}

fn p12(pqq: DMatrix<f64>, omega: &DMatrix<f64>, faults: &mut Diagnostics) {
    let Some(factor) = pqq.cholesky() else { return };
    let p12 = factor.solve(omega);
    if let Some((i, j)) = asymmetry(&p12) {
        faults.push(
            "control.Omega",
            format!("gives a P12 = Pqq⁻¹Ω that is not symmetric: {} and {}", p12[(i, j)], p12[(j, i)]),
            "choose Pqq and Omega that commute, such as Omega as a multiple of Pqq, or one of them as a number",
        );
        return;
    }
    let slack = SLACK * p12.amax();
    let n = p12.nrows();
    let negative = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).find(|&at| p12[at] < -slack);
    if let Some((i, j)) = negative {
        faults.push(
            "control.Omega",
            format!("gives P12 = Pqq⁻¹Ω the negative entry {} at row {i}, column {j}", p12[(i, j)]),
            "choose Pqq and Omega so that every entry of P12 is at least 0, such as diagonal ones",
        );
    }
}
