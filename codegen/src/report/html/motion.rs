//! The desired motion, and the domain around it.

use super::figure::{Axis, Figure, Lines, Panel, Role, Series, Table};
use super::study::Study;
use super::words;
use crate::arm::{Joint, JointKind};
use crate::domain::Domain;
use crate::motion::{Motion, Target};

/// Instants at which curves are taken.
const INSTANTS: u32 = 150;

fn instants(motion: &Motion) -> Vec<f64> {
    (0..=INSTANTS).map(|k| motion.duration() * f64::from(k) / f64::from(INSTANTS)).collect()
}

/// A derivative of the motion: name, unit, values.
type Order = (&'static str, &'static str, fn(&Target) -> &Vec<f64>);

/// Position, speed and acceleration of all joints.
pub(super) fn motion_figure(study: &Study) -> Option<Figure> {
    let motion = study.generation.motion()?;
    let joints = &study.generation.arm().joints;
    let targets: Vec<(f64, Target)> = instants(motion).into_iter().map(|t| (t, motion.at(t))).collect();
    let mut panels = Vec::new();
    for kind in [JointKind::Revolute, JointKind::Prismatic] {
        if joints.iter().all(|joint| joint.kind != kind) {
            continue;
        }
        let (position, speed, acceleration) = match kind {
            JointKind::Revolute => ("rad", "rad/s", "rad/s²"),
            JointKind::Prismatic => ("m", "m/s", "m/s²"),
        };
        let orders: [Order; 3] = [
            ("position", position, |target| &target.q),
            ("speed", speed, |target| &target.qd),
            ("acceleration", acceleration, |target| &target.qdd),
        ];
        for (name, unit, values) in orders {
            let of = |(i, joint): (usize, &Joint)| {
                let points = targets.iter().map(|(t, target)| (*t, values(target)[i])).collect();
                Series::curve(joint.name.clone(), Role::Joint(i), points)
            };
            let series = joints.iter().enumerate().filter(|(_, joint)| joint.kind == kind).map(of).collect();
            let (title, y) = (format!("Desired {name}"), Axis::linear(name, unit));
            panels.push(Panel::Lines(Lines { title, x: Axis::TIME, y, series }));
        }
    }
    let (speed, acceleration) = (motion.largest_speed(), motion.largest_acceleration());
    let share = |most: &[f64], limit: fn(&Joint) -> Option<f64>| {
        let parts = joints.iter().zip(most).filter_map(|(joint, most)| Some(most / limit(joint)?));
        parts.fold(None, |all: Option<f64>, part| Some(all.map_or(part, |all| all.max(part))))
    };
    let told = |what: &str, part: Option<f64>| {
        part.map(|part| format!("{what} reaches at most {} of its limit", words::percent(part, true)))
    };
    let used = [
        told("speed", share(&speed, |joint| joint.limits.velocity)),
        told("acceleration", share(&acceleration, |joint| joint.limits.acceleration)),
    ];
    let used: Vec<String> = used.into_iter().flatten().collect();
    let lasting = format!("The motion lasts {}.", words::time(motion.duration()));
    let caption = match used.is_empty() {
        true => format!(
            "{lasting} No joint has a limit of speed or acceleration, so nothing here says whether the arm can follow it."
        ),
        false => format!(
            "{lasting} In the joint nearest to its limit, {}. A motion that breaks a limit is refused.",
            used.join(", and ")
        ),
    };
    Some(Figure { caption, panels })
}

/// Where the model must be accurate: around the motion, or between limits.
pub(super) fn domain_figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let joints = &generation.arm().joints;
    let domain = generation.domain();
    let panel = |(i, joint): (usize, &Joint)| domain_panel(domain, generation.motion(), joint, i);
    let panels: Vec<Panel> = joints.iter().enumerate().filter_map(panel).map(Panel::Lines).collect();
    let panels = if panels.is_empty() { vec![Panel::Table(domain_table(domain, joints))] } else { panels };
    let caption = match domain {
        Domain::Path(_) => {
            "The bounds hold on the motion itself and nowhere beside it: use them to compare models, not to promise anything of an \
             arm with errors."
                .to_string()
        }
        Domain::Tube(..) => {
            "The bounds hold for every position in the shaded tube around the motion (line). If the arm leaves the tube, nothing is \
             promised. The error funnel below must stay narrower than it."
                .to_string()
        }
        Domain::Workspace(_) => {
            "The bounds hold for every position in the shaded range of each joint, whatever the motion: the same module can be used \
             with other motions in it."
                .to_string()
        }
    };
    Figure { caption, panels }
}

fn domain_panel(domain: &Domain, motion: Option<&Motion>, joint: &Joint, i: usize) -> Option<Lines> {
    let motion = motion?;
    let time = instants(motion);
    let desired: Vec<f64> = time.iter().map(|&t| motion.at(t).q[i]).collect();
    let end = motion.duration();
    let mut series = Vec::new();
    match domain {
        Domain::Path(_) => {}
        Domain::Tube(_, width) => series.push(Series {
            name: "tube".to_string(),
            role: Role::Certified,
            x: time.clone(),
            y: desired.iter().map(|q| q + width[i]).collect(),
            low: desired.iter().map(|q| q - width[i]).collect(),
        }),
        Domain::Workspace(limits) => {
            series.push(Series::between("workspace", Role::Certified, [0.0, end], limits[i]));
        }
    }
    let points = time.into_iter().zip(desired).collect();
    series.push(Series::curve("desired", Role::Desired, points));
    let y = Axis::linear("position", joint.kind.position_unit());
    Some(Lines { title: joint.name.clone(), x: Axis::TIME, y, series })
}

fn domain_table(domain: &Domain, joints: &[Joint]) -> Table {
    let mut table = Table::new("Domain of the bounds", ["joint", "lowest", "highest"]);
    if let Domain::Workspace(limits) = domain {
        for (joint, [low, high]) in joints.iter().zip(limits) {
            let unit = joint.kind.position_unit();
            let cell = |x: &f64| format!("{} {unit}", words::plain(*x));
            table.rows.push(vec![joint.name.clone(), cell(low), cell(high)]);
        }
    }
    table
}
