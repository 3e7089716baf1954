//! Base parameters: inertial parameters that act alike are gathered on one link.
//!
//! Matter on the axis of a revolute joint moves alike whether it belongs to the joint's body or to the one before: so
//! mass, m·z and Σ_zz of every body may go to its parent, three of ten parameters. Across a prismatic joint both
//! bodies turn alike, so all of Σ may go. (After Gautier and Khalil 1990, in terms of Σ, where the moves are those
//! of matter and no rule is needed for parallel axes.)

use super::{Arm, Body, Joint, JointKind, Transform};

/// What a body keeps of the mass that could go to its parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mass {
    /// Nothing.
    #[default]
    None,
    /// So much that the parent's first moment along x vanishes: a mass at the joint costs less than a lever.
    ForX,
    /// So much that the parent's first moment along y vanishes.
    ForY,
}

/// What a body keeps of the m·z that could go to its parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Offset {
    /// Nothing.
    #[default]
    None,
    /// So much that the parent's first moment along x vanishes.
    ForX,
    /// So much that the parent's first moment along y vanishes.
    ForY,
}

/// What a body keeps of what could as well belong to its parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// Of its mass.
    pub mass: Mass,
    /// Of its m·z.
    pub offset: Offset,
    /// Of its Σ_zz.
    pub along: Along,
}

/// What a body keeps of the Σ_zz that could go to its parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Along {
    /// Nothing.
    #[default]
    None,
    /// −Σ_xx, so that I_yy = 0.
    LikeX,
    /// −Σ_yy, so that I_xx = 0.
    LikeY,
}

/// Parameters below this part of what they were summed from are rounding.
const NEGLIGIBLE: f64 = 4e-15;

/// A mass at a joint is not worth a lever that it exceeds this many times: digits would be lost.
const LIKE: f64 = 30.0;

impl Arm {
    /// The same D, C and G, with everything moved towards the base that can be; the bodies are no longer those of
    /// matter.
    pub fn regrouped(&self) -> Self {
        self.regrouped_keeping(&[])
    }

    /// As [`Arm::regrouped`], each body keeping what its entry says.
    pub(crate) fn regrouped_keeping(&self, kept: &[Kept]) -> Self {
        let mut arm = self.clone();
        let longest = arm.longest();
        let mut sizes: Vec<Body> = arm.joints.iter().map(|joint| sizes(&joint.body)).collect();
        for i in (0..arm.dof()).rev() {
            let (before, rest) = arm.joints.split_at_mut(i);
            let Some(joint) = rest.first_mut() else { break };
            round(&mut joint.body, &sizes[i]);
            let kept = kept.get(i).copied().unwrap_or_default();
            let moved = split(joint, kept.along);
            let Some(parent) = before.last_mut() else {
                ground(joint, &arm.gravity);
                break;
            };
            parent.body = parent.body.plus(&moved.moved(&joint.pose));
            sizes[i - 1] = sizes[i - 1].plus(&sizes[i].moved(&absolute(&joint.pose)));
            if joint.kind == JointKind::Revolute && parent.kind == JointKind::Revolute {
                let enough = LIKE * sizes[i - 1].mass;
                keep_offset(joint, parent, kept.offset, enough * longest);
                keep_mass(joint, parent, kept.mass, enough);
            }
        }
        arm
    }
}

/// Takes from the joint's body what could as well belong to the body before, and returns it.
fn split(joint: &mut Joint, along: Along) -> Body {
    let body = &mut joint.body;
    let all = *body;
    match joint.kind {
        JointKind::Revolute => {
            body.mass = 0.0;
            body.first_moment[2] = 0.0;
            body.pseudo_inertia[2][2] = match along {
                Along::None => 0.0,
                Along::LikeX => 0.0 - all.pseudo_inertia[0][0],
                Along::LikeY => 0.0 - all.pseudo_inertia[1][1],
            };
        }
        JointKind::Prismatic => body.pseudo_inertia = [[0.0; 3]; 3],
    }
    let mut moved = all;
    moved.mass -= body.mass;
    for i in 0..3 {
        moved.first_moment[i] -= body.first_moment[i];
        for j in 0..3 {
            moved.pseudo_inertia[i][j] -= body.pseudo_inertia[i][j];
        }
    }
    moved
}

/// The first body turns about a fixed axis or not at all: its inertia acts as a rotor's does, and first moments only
/// where gravity turns the joint.
fn ground(joint: &mut Joint, gravity: &[f64; 3]) {
    let body = &mut joint.body;
    if joint.kind == JointKind::Prismatic {
        body.first_moment = [0.0; 3];
        return;
    }
    joint.armature += body.pseudo_inertia[0][0] + body.pseudo_inertia[1][1];
    body.pseudo_inertia = [[0.0; 3]; 3];
    let pull = joint.pose.inverse().turn(*gravity);
    if pull[0] == 0.0 && pull[1] == 0.0 {
        body.first_moment = [0.0; 3];
    }
}

/// Gives back mass at the joint's origin, which stands at p in the parent: m p is the first moment that vanishes there.
fn keep_mass(joint: &mut Joint, parent: &mut Joint, mass: Mass, enough: f64) {
    let axis = match mass {
        Mass::None => return,
        Mass::ForX => 0,
        Mass::ForY => 1,
    };
    let kept = parent.body.first_moment[axis] / joint.pose.translation[axis];
    if kept.is_finite() && kept.abs() <= enough {
        give_back(joint, parent, Body { mass: kept, ..Body::default() });
        parent.body.first_moment[axis] = 0.0;
    }
}

/// Gives back m·z, which is a first moment along the joint's axis in the parent.
fn keep_offset(joint: &mut Joint, parent: &mut Joint, offset: Offset, enough: f64) {
    let axis = match offset {
        Offset::None => return,
        Offset::ForX => 0,
        Offset::ForY => 1,
    };
    let kept = parent.body.first_moment[axis] / joint.pose.rotation[axis][2];
    if kept.is_finite() && kept.abs() <= enough {
        give_back(joint, parent, Body { first_moment: [0.0, 0.0, kept], ..Body::default() });
        parent.body.first_moment[axis] = 0.0;
    }
}

fn give_back(joint: &mut Joint, parent: &mut Joint, body: Body) {
    joint.body = joint.body.plus(&body);
    let opposite = Body { mass: -body.mass, first_moment: body.first_moment.map(|s| -s), ..body };
    parent.body = parent.body.plus(&opposite.moved(&joint.pose));
}

fn sizes(body: &Body) -> Body {
    Body {
        mass: body.mass.abs(),
        first_moment: body.first_moment.map(f64::abs),
        pseudo_inertia: body.pseudo_inertia.map(|row| row.map(f64::abs)),
    }
}

fn absolute(pose: &Transform) -> Transform {
    Transform {
        rotation: pose.rotation.map(|row| row.map(f64::abs)),
        translation: pose.translation.map(f64::abs),
    }
}

/// Sets to zero what is rounding beside the largest of its kind.
fn round(body: &mut Body, sizes: &Body) {
    let largest = |x: &mut dyn Iterator<Item = f64>| NEGLIGIBLE * x.fold(0.0, f64::max);
    let first = largest(&mut sizes.first_moment.iter().copied());
    let second = largest(&mut sizes.pseudo_inertia.iter().flatten().copied());
    let cut = |x: &mut f64, least: f64| {
        if x.abs() < least {
            *x = 0.0;
        }
    };
    cut(&mut body.mass, NEGLIGIBLE * sizes.mass);
    body.first_moment.iter_mut().for_each(|x| cut(x, first));
    body.pseudo_inertia.iter_mut().flatten().for_each(|x| cut(x, second));
}
