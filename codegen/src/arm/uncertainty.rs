//! The family of arms that a specification's intervals allow: affine in a few independent numbers.

use std::path::Path;

use super::intervals::{Carried, Given, about};
use super::place::Place;
use super::{Arm, Body};
use crate::error::Diagnostics;
use crate::spec::{ArmSpec, UncertaintySpec};
use crate::text::has;

/// Most uncertain numbers of inertia: their box has 2^10 vertices.
pub const MOST_PARAMETERS: usize = 10;

/// One uncertain number of inertia u, counted from the arm's own value: u = 0 is the arm as specified.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Field that it comes from, such as `links[0].mass`.
    pub name: String,
    /// Index of the joint that moves the body.
    pub joint: usize,
    /// What u = 1 adds to that joint's body, moved frame.
    pub body: Body,
    /// The arm's own value, in the unit of the field.
    pub nominal: f64,
    /// Lowest u, ≤ 0.
    pub low: f64,
    /// Highest u, ≥ 0.
    pub high: f64,
    /// Whether the addition is positive semidefinite, so that D(q) only grows with u.
    pub grows: bool,
}

/// All arms of a specification.
///
/// Holds: intervals are finite, wider than a point and hold the arm's own values; at most [`MOST_PARAMETERS`]
/// parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uncertainty {
    /// The uncertain numbers of inertia.
    pub parameters: Vec<Parameter>,
    /// Largest |B − B̂| of the viscous friction by joint, N·m·s/rad; empty where none is uncertain.
    pub viscous: Vec<f64>,
}

impl Uncertainty {
    /// The family that `spec` describes about `arm`; what is wrong goes to `faults`.
    pub fn new(
        spec: &UncertaintySpec,
        arm: &Arm,
        own: &ArmSpec,
        file: &Path,
        faults: &mut Diagnostics,
    ) -> Self {
        let place = Place::new(file, "control.uncertainty");
        let mut out = Self::default();
        if arm.linkage.is_some() && (spec.payload.is_some() || !spec.links.is_empty()) {
            let help = "leave out `payload` and `links`, or hold the joints that follow others by `arm.lock`";
            place.fault(
                faults,
                "has inertias of an arm whose joints follow others, which is not supported",
                help,
            );
            return out;
        }
        if let (Some(payload), Some(last)) = (&spec.payload, arm.joints.len().checked_sub(1)) {
            let place = place.at("payload");
            let nominal = own.payload.as_ref().map_or(Body::default(), |p| {
                let inertia = p.inertia.as_ref().map_or([[0.0; 3]; 3], super::body::matrix);
                Body::from_com(p.mass, p.com, inertia)
            });
            let at = payload.at.or(own.payload.as_ref().map(|p| p.com));
            let mut body = Given::payload(payload);
            body.at = at;
            let carried = Carried { joint: last, body: &nominal, frame: &arm.tip };
            out.parameters.extend(body.parameters("payload", &carried, &place, faults));
        }
        for (index, link) in spec.links.iter().enumerate() {
            let name = format!("links[{index}]");
            let place = place.at(&name);
            let Some(number) = arm.joints.iter().position(|joint| joint.name == link.joint) else {
                let names: Vec<&str> = arm.joints.iter().map(|joint| joint.name.as_str()).collect();
                let help = format!("name one of {}", names.join(", "));
                place.at("joint").fault(
                    faults,
                    format!("is {:?}, which is no joint of the arm", link.joint),
                    help,
                );
                continue;
            };
            if spec.links[..index].iter().any(|other| other.joint == link.joint) {
                let help = "write its intervals in one place: the two would add up";
                place.at("joint").fault(faults, format!("is {:?} again", link.joint), help);
                continue;
            }
            let joint = &arm.joints[number];
            let nominal = joint.body.moved(&joint.link.inverse());
            let given = Given::link(link);
            let carried = Carried { joint: number, body: &nominal, frame: &joint.link };
            out.parameters.extend(given.parameters(&name, &carried, &place, faults));
        }
        if out.parameters.len() > MOST_PARAMETERS {
            place.fault(
                faults,
                format!("has {} uncertain numbers of inertia", out.parameters.len()),
                format!("keep the {MOST_PARAMETERS} that matter most"),
            );
        }
        out.viscous = viscous(&spec.viscous_friction, arm, &place.at("viscous_friction"), faults);
        out
    }

    /// True where nothing is uncertain.
    pub fn is_empty(&self) -> bool {
        self.parameters.is_empty() && self.viscous.iter().all(|v| *v == 0.0)
    }

    /// `arm` with the parameters at `u`.
    pub fn at(&self, arm: &Arm, u: &[f64]) -> Arm {
        let mut out = arm.clone();
        for (parameter, &u) in self.parameters.iter().zip(u).filter(|(_, u)| **u != 0.0) {
            let body = &mut out.joints[parameter.joint].body;
            *body = body.plus(&parameter.body.scaled(u));
        }
        out
    }

    /// `arm` without any inertia but what u_k = 1 adds: the model is linear in the inertial parameters, so its derivative
    /// by u_k is the model of this one.
    pub fn alone(&self, arm: &Arm, k: usize) -> Arm {
        let mut out = arm.clone();
        for joint in &mut out.joints {
            (joint.body, joint.armature) = (Body::default(), 0.0);
        }
        let Parameter { joint, body, .. } = &self.parameters[k];
        out.joints[*joint].body = *body;
        out
    }

    /// max |base + Σ_k u_k slopes_k| over the box of all parameters, entry by entry.
    pub fn largest(&self, base: &[f64], slopes: &[Vec<f64>]) -> Vec<f64> {
        let entry = |i: usize| {
            let (mut low, mut high) = (base[i], base[i]);
            for (parameter, slope) in self.parameters.iter().zip(slopes) {
                let ends = [parameter.low * slope[i], parameter.high * slope[i]];
                low += ends[0].min(ends[1]);
                high += ends[0].max(ends[1]);
            }
            high.max(-low)
        };
        (0..base.len()).map(entry).collect()
    }

    /// The vertices of the box of all parameters: bit k of the index says which end of u_k.
    pub fn vertices(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        (0..1_usize << self.parameters.len()).map(|index| self.vertex(index))
    }

    fn vertex(&self, index: usize) -> Vec<f64> {
        let end = |(k, p): (usize, &Parameter)| if index >> k & 1 == 1 { p.high } else { p.low };
        self.parameters.iter().enumerate().map(end).collect()
    }

    /// Vertices among which every function that is convex and monotone in D takes its largest value: the parameters
    /// that only make D grow go to their ends together.
    pub fn extreme_vertices(&self) -> Vec<Vec<f64>> {
        let grows: usize =
            self.parameters.iter().enumerate().filter(|(_, p)| p.grows).map(|(k, _)| 1 << k).sum();
        let together = |index: &usize| index & grows == 0 || index & grows == grows;
        (0..1_usize << self.parameters.len()).filter(together).map(|index| self.vertex(index)).collect()
    }

    /// max |u_k|.
    pub fn widths(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.high.max(-p.low)).collect()
    }
}

/// max |B − B̂| by joint.
fn viscous(spec: &[Option<[f64; 2]>], arm: &Arm, place: &Place, faults: &mut Diagnostics) -> Vec<f64> {
    if !spec.is_empty() && spec.len() != arm.dof() {
        let help = format!("write {}, one for each joint, `null` where it is known", arm.dof());
        place.fault(faults, has(spec.len()), help);
        return Vec::new();
    }
    let mut widest = |(index, (range, joint)): (usize, (&Option<[f64; 2]>, &super::Joint))| {
        let Some(range) = range else { return 0.0 };
        let place = place.item(index);
        let value = joint.viscous_friction;
        about(*range, value, value, true, &place, faults).map_or(0.0, |[low, high]| high.max(-low))
    };
    spec.iter().zip(&arm.joints).enumerate().map(&mut widest).collect()
}
