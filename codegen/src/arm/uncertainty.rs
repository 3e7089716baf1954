//! The family of arms that a specification's intervals allow: affine in a few independent numbers.

use std::path::Path;

use super::place::Place;
use super::{Arm, Body};
use crate::error::Faults;
use crate::spec::{
    ArmSpec, LinkUncertaintySpec, PayloadUncertaintySpec, SymmetricIntervalsSpec, UncertaintySpec,
};

/// Most uncertain numbers of inertia: their box has 2^10 vertices.
pub const MOST_PARAMETERS: usize = 10;

/// Rounding that passes where an interval must hold the arm's own value, relative to the values.
const SLACK: f64 = 1e-9;

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
/// Holds: intervals are finite and hold the arm's own values; at most [`MOST_PARAMETERS`] parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uncertainty {
    /// The uncertain numbers of inertia.
    pub parameters: Vec<Parameter>,
    /// Largest |B − B̂| of the viscous friction by joint, N·m·s/rad; empty where none is uncertain.
    pub viscous: Vec<f64>,
}

impl Uncertainty {
    /// The family that `spec` describes about `arm`; what is wrong goes to `faults`.
    pub fn new(spec: &UncertaintySpec, arm: &Arm, own: &ArmSpec, file: &Path, faults: &mut Faults) -> Self {
        let place = Place::new(file, "control.uncertainty");
        let mut out = Self::default();
        if let (Some(payload), Some(last)) = (&spec.payload, arm.joints.len().checked_sub(1)) {
            let place = place.at("payload");
            let carried = own.payload.as_ref().map_or(Body::default(), |p| {
                let inertia = p.inertia.as_ref().map_or([[0.0; 3]; 3], super::body::matrix);
                Body::from_com(p.mass, p.com, inertia)
            });
            let at = payload.at.or(own.payload.as_ref().map(|p| p.com));
            let body = Given { at, ..Given::payload(payload) };
            out.parameters.extend(body.parameters("payload", last, &carried, &arm.tip, &place, faults));
        }
        for (index, link) in spec.links.iter().enumerate() {
            let name = format!("links[{index}]");
            let place = place.at(&name);
            let Some(number) = arm.joints.iter().position(|joint| joint.name == link.joint) else {
                let names: Vec<&str> = arm.joints.iter().map(|joint| joint.name.as_str()).collect();
                let mend = format!("name one of {}", names.join(", "));
                place.at("joint").fault(
                    faults,
                    format!("is {:?}, which is no joint of the arm", link.joint),
                    mend,
                );
                continue;
            };
            let joint = &arm.joints[number];
            let nominal = joint.body.moved(&joint.link.inverse());
            let given = Given::link(link);
            out.parameters.extend(given.parameters(&name, number, &nominal, &joint.link, &place, faults));
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

/// The intervals of one body.
struct Given {
    mass: Option<[f64; 2]>,
    at: Option<[f64; 3]>,
    first_moment: Option<[Option<[f64; 2]>; 3]>,
    pseudo_inertia: Option<SymmetricIntervalsSpec>,
}

impl Given {
    fn payload(spec: &PayloadUncertaintySpec) -> Self {
        let PayloadUncertaintySpec { mass, at, first_moment, pseudo_inertia } = spec.clone();
        Self { mass, at, first_moment, pseudo_inertia }
    }

    fn link(spec: &LinkUncertaintySpec) -> Self {
        let LinkUncertaintySpec { mass, at, first_moment, pseudo_inertia, .. } = spec.clone();
        Self { mass, at, first_moment, pseudo_inertia }
    }

    /// One parameter for each interval; `nominal` is the body in the frame of the intervals, which stands at `frame`
    /// in the moved frame of joint number `joint`.
    fn parameters(
        &self,
        name: &str,
        joint: usize,
        nominal: &Body,
        frame: &super::Transform,
        place: &Place,
        faults: &mut Faults,
    ) -> Vec<Parameter> {
        let at = self.at.unwrap_or_default();
        let mut numbers =
            vec![("mass".to_string(), self.mass, nominal.mass, Body::from_com(1.0, at, [[0.0; 3]; 3]), true)];
        for i in 0..3 {
            let mut body = Body::default();
            body.first_moment[i] = 1.0;
            let range = self.first_moment.and_then(|m| m[i]);
            numbers.push((format!("first_moment[{i}]"), range, nominal.first_moment[i], body, false));
        }
        let sigma = self.pseudo_inertia.clone().unwrap_or_default();
        let entries = [
            ("xx", sigma.xx, 0, 0),
            ("yy", sigma.yy, 1, 1),
            ("zz", sigma.zz, 2, 2),
            ("xy", sigma.xy, 0, 1),
            ("xz", sigma.xz, 0, 2),
            ("yz", sigma.yz, 1, 2),
        ];
        for (entry, range, i, j) in entries {
            let mut body = Body::default();
            body.pseudo_inertia[i][j] = 1.0;
            body.pseudo_inertia[j][i] = 1.0;
            let field = format!("pseudo_inertia.{entry}");
            numbers.push((field, range, nominal.pseudo_inertia[i][j], body, i == j));
        }
        if numbers.iter().all(|(_, range, ..)| range.is_none()) {
            place.fault(faults, "names no uncertain number", "write an interval, such as `mass`");
        }
        if !at.iter().all(|v| v.is_finite()) {
            place.at("at").fault(faults, format!("is {at:?}"), "write three finite numbers, in m");
        }
        let mut out = Vec::new();
        for (field, range, value, body, grows) in numbers {
            let Some(range) = range else { continue };
            let not_negative = field == "mass";
            let Some([low, high]) = about(range, value, not_negative, &place.at(&field), faults) else {
                continue;
            };
            let name = format!("{name}.{field}");
            out.push(Parameter { name, joint, body: body.moved(frame), nominal: value, low, high, grows });
        }
        out
    }
}

/// The interval counted from `value`; a fault where it does not hold it.
fn about(
    range: [f64; 2],
    value: f64,
    not_negative: bool,
    place: &Place,
    faults: &mut Faults,
) -> Option<[f64; 2]> {
    let [low, high] = range;
    let slack = SLACK * low.abs().max(high.abs()).max(value.abs());
    if !(low.is_finite() && high.is_finite() && low <= high) {
        place.fault(faults, format!("is {range:?}"), "write [lowest, highest], both finite");
    } else if not_negative && low < 0.0 {
        place.fault(faults, format!("is {range:?}"), "write numbers of at least 0");
    } else if value < low - slack || high + slack < value {
        place.fault(
            faults,
            format!("is {range:?}, which does not hold the arm's own {value}"),
            "write an interval about the arm's own value, or change the arm",
        );
    } else {
        return Some([(low - value).min(0.0), (high - value).max(0.0)]);
    }
    None
}

/// max |B − B̂| by joint.
fn viscous(spec: &[Option<[f64; 2]>], arm: &Arm, place: &Place, faults: &mut Faults) -> Vec<f64> {
    if !spec.is_empty() && spec.len() != arm.dof() {
        let mend = format!("write {}, one for each joint, `null` where it is known", arm.dof());
        place.fault(faults, format!("has {} entries", spec.len()), mend);
        return Vec::new();
    }
    let mut widest = |(index, (range, joint)): (usize, (&Option<[f64; 2]>, &super::Joint))| {
        let Some(range) = range else { return 0.0 };
        let place = place.item(index);
        about(*range, joint.viscous_friction, true, &place, faults).map_or(0.0, |[low, high]| high.max(-low))
    };
    spec.iter().zip(&arm.joints).enumerate().map(&mut widest).collect()
}
