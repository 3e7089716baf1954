//! The arm, drawn, and its joints.

use super::figure::{Coordinates, Figure, Panel, Poses, Table};
use super::study::Study;
use super::words::{self, counted, plain};
use crate::arm::{Arm, JointKind, Transform};
use crate::motion::Motion;

/// Instants at which the arm is known to the page; the first and the last are the ends of the motion.
const INSTANTS: u32 = 60;
/// Poses that are always shown.
const KEYS: usize = 5;

/// The arm at key poses of its motion, and the limits of its joints.
pub(super) fn figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let arm = generation.given();
    let poses = match generation.motion() {
        Some(motion) => along(arm, motion),
        None => still(arm),
    };
    let count = counted(arm.dof(), "joint");
    let caption = match generation.motion() {
        Some(motion) => {
            let tip = |t: f64| corners(arm, &motion.at(t).q).0.last().copied().unwrap_or_default();
            let (from, to) = (tip(0.0), tip(motion.duration()));
            let far = libm::sqrt((0..3).map(|i| (to[i] - from[i]) * (to[i] - from[i])).sum());
            format!(
                "{count}, from start (faint) to end (strong). The tip ends {} m from where it starts. Move over the picture, or use \
                 the arrow keys, to see the arm at any time: check here that the motion is the one you mean.",
                plain(far)
            )
        }
        None => format!("{count}, in the middle of the limits. The specification has no motion."),
    };
    Figure { caption, panels: vec![Panel::Arm(poses), Panel::Table(limits(arm))] }
}

fn along(arm: &Arm, motion: &Motion) -> Poses {
    let at = |k: u32| motion.duration() * f64::from(k) / f64::from(INSTANTS);
    let time: Vec<f64> = (0..=INSTANTS).map(at).collect();
    let drawn: Vec<(Vec<[f64; 3]>, Vec<usize>)> =
        time.iter().map(|&t| corners(arm, &motion.at(t).q)).collect();
    let joints = drawn.first().map(|pose| pose.1.clone()).unwrap_or_default();
    let key = (0..KEYS).map(|k| k * INSTANTS as usize / (KEYS - 1)).collect();
    Poses {
        title: "Poses along the motion".to_string(),
        time,
        corners: drawn.iter().map(|(pose, _)| flat(pose)).collect(),
        joints,
        key,
        up: up(arm),
    }
}

fn still(arm: &Arm) -> Poses {
    let middle: Vec<f64> = arm.joint_box().iter().map(|[low, high]| 0.5 * (low + high)).collect();
    let (pose, joints) = corners(arm, &middle);
    let title = "The arm in the middle of its limits".to_string();
    Poses { title, time: vec![0.0], corners: vec![flat(&pose)], joints, key: vec![0], up: up(arm) }
}

fn flat(pose: &[[f64; 3]]) -> Coordinates {
    Coordinates(pose.iter().flatten().copied().collect())
}

/// The axis of the base frame that is nearest to the vertical: z where there is no gravity.
fn up(arm: &Arm) -> usize {
    let size = |i: usize| arm.gravity[i].abs();
    if size(0) > size(2) && size(0) > size(1) {
        0
    } else if size(1) > size(2) {
        1
    } else {
        2
    }
}

/// The corners of the line from base to tip at `q`, m, in the base frame, and which of them are joints. Between two joints
/// the line goes along the axis of the first one, then across.
fn corners(arm: &Arm, q: &[f64]) -> (Vec<[f64; 3]>, Vec<usize>) {
    let behind = arm.linkage.as_ref().map(|linkage| linkage.positions(q));
    let mut pose = Transform::IDENTITY;
    let (mut line, mut joints) = (vec![[0.0; 3]], Vec::new());
    let step = |line: &mut Vec<[f64; 3]>, pose: &Transform, next: &Transform| {
        let [x, y, z] = next.translation;
        if z != 0.0 && (x != 0.0 || y != 0.0) {
            line.push(pose.apply([0.0, 0.0, z]));
        }
        line.push(pose.apply(next.translation));
    };
    for (joint, &q) in arm.moving().iter().zip(behind.as_deref().unwrap_or(q)) {
        step(&mut line, &pose, &joint.pose);
        joints.push(line.len() - 1);
        let motion = match joint.kind {
            JointKind::Revolute => Transform::rotation(2, q),
            JointKind::Prismatic => Transform::translation([0.0, 0.0, q]),
        };
        pose = pose.then(&joint.pose).then(&motion);
        if joint.kind == JointKind::Prismatic {
            line.push(pose.translation);
        }
    }
    let tip = arm.linkage.as_ref().map_or(&arm.tip, |linkage| &linkage.chain.tip);
    step(&mut line, &pose, tip);
    (line, joints)
}

fn limits(arm: &Arm) -> Table {
    let head = ["joint", "moves", "lowest", "highest", "speed", "acceleration", "torque", "armature"];
    let mut table = Table::new("Joints and their limits", head);
    let none = || "none".to_string();
    for joint in &arm.joints {
        let unit = joint.kind.position_unit();
        let (inertia, moves) = match joint.kind {
            JointKind::Revolute => ("kg·m²", "turns"),
            JointKind::Prismatic => ("kg", "slides"),
        };
        let limits = &joint.limits;
        let with = |x: Option<f64>, unit: &str| x.map_or_else(none, |x| format!("{} {unit}", plain(x)));
        table.rows.push(vec![
            joint.name.clone(),
            moves.to_string(),
            with(limits.position.map(|p| p[0]), unit),
            with(limits.position.map(|p| p[1]), unit),
            with(limits.velocity, &format!("{unit}/s")),
            with(limits.acceleration, &format!("{unit}/s²")),
            with(limits.torque, joint.kind.torque_unit()),
            format!("{} {inertia}", words::plain(joint.armature)),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::energy;
    use crate::simulate::example::three_link;

    /// A mass at the tip has the potential energy of the height at which the tip is drawn.
    #[test]
    fn the_tip_is_drawn_where_its_weight_is() {
        let mut arm = three_link();
        let q = [0.4, 0.9, -1.3];
        let before = energy(&arm, &q, &[0.0; 3]).1;
        let tip = arm.tip.translation;
        let last = arm.joints.last_mut().unwrap();
        last.body.mass += 1.0;
        (0..3).for_each(|i| last.body.first_moment[i] += tip[i]);
        let weight = energy(&arm, &q, &[0.0; 3]).1 - before;
        let (line, joints) = corners(&arm, &q);
        let height = line.last().unwrap()[2];
        assert!((weight - 9.81 * height).abs() < 1e-9, "{weight} {height}");
        assert_eq!(joints.len(), 3);
    }
}
