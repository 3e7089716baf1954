//! Rotor inertias from `<transmission>` elements.
//!
//! URDF itself knows `mechanicalReduction` alone; the rotor's inertia stands beside it under names that differ from
//! exporter to exporter. What is not certain is left out with a warning: the specification can say it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::super::place::Place;
use super::robot::Robot;
use super::xml::Element;

/// Names of the gear ratio, motor turns per joint turn, and of the rotor's inertia, kg·m²; prefixes aside.
const RATIO: [&str; 3] = ["mechanicalReduction", "gear_ratio", "gearRatio"];
const INERTIA: [&str; 4] = ["motorInertia", "rotorInertia", "motor_inertia", "rotor_inertia"];

/// An element with the rotor inertia that it gives, or why that is not certain.
type Told<'a> = (&'a Element, Result<f64, String>);

/// Rotor inertia by joint, seen from the joint, kg·m² (kg for a prismatic joint), each with the warning that tells it.
pub(super) fn armatures<'a>(
    root: &'a Element,
    robot: &Robot<'a>,
    file: &Path,
    warnings: &mut Vec<String>,
) -> BTreeMap<&'a str, (f64, String)> {
    let known: BTreeSet<&str> = robot.joints.iter().map(|joint| joint.name).collect();
    let mut found: BTreeMap<&str, Vec<Told<'_>>> = BTreeMap::new();
    for element in root.all("transmission") {
        let mut joints: Vec<&str> = element.all("joint").filter_map(name).collect();
        joints.extend(
            element.children.iter().filter(|child| local(child) == "joint_name").map(|c| c.text.as_str()),
        );
        joints.dedup();
        let inertia = reflected(element, joints.len());
        for joint in joints.iter().filter(|joint| known.contains(*joint)) {
            if let Some(inertia) = inertia.clone() {
                found.entry(joint).or_default().push((element, inertia));
            }
        }
    }
    let mut out = BTreeMap::new();
    for (joint, all) in found {
        let Some((element, _)) = all.first() else { continue };
        let title = name(element).map_or("transmission".to_string(), |name| format!("transmission[{name}]"));
        let place = Place::new(file, title).on(element.line);
        match all.as_slice() {
            [(_, Ok(inertia))] => {
                let mut told = Vec::new();
                let what = format!(
                    "gives the joint {joint} the rotor inertia {inertia:e} kg·m² on its own side; \
                     `arm.joints.{joint}.armature` replaces it"
                );
                place.warn(&mut told, &what);
                out.insert(joint, (*inertia, told.concat()));
            }
            [(_, Err(why))] => place.warn(warnings, &ignored(why, joint)),
            _ => place.warn(warnings, &ignored("is one of several for the joint", joint)),
        }
    }
    out
}

fn ignored(why: &str, joint: &str) -> String {
    format!("{why}, so its rotor inertia is left out; write `arm.joints.{joint}.motor`")
}

/// The rotor's inertia seen from the joint; `None` where the element says nothing of it.
fn reflected(element: &Element, joints: usize) -> Option<Result<f64, String>> {
    let inertias = numbers(element, &INERTIA);
    if inertias.is_empty() {
        return None;
    }
    let ratios = numbers(element, &RATIO);
    Some(match (inertias.as_slice(), ratios.as_slice()) {
        _ if joints != 1 => Err(format!("moves {joints} joints")),
        ([Some(inertia)], [Some(ratio)]) if *inertia >= 0.0 && *ratio != 0.0 => {
            let reflected = inertia * ratio * ratio;
            if reflected.is_finite() { Ok(reflected) } else { Err("overflows".into()) }
        }
        ([_], []) => Err("gives a rotor inertia without mechanicalReduction".into()),
        ([_], [_]) => Err("gives a rotor inertia or a reduction that is not a valid number".into()),
        _ => Err("gives several rotor inertias or reductions".into()),
    })
}

/// Every number under one of `names` anywhere inside `element`: its text, or its attribute `value`.
fn numbers(element: &Element, names: &[&str]) -> Vec<Option<f64>> {
    let mut out = Vec::new();
    for child in &element.children {
        if names.contains(&local(child)) {
            let text = child.attribute("value").map_or(child.text.as_str(), |attribute| &attribute.value);
            out.push(text.trim().parse::<f64>().ok().filter(|number| number.is_finite()));
        }
        out.extend(numbers(child, names));
    }
    out
}

/// The name of an element without its prefix.
fn local(element: &Element) -> &str {
    element.name.rsplit(':').next().unwrap_or_default()
}

fn name(element: &Element) -> Option<&str> {
    element.attribute("name").map(|attribute| attribute.value.as_str())
}
