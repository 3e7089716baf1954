//! Arms some of whose joints follow others: more joints than coordinates.
//!
//! With q' = J q + o, J constant, the model of the coordinates is that of the chain pulled back: D = Jᵀ D' J,
//! C = Jᵀ C' J with the Christoffel C' at (q', J q̇), and G = Jᵀ G'.

use super::{Arm, Body, Joint, JointKind, MOST_JOINTS, Transform};

/// Largest denominator of a multiplier: halves and quarters of an angle are exact in binary, thirds are not.
const FINEST: u8 = 4;

/// Most turns of a coordinate's part in the chain's expansion, in which a joint turns twice at most: exponents are i8.
const MOST_TURNS: f64 = 60.0;

/// How a joint of the chain follows a coordinate: q'_i = multiplier · q_coordinate + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// Rate of the joint over that of the coordinate: a whole multiple of ¼, not 0.
    pub multiplier: f64,
    /// Position of the joint where the coordinate is 0, rad or m.
    pub offset: f64,
}

/// The joints behind the coordinates of an arm.
///
/// Holds: as many couplings as the chain has joints; coordinate and joint are of one kind; multipliers times
/// [`Arm::parts`] are whole numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Linkage {
    /// All joints that move, base first, each with a coordinate of its own. They have no armature: the arm's
    /// coordinates have it.
    pub chain: Arm,
    /// How each of them follows the arm's coordinates.
    pub couplings: Vec<Coupling>,
}

impl Linkage {
    /// Positions of the chain's joints, J q + o.
    pub fn positions(&self, q: &[f64]) -> Vec<f64> {
        let at = |c: &Coupling| q.get(c.coordinate).map_or(0.0, |q| c.multiplier * q + c.offset);
        self.couplings.iter().map(at).collect()
    }

    /// The joints that follow, as equations such as `j3 = -0.5 j2 + 0.1`.
    pub fn equations(&self, arm: &Arm) -> Vec<String> {
        let follows = |c: &Coupling, joint: &Joint| {
            let master = arm.joints.get(c.coordinate)?;
            let offset = match c.offset {
                0.0 => String::new(),
                offset if offset < 0.0 => format!(" - {}", -offset),
                offset => format!(" + {offset}"),
            };
            (master.name != joint.name)
                .then(|| format!("{} = {} {}{offset}", joint.name, c.multiplier, master.name))
        };
        self.couplings.iter().zip(&self.chain.joints).filter_map(|(c, joint)| follows(c, joint)).collect()
    }

    /// Bounds |J| x + |o| on the magnitudes of the chain's positions, where those of the coordinates stay below `x`.
    pub fn position_bound(&self, x: &[f64]) -> Vec<f64> {
        let at = |c: &Coupling| x.get(c.coordinate).map_or(0.0, |x| c.multiplier.abs() * x + c.offset.abs());
        self.couplings.iter().map(at).collect()
    }
}

/// A joint of the chain with its own drive, and how it follows which other joint of the chain.
pub(super) struct Link {
    /// The joint.
    pub joint: Joint,
    /// Index of the joint that it follows, multiplier and offset; `None` for a joint that moves by itself.
    pub follows: Option<(usize, f64, f64)>,
}

/// Why joints cannot follow one another as they should.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unsupported {
    /// Index of the joint.
    pub joint: usize,
    /// What is wrong.
    pub problem: String,
    /// What to do about it.
    pub help: String,
}

/// The arm of a chain, whose tip stands at `tip` in the last joint's moved frame.
pub(super) fn arm(links: Vec<Link>, gravity: [f64; 3], tip: Transform) -> Result<Arm, Unsupported> {
    if links.iter().all(|link| link.follows.is_none()) {
        let joints = links.into_iter().map(|link| link.joint).collect();
        return Ok(Arm { gravity, joints, tip, linkage: None });
    }
    let masters: Vec<usize> = (0..links.len()).filter(|&i| links[i].follows.is_none()).collect();
    let mut couplings = Vec::with_capacity(links.len());
    for (i, link) in links.iter().enumerate() {
        let (master, multiplier, offset) = link.follows.unwrap_or((i, 1.0, 0.0));
        let Some(coordinate) = masters.iter().position(|&m| m == master) else {
            let (problem, help) = ("follows a joint that follows another", "let it follow that one");
            return Err(Unsupported { joint: i, problem: problem.into(), help: help.into() });
        };
        if (multiplier * f64::from(FINEST)).fract() != 0.0 {
            return Err(Unsupported {
                joint: i,
                problem: format!("has the multiplier {multiplier}"),
                help: "write a whole number of quarters, such as -1, 0.5 or 2: the model is a sum of sines of such \
                       multiples; or hold the joint by `arm.lock`"
                    .into(),
            });
        }
        couplings.push(Coupling { coordinate, multiplier, offset });
    }
    let mut joints: Vec<Joint> = masters.iter().map(|&m| coordinate(&links[m].joint)).collect();
    for (link, coupling) in links.iter().zip(&couplings) {
        if let Some(joint) = joints.get_mut(coupling.coordinate) {
            drive(joint, &link.joint, coupling, link.follows.is_some());
        }
    }
    let still = |mut joint: Joint| {
        (joint.armature, joint.viscous_friction, joint.coulomb_friction) = (0.0, 0.0, [0.0; 2]);
        joint
    };
    let chain = links.into_iter().map(|link| still(link.joint)).collect();
    let chain = Arm { gravity, joints: chain, tip, linkage: None };
    let arm = Arm { gravity, joints, tip, linkage: Some(Box::new(Linkage { chain, couplings })) };
    let parts = arm.parts();
    let Some(linkage) = &arm.linkage else { return Ok(arm) };
    for (i, joint) in arm.joints.iter().enumerate() {
        let own = linkage.couplings.iter().filter(|c| c.coordinate == i);
        let turns: f64 = own.map(|c| c.multiplier.abs() * f64::from(parts[i])).sum();
        if turns > MOST_TURNS / 2.0 {
            let follower = linkage.couplings.iter().rposition(|c| c.coordinate == i).unwrap_or(0);
            return Err(Unsupported {
                joint: follower,
                problem: format!(
                    "lets the joints that follow {} turn {turns} times as far as its part",
                    joint.name
                ),
                help: "write smaller multipliers, or hold the joint by `arm.lock`".into(),
            });
        }
    }
    Ok(arm)
}

/// The coordinate of a joint that moves by itself: its body is in the chain, its drive is added later.
fn coordinate(joint: &Joint) -> Joint {
    Joint {
        name: joint.name.clone(),
        kind: joint.kind,
        pose: Transform::IDENTITY,
        body: Body::default(),
        link: Transform::IDENTITY,
        armature: 0.0,
        viscous_friction: 0.0,
        coulomb_friction: [0.0; 2],
        limits: joint.limits,
    }
}

/// Adds to the coordinate `onto` what the drive of `joint` means there, and keeps it within the limits of a joint that
/// `follows` it.
fn drive(onto: &mut Joint, joint: &Joint, coupling: &Coupling, follows: bool) {
    let m = coupling.multiplier;
    onto.armature += m * m * joint.armature;
    onto.viscous_friction += m * m * joint.viscous_friction;
    let [forwards, backwards] = joint.coulomb_friction;
    let friction = if m < 0.0 { [m * backwards, m * forwards] } else { [m * forwards, m * backwards] };
    onto.coulomb_friction = [onto.coulomb_friction[0] + friction[0], onto.coulomb_friction[1] + friction[1]];
    if !follows {
        return;
    }
    if let Some([low, high]) = joint.limits.position {
        let ends = [(low - coupling.offset) / m, (high - coupling.offset) / m];
        let [low, high] = if m < 0.0 { [ends[1], ends[0]] } else { ends };
        let own = onto.limits.position.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        onto.limits.position = Some([own[0].max(low), own[1].min(high)]);
    }
    let least = |own: Option<f64>, other: Option<f64>| match (own, other.map(|x| x / m.abs())) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    };
    onto.limits.velocity = least(onto.limits.velocity, joint.limits.velocity);
    onto.limits.acceleration = least(onto.limits.acceleration, joint.limits.acceleration);
}

impl Arm {
    /// By coordinate the p in q/p, the part of an angle of whose sines and cosines the model is made: 1 but where a
    /// joint follows at half or a quarter of a coordinate's rate. 1 beyond the last joint and for prismatic ones.
    pub fn parts(&self) -> [u8; MOST_JOINTS] {
        let mut parts = [1; MOST_JOINTS];
        for coupling in self.linkage.iter().flat_map(|linkage| &linkage.couplings) {
            let turning = self.joints.get(coupling.coordinate).is_some_and(|j| j.kind == JointKind::Revolute);
            if let (true, Some(part)) = (turning, parts.get_mut(coupling.coordinate)) {
                while *part < FINEST && (coupling.multiplier * f64::from(*part)).fract() != 0.0 {
                    *part *= 2;
                }
            }
        }
        parts
    }

    /// The angle after which the model repeats itself in revolute joint `j`, rad.
    pub fn period(&self, j: usize) -> f64 {
        std::f64::consts::TAU * f64::from(self.parts().get(j).copied().unwrap_or(1))
    }

    /// The joints that move, one for each body: those of the chain where some follow others.
    pub fn moving(&self) -> &[Joint] {
        self.linkage.as_ref().map_or(&self.joints, |linkage| &linkage.chain.joints)
    }

    /// The last joint that moves.
    pub(super) fn last_moving(&mut self) -> Option<&mut Joint> {
        match &mut self.linkage {
            Some(linkage) => linkage.chain.joints.last_mut(),
            None => self.joints.last_mut(),
        }
    }
}
