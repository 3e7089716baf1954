//! Whether numbers can belong to a rigid body.

use nalgebra::Matrix3;

use super::Body;
use super::body::{Matrix, matrix};
use super::place::Place;
use crate::error::Diagnostics;
use crate::spec::PayloadSpec;

/// Relative size below which a negative moment passes for rounding of printed tables.
const SLACK: f64 = 1e-9;

/// Density of the densest matter (osmium), kg/m³: a body of mass m has moments of some m (m/ρ)^⅔ at least, so that what
/// is far below is rounding, even where a file writes a point mass.
const DENSEST: f64 = 22_590.0;

/// Rounding of Σ − m c cᵀ relative to Σ.
const CANCELLATION: f64 = 1e-12;

/// Checks a body as given, in whatever frame: mass ≥ 0, no first moment without mass, inertia about the centre of
/// mass positive semidefinite; a broken triangle inequality is a warning, for published tables break it.
///
/// `inertia` is the place from which the inertia comes, `place` that of the whole body.
pub(super) fn body(
    body: &Body,
    inertia: &Place,
    place: &Place,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) {
    if !body.is_finite() {
        place.fault(
            faults,
            "has inertial data that are not finite or overflow",
            "write finite numbers in SI units",
        );
        return;
    }
    if place.at("mass").not_negative(body.mass, "kg", faults).is_none() {
        return;
    }
    if body.mass == 0.0 && body.first_moment != [0.0; 3] {
        let problem = format!("is {:?} although the mass is 0", body.first_moment);
        place.at("first_moment").fault(faults, problem, "write the mass, or a first moment of zero");
        return;
    }
    let tensor = body.inertia_at_com();
    let size = libm::cbrt(body.mass / DENSEST);
    let scale = largest(&tensor) + body.mass * size * size;
    let slack = SLACK * scale + CANCELLATION * largest(&body.pseudo_inertia);
    let moments = principal_moments(&tensor);
    if moments[0] < -slack {
        let problem = format!("gives the principal moment {:.6e} kg·m² about the centre of mass", moments[0]);
        let help = "write an inertia without negative moments; check signs, units and the point it refers to";
        inertia.fault(faults, problem, help);
    } else if moments[2] > moments[0] + moments[1] + slack {
        let moments = moments.map(|moment| if moment.abs() <= slack { 0.0 } else { moment });
        let [first, second, third] = moments.map(moment);
        let what = format!(
            "the principal moments {first}, {second}, {third} kg·m² break the triangle inequality; \
             no rigid body has them, they are used as given"
        );
        inertia.warn(warnings, &what);
    }
}

/// The body of a payload, in the tip frame, after its checks.
pub(super) fn payload(
    spec: &PayloadSpec,
    place: &Place,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Body {
    let inertia = spec.inertia.as_ref().map_or([[0.0; 3]; 3], matrix);
    let out = Body::from_com(spec.mass, spec.com, inertia);
    body(&out, &place.at("inertia"), place, faults, warnings);
    out
}

/// A moment in words: six decimals, or four digits where these would hide it or run long.
fn moment(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_string(),
        1e-3..1e6 => format!("{x:.6}"),
        _ => format!("{x:.3e}"),
    }
}

fn largest(m: &Matrix) -> f64 {
    m.iter().flatten().fold(0.0, |most, v| v.abs().max(most))
}

/// Eigenvalues in rising order; the entries must be finite.
fn principal_moments(tensor: &Matrix) -> [f64; 3] {
    let values = Matrix3::from_fn(|i, j| tensor[i][j]).symmetric_eigenvalues();
    let mut out = [values[0], values[1], values[2]];
    out.sort_by(f64::total_cmp);
    out
}
