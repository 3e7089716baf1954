//! One run of the recursion, outward and inward. A run that differs little from another takes over what is the same.

use super::choice::Choice;
use super::motion::{Motion, Step, advance, to_parent};
use super::wrench::{Units, Wrench, own};
use super::{base, step};
use crate::arm::{Arm, Joint, JointKind};
use crate::graph::{Builder, Expr, Variable};

/// All that a run makes.
pub(super) struct Pass<'g> {
    /// Placed and regrouped.
    pub arm: Arm,
    choices: Vec<Choice>,
    units: Units,
    steps: Vec<Step<'g>>,
    /// Of the base first.
    pub motions: Vec<Motion<'g>>,
    /// What moves the bodies: in the still and in the turned frame.
    bodies: Vec<(Wrench<'g>, Wrench<'g>)>,
    pub links: Vec<Link<'g>>,
}

/// What a link asks for.
#[derive(Clone, Copy)]
pub(super) struct Link<'g> {
    /// In its own frame.
    pub inner: Wrench<'g>,
    /// With all that stands in the still frame, there.
    pub whole: Wrench<'g>,
    /// Of its joint.
    pub torque: Expr<'g>,
    /// Of the link before, in its still and in its own frame.
    handed: (Wrench<'g>, Wrench<'g>),
}

impl<'g> Pass<'g> {
    /// The recursion over a placed and regrouped arm. `other` is a run in the same graph, of an arm with as many joints of
    /// the same kinds.
    pub fn new(
        builder: &'g Builder,
        arm: Arm,
        choices: &[Choice],
        units: &Units,
        other: Option<&Self>,
    ) -> Self {
        let n = arm.dof();
        let other = other.filter(|other| other.units == *units);
        let mut out = Self {
            motions: Vec::with_capacity(n + 1),
            arm,
            choices: choices.to_vec(),
            units: *units,
            steps: Vec::with_capacity(n),
            bodies: Vec::with_capacity(n),
            links: Vec::new(),
        };
        for j in 0..n {
            let known = other.filter(|other| out.steps_alike(other, j));
            out.steps.push(match known {
                Some(other) => other.steps[j],
                None => step(builder, &out.arm.joints[j], j, &choices[j], units),
            });
        }
        out.motions.push(base(builder, &out.arm, units));
        for j in 0..n {
            let known = other.filter(|other| out.moves_alike(other, j));
            let before = j.checked_sub(1).map_or(Choice::default(), |i| choices[i]);
            let motion = match known {
                Some(other) => other.motions[j + 1],
                None => advance(&out.motions[j], &out.steps[j], &before, &choices[j]),
            };
            out.motions.push(motion);
        }
        out.inward(builder, other);
        out
    }

    fn inward(&mut self, builder: &'g Builder, other: Option<&Self>) {
        let zero = builder.constant(0.0);
        let n = self.arm.dof();
        let mut handed = (Wrench::zero(zero), Wrench::zero(zero));
        let mut alike = true;
        // From the last link on, as bodies and links are put together in one go: nodes stand in the order of first need.
        let mut bodies = Vec::with_capacity(n);
        for j in (0..n).rev() {
            let (joint, motion, choice) = (&self.arm.joints[j], &self.motions[j + 1], &self.choices[j]);
            let known = other.filter(|other| self.driven_alike(other, j));
            let body = match known {
                Some(other) => other.bodies[j],
                None => own(&joint.body, motion, choice, &self.units),
            };
            bodies.push(body);
            let known = other.filter(|other| alike && body == other.bodies[j] && self.hands_alike(other, j));
            let link = match known {
                Some(other) => other.links[j],
                None => self.link(builder, j, handed, body),
            };
            alike = other.is_some_and(|other| link.handed == other.links[j].handed);
            handed = link.handed;
            self.links.push(link);
        }
        bodies.reverse();
        self.bodies = bodies;
        self.links.reverse();
    }

    /// Link j, of which the one after it asks for `handed`.
    fn link(
        &self,
        builder: &'g Builder,
        j: usize,
        handed: (Wrench<'g>, Wrench<'g>),
        body: (Wrench<'g>, Wrench<'g>),
    ) -> Link<'g> {
        let zero = builder.constant(0.0);
        let (joint, step, motion) = (&self.arm.joints[j], &self.steps[j], &self.motions[j + 1]);
        let inner = handed.1.plus(&body.1);
        let outer = handed.0.plus(&body.0);
        let whole = match &motion.turn {
            Some(turn) => inner.outward(turn).plus(&outer),
            None => inner.plus(&outer),
        };
        let along = match joint.kind {
            JointKind::Revolute => whole.moment[2],
            JointKind::Prismatic => whole.force[2],
        };
        let torque = along + builder.constant(joint.armature) * builder.input(Variable::Ar(j));
        let moved = match (joint.kind, step.q) {
            (JointKind::Prismatic, Some(q)) => whole.about([zero, zero, q]),
            _ => whole,
        };
        let seen = Wrench { force: to_parent(step, moved.force), moment: to_parent(step, moved.moment) };
        let none = Wrench::zero(zero);
        let handed = match (self.choices[j].sum, self.motions[j].turn) {
            (true, Some(turn)) => (seen.about(turn.outward(step.lever)), none),
            _ => (none, seen.about(step.lever)),
        };
        Link { inner, whole, torque, handed }
    }

    fn joints<'a>(&'a self, other: &'a Self, j: usize) -> (&'a Joint, &'a Joint) {
        (&self.arm.joints[j], &other.arm.joints[j])
    }

    fn steps_alike(&self, other: &Self, j: usize) -> bool {
        let (own, known) = self.joints(other, j);
        own.pose == known.pose && self.choices[j].sum == other.choices[j].sum
    }

    fn moves_alike(&self, other: &Self, j: usize) -> bool {
        let lever = |pass: &Self| j.checked_sub(1).map(|i| pass.choices[i].still_lever);
        self.steps_alike(other, j)
            && self.choices[j].motion() == other.choices[j].motion()
            && lever(self) == lever(other)
            && self.motions[j] == other.motions[j]
    }

    fn driven_alike(&self, other: &Self, j: usize) -> bool {
        let (own, known) = self.joints(other, j);
        own.body == known.body
            && self.choices[j].wrench() == other.choices[j].wrench()
            && self.motions[j + 1] == other.motions[j + 1]
    }

    /// Where the link is handed the same and its body asks for the same.
    fn hands_alike(&self, other: &Self, j: usize) -> bool {
        let (own, known) = self.joints(other, j);
        self.steps_alike(other, j)
            && own.armature == known.armature
            && self.motions[j + 1].turn == other.motions[j + 1].turn
            && self.motions[j].turn == other.motions[j].turn
    }
}
