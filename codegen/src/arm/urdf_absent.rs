//! What stands in for the reading of URDF files where the feature `urdf` is off.

use super::Arm;
use crate::error::Diagnostics;
use crate::load::Named;
use crate::spec::ArmSpec;

/// Refuses the file `named`.
pub(super) fn build(
    _: &ArmSpec,
    _: f64,
    named: &Named,
    faults: &mut Diagnostics,
    _: &mut Vec<String>,
) -> Option<Arm> {
    faults.push(
        "arm.urdf",
        format!("names {:?}, and this build of gramforge does not read URDF files", named.name),
        "turn on the feature `urdf` of the crate gramforge, or describe the arm by a DH table",
    );
    None
}
