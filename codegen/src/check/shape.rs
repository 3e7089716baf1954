//! Lists that need one entry for each joint.

use crate::error::Diagnostics;
use crate::number::scientific;
use crate::spec::VectorSpec;
use crate::text::has;

/// A fault where a list has not one entry for each of `joints`; true where it has, or the number is unknown.
pub(super) fn length(field: &str, found: usize, joints: Option<usize>, faults: &mut Diagnostics) -> bool {
    match joints {
        Some(n) if found != n => {
            faults.push(field, has(found), format!("write {n}, one for each joint"));
            false
        }
        _ => true,
    }
}

/// Faults where a scalar or list has the wrong length or entries that are not `good`; `wanted` says what is.
pub(super) fn entries(
    field: &str,
    spec: &VectorSpec,
    joints: Option<usize>,
    good: impl Fn(f64) -> bool,
    wanted: &str,
    faults: &mut Diagnostics,
) {
    match spec {
        VectorSpec::Scalar(value) if !good(*value) => {
            faults.push(field, format!("is {}", scientific(*value)), format!("write {wanted}"));
        }
        VectorSpec::Scalar(_) => {}
        VectorSpec::List(list) => {
            length(field, list.len(), joints, faults);
            for (i, value) in list.iter().enumerate().filter(|(_, v)| !good(**v)) {
                faults.push(
                    format!("{field}[{i}]"),
                    format!("is {}", scientific(*value)),
                    format!("write {wanted}"),
                );
            }
        }
    }
}
