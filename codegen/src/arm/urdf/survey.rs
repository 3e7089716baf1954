//! What a URDF file offers before anything is chosen: links at which an arm may end, and joints to hold still.

use std::collections::{BTreeMap, BTreeSet};

use super::encoding;
use super::robot::{Joint, Kind, Robot};
use super::xml;
use crate::error::{Diagnostics, Error};
use crate::load::Named;

/// Words in the names of links that stand for the end of an arm, the likeliest first.
const ENDS: [&str; 8] = ["tool0", "tcp", "flange", "tool", "ee_link", "end_effector", "_ee", "hand"];
/// Words in the names of joints, or of the links that they move, that stand for a part of a hand.
const FINGERS: [&str; 3] = ["finger", "jaw", "knuckle"];
/// The same in the names of joints alone: the last joint of a wrist may move a link that is called gripper.
const HAND: &str = "grip";

/// A URDF file as far as it must be known to choose the end of the arm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    /// Name of the robot; empty where the file gives none.
    pub name: String,
    /// Links at which an arm may end, the likeliest first.
    pub tips: Vec<Tip>,
}

/// A link at which an arm may end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tip {
    /// Its name.
    pub link: String,
    /// The joints that move it, base first.
    pub moving: Vec<String>,
    /// Movable joints on branches that the arm carries: they must be held still.
    pub branches: Vec<String>,
}

/// Reads the URDF file `named`.
///
/// # Errors
/// [`Error::Input`] with every fault of the file that keeps it from being read as links and joints.
pub fn survey(named: &Named) -> Result<Survey, Error> {
    let file = named.path.as_path();
    let bytes = match &named.content {
        Ok(bytes) => bytes,
        Err(error) => {
            let problem = format!("cannot be read ({error})");
            return Err(Error::input(file, "", problem, "give the path of a URDF file"));
        }
    };
    let mut faults = Diagnostics::of(file);
    let text = match encoding::text(bytes) {
        Ok(text) => text,
        Err(encoding::Unreadable { line, problem, help }) => {
            faults.push_at(file, line, "", problem, help);
            return Err(faults.into_error());
        }
    };
    let Some(root) = xml::read(&text, file, &mut faults) else { return Err(faults.into_error()) };
    let Some(robot) = Robot::read(&root, file, &mut faults) else { return Err(faults.into_error()) };
    let name = root.attribute("name").map_or(String::new(), |name| name.value.clone());
    faults.finish(Survey { name, tips: tips(&robot) })
}

/// Every link that some joint moves and at which an arm may end: leaves, and links where a hand begins.
fn tips(robot: &Robot<'_>) -> Vec<Tip> {
    let carrier: BTreeMap<&str, &Joint<'_>> = robot.joints.iter().map(|joint| (joint.child, joint)).collect();
    let mut children: BTreeMap<&str, usize> = BTreeMap::new();
    for joint in &robot.joints {
        *children.entry(joint.parent).or_default() += 1;
    }
    let palms = palms(robot, &carrier);
    let parts = robot.joints.iter().filter(|joint| of_a_hand(joint)).map(|joint| joint.name).collect();
    let ends = robot.links.iter().map(|link| link.name);
    let ends = ends.filter(|name| !children.contains_key(name) || palms.contains(name));
    let mut out: Vec<Tip> =
        ends.map(|link| tip(link, robot, &carrier)).filter(|tip| !tip.moving.is_empty()).collect();
    // Stable: of links that are equally likely the first of the file comes first.
    out.sort_by_key(|tip| rank(tip, &palms, &parts));
    out
}

/// The likeliest end first: no part of a hand, then a name that says so, then a palm, then the longest chain. `parts` are the joints
/// of hands.
fn rank(tip: &Tip, palms: &BTreeSet<&str>, parts: &BTreeSet<&str>) -> (bool, usize, bool, usize) {
    let name = tip.link.to_lowercase();
    let fingers = tip.moving.iter().any(|joint| parts.contains(joint.as_str()))
        || (palms.iter().any(|palm| tip.link != *palm) && name.contains("finger"));
    let word = ENDS.iter().position(|word| name.contains(word)).unwrap_or(ENDS.len());
    (fingers, word, !palms.contains(tip.link.as_str()), usize::MAX - tip.moving.len())
}

/// Whether its name, or that of the link that it moves, says that a movable joint is a part of a hand.
fn of_a_hand(joint: &Joint<'_>) -> bool {
    let [name, child] = [joint.name, joint.child].map(str::to_lowercase);
    let finger = FINGERS.iter().any(|word| name.contains(word) || child.contains(word));
    joint.kind != Kind::Fixed && (finger || name.contains(HAND))
}

/// Links that are moved, and that carry several branches with joints of their own or the first joint of a hand: palms.
fn palms<'a>(robot: &'a Robot<'a>, carrier: &BTreeMap<&str, &Joint<'_>>) -> BTreeSet<&'a str> {
    let mut branches: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for joint in robot.joints.iter().filter(|joint| joint.kind != Kind::Fixed) {
        // Each movable joint counts once for every link between it and the base.
        let (mut link, mut by) = (joint.parent, joint.name);
        for _ in 0..robot.joints.len() {
            branches.entry(link).or_default().insert(by);
            let Some(above) = carrier.get(link) else { break };
            (link, by) = (above.parent, above.name);
        }
    }
    let moved = |link: &str| chain(link, robot, carrier).iter().any(|joint| joint.kind != Kind::Fixed);
    let several = |link: &&str| branches.get(link).is_some_and(|by| by.len() > 1) && moved(link);
    let hand = |link: &str| {
        robot.joints.iter().any(|joint| joint.parent == link && of_a_hand(joint))
            && !chain(link, robot, carrier).iter().any(|joint| of_a_hand(joint))
    };
    let palm = |link: &&str| several(link) || (hand(link) && moved(link));
    robot.links.iter().map(|link| link.name).filter(palm).collect()
}

/// The joints between the root and `link`, nearest first; no more than there are, whatever loops the file has.
fn chain<'a>(link: &str, robot: &Robot<'_>, carrier: &BTreeMap<&str, &'a Joint<'a>>) -> Vec<&'a Joint<'a>> {
    let mut out = Vec::new();
    let mut at = link;
    while let Some(joint) = carrier.get(at).filter(|_| out.len() <= robot.joints.len()) {
        out.push(*joint);
        at = joint.parent;
    }
    out
}

fn tip(link: &str, robot: &Robot<'_>, carrier: &BTreeMap<&str, &Joint<'_>>) -> Tip {
    let chain = chain(link, robot, carrier);
    let on: BTreeSet<&str> = chain.iter().map(|joint| joint.name).collect();
    let moves = |joint: &&&Joint<'_>| joint.kind.moving().is_some();
    let moving = chain.iter().rev().filter(moves).map(|joint| joint.name.to_string()).collect();
    let movable = robot.joints.iter().filter(|joint| joint.kind != Kind::Fixed && !on.contains(joint.name));
    let carried = movable.filter(|joint| {
        let above = self::chain(joint.parent, robot, carrier);
        above.iter().any(|joint| on.contains(joint.name) && joint.kind != Kind::Fixed)
    });
    Tip { link: link.to_string(), moving, branches: carried.map(|joint| joint.name.to_string()).collect() }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::Arc;

    use super::survey;
    use crate::load::Named;

    fn named(joints: &[(&str, &str, &str, &str)]) -> Named {
        let mut links: Vec<&str> =
            joints.iter().flat_map(|(_, _, parent, child)| [*parent, *child]).collect();
        links.sort_unstable();
        links.dedup();
        let links: String = links.iter().map(|name| format!("<link name=\"{name}\"/>")).collect();
        let joints: String = joints
            .iter()
            .map(|(name, kind, parent, child)| {
                format!(
                    "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/></joint>"
                )
            })
            .collect();
        let text = format!("<robot name=\"r\">{links}{joints}</robot>");
        let content = Ok(Arc::from(text.as_bytes()));
        Named { field: "arm.urdf", name: "r.urdf".into(), path: PathBuf::from("r.urdf"), content }
    }

    #[test]
    fn an_arm_with_a_gripper_ends_at_the_palm() {
        let robot = [
            ("a", "revolute", "base", "one"),
            ("b", "revolute", "one", "two"),
            ("w", "fixed", "two", "palm"),
            ("l", "prismatic", "palm", "left_finger"),
            ("r", "prismatic", "palm", "right_finger"),
        ];
        let survey = survey(&named(&robot)).expect("a robot");
        let first = &survey.tips[0];
        assert_eq!((first.link.as_str(), survey.name.as_str()), ("palm", "r"));
        assert_eq!(
            (first.moving.as_slice(), first.branches.as_slice()),
            (&["a", "b"].map(String::from)[..], &["l", "r"].map(String::from)[..])
        );
        let tips: Vec<&str> = survey.tips.iter().map(|tip| tip.link.as_str()).collect();
        assert_eq!(tips, ["palm", "left_finger", "right_finger"]);
    }

    #[test]
    fn a_hand_of_one_joint_is_held_too() {
        let robot = [
            ("joint1", "revolute", "base", "one"),
            ("joint2", "revolute", "one", "two"),
            ("jointGripper", "revolute", "two", "gripperMover"),
        ];
        let survey = survey(&named(&robot)).expect("a robot");
        let first = &survey.tips[0];
        assert_eq!(first.link, "two");
        assert_eq!(first.branches, ["jointGripper"]);
        let tips: Vec<&str> = survey.tips.iter().map(|tip| tip.link.as_str()).collect();
        assert_eq!(tips, ["two", "gripperMover"]);
    }

    #[test]
    fn a_wrist_that_turns_the_gripper_is_of_the_arm() {
        let robot = [
            ("shoulder", "revolute", "base", "upper"),
            ("wrist_roll", "revolute", "upper", "gripper_link"),
            ("gripper", "revolute", "gripper_link", "moving_jaw"),
        ];
        let survey = survey(&named(&robot)).expect("a robot");
        let first = &survey.tips[0];
        assert_eq!(first.link, "gripper_link");
        assert_eq!((first.moving.len(), first.branches.as_slice()), (2, &["gripper".to_string()][..]));
    }

    #[test]
    fn a_name_that_means_the_end_comes_first() {
        let robot = [
            ("a", "revolute", "base", "one"),
            ("c", "fixed", "one", "camera"),
            ("t", "fixed", "one", "tool0"),
            ("s", "fixed", "base", "stand"),
        ];
        let tips: Vec<String> =
            survey(&named(&robot)).expect("a robot").tips.into_iter().map(|tip| tip.link).collect();
        assert_eq!(tips, ["tool0", "camera"]);
    }

    #[test]
    fn a_loop_ends() {
        let robot = [("a", "revolute", "one", "two"), ("b", "revolute", "two", "one")];
        assert!(survey(&named(&robot)).expect("links and joints").tips.len() <= 2);
    }
}
