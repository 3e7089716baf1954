//! Arms from Denavit–Hartenberg tables, standard and modified.

use std::path::Path;

use super::body::matrix;
use super::drive::{drive, of_link};
use super::place::Place;
use super::{Arm, Body, GRAVITY, Joint, JointKind, MOST_JOINTS, Transform, validate};
use crate::error::Diagnostics;
use crate::spec::{Convention, DhSpec, LinkSpec};

/// The arm of `table`, which stands in the specification `file`, its rotations rounded by up to `angle` rad; `None` where a link's inertial data are incomplete.
///
/// With T = Rz(θ)Tz(d)Tx(a)Rx(α) the joint stands before what moves with it, so a link frame of the standard
/// convention is the joint's moved frame followed by the rest of T; with Craig's they are the same.
pub(super) fn build(
    table: &DhSpec,
    angle: f64,
    file: &Path,
    faults: &mut Diagnostics,
    warnings: &mut Vec<String>,
) -> Option<Arm> {
    let count = table.links.len();
    if count == 0 || count > MOST_JOINTS {
        let help = format!("write 1 to {MOST_JOINTS} links");
        faults.push("arm.dh.links", format!("has {count} links"), help);
        return None;
    }
    let mut joints = Vec::with_capacity(count);
    let mut complete = true;
    // The frame that the next joint's own numbers start from, in the moved frame of the joint before.
    let mut from = Transform::IDENTITY;
    for (index, link) in table.links.iter().enumerate() {
        let place = Place::new(file, format!("arm.dh.links[{index}]"));
        let (before, after) = around(table.convention, link, angle);
        let body = body(link, &place, faults);
        if let Some((body, field)) = &body {
            validate::body(body, &place.at(field), &place, faults, warnings);
        }
        complete &= body.is_some();
        let drive = drive(&of_link(link), link.joint, &place, faults);
        joints.push(Joint {
            name: format!("joint{}", index + 1),
            kind: link.joint,
            pose: from.then(&before).rounded(angle),
            body: body.unwrap_or_default().0.moved(&after),
            link: after,
            armature: drive.armature.unwrap_or(0.0),
            viscous_friction: drive.viscous_friction.unwrap_or(0.0),
            coulomb_friction: drive.coulomb_friction.unwrap_or([0.0; 2]),
            limits: drive.limits,
        });
        from = after;
    }
    complete.then_some(Arm { gravity: GRAVITY, joints, tip: from, linkage: None })
}

/// What stands before the motion and what after it in a link's transform.
fn around(convention: Convention, link: &LinkSpec, round: f64) -> (Transform, Transform) {
    let twist = Transform::rotation(0, link.alpha).rounded(round);
    let length = Transform::translation([link.a, 0.0, 0.0]);
    let offset = Transform::translation([0.0, 0.0, link.d]);
    let angle = Transform::rotation(2, link.theta).rounded(round);
    // Rz and Tz commute, so both constants may stand before the motion; a standard revolute joint keeps d after it,
    // where the frames of published tables are.
    match (convention, link.joint) {
        (Convention::Standard, JointKind::Revolute) => (angle, offset.then(&length).then(&twist)),
        (Convention::Standard, JointKind::Prismatic) => (angle.then(&offset), length.then(&twist)),
        (Convention::Modified, _) => (twist.then(&length).then(&angle).then(&offset), Transform::IDENTITY),
    }
}

/// The link's body in the link frame, and the field that its inertia comes from.
fn body(link: &LinkSpec, place: &Place, faults: &mut Diagnostics) -> Option<(Body, &'static str)> {
    match (&link.first_moment, &link.pseudo_inertia, &link.com, &link.inertia) {
        (Some(first_moment), Some(sigma), None, None) => {
            let body = Body { mass: link.mass, first_moment: *first_moment, pseudo_inertia: matrix(sigma) };
            Some((body, "pseudo_inertia"))
        }
        (None, None, Some(com), Some(inertia)) => {
            Some((Body::from_com(link.mass, *com, matrix(inertia)), "inertia"))
        }
        (first, sigma, com, inertia) => {
            let given = [
                ("first_moment", first.is_some()),
                ("pseudo_inertia", sigma.is_some()),
                ("com", com.is_some()),
                ("inertia", inertia.is_some()),
            ];
            explain(&given, place, faults);
            None
        }
    }
}

fn explain(given: &[(&str, bool); 4], place: &Place, faults: &mut Diagnostics) {
    let names: Vec<String> =
        given.iter().filter(|(_, is)| *is).map(|(name, _)| format!("`{name}`")).collect();
    let [first, sigma, com, inertia] = given.map(|(_, is)| is);
    let whole = (first && sigma) || (com && inertia);
    let (problem, help) = match (names.as_slice(), whole) {
        ([], _) => (
            "has no inertial data beside its mass".to_string(),
            "add `com` and `inertia`, or `first_moment` and `pseudo_inertia`".to_string(),
        ),
        ([_, _, _, ..], true) | ([_, _, ..], false) => (
            format!("mixes {}", names.join(", ")),
            "keep `com` and `inertia`, or `first_moment` and `pseudo_inertia`".to_string(),
        ),
        ([name, ..], _) => {
            let other = match (first, sigma, com) {
                (true, ..) => "pseudo_inertia",
                (_, true, _) => "first_moment",
                (_, _, true) => "inertia",
                _ => "com",
            };
            (format!("has {name} without `{other}`"), format!("add `{other}`"))
        }
    };
    place.fault(faults, problem, help);
}
