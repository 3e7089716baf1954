//! Single inertial parameters: D, C and G are linear in them.

use super::{Arm, Body};

/// One number of inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Mass, kg.
    Mass,
    /// Mass times centre of mass along that axis, kg·m.
    First(usize),
    /// Σ_ij with i ≤ j, kg·m².
    Second(usize, usize),
    /// What acts on the joint alone as a rotor's inertia does, kg·m² (kg for a prismatic joint).
    Armature,
}

/// An inertial parameter of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Inertial {
    /// Index of the joint.
    pub joint: usize,
    /// Which number.
    pub quantity: Quantity,
}

impl Inertial {
    /// All eleven of a joint.
    pub fn of(joint: usize) -> impl Iterator<Item = Self> {
        let first = (0..3).map(Quantity::First);
        let second = (0..3).flat_map(|i| (i..3).map(move |j| Quantity::Second(i, j)));
        let all = [Quantity::Mass, Quantity::Armature].into_iter().chain(first).chain(second);
        all.map(move |quantity| Self { joint, quantity })
    }

    /// As words for documentation, such as `Σxy of joint3`.
    pub fn describe(&self, arm: &Arm) -> String {
        let axis = |i: usize| ["x", "y", "z"].get(i).copied().unwrap_or("");
        let quantity = match self.quantity {
            Quantity::Mass => "m".to_string(),
            Quantity::First(i) => format!("m{}", axis(i)),
            Quantity::Second(i, j) => format!("Σ{}{}", axis(i), axis(j)),
            Quantity::Armature => "rotor inertia".to_string(),
        };
        let name = arm.joints.get(self.joint).map_or("", |joint| joint.name.as_str());
        format!("{quantity} of {name}")
    }
}

impl Arm {
    /// The value of a parameter; 0 where the arm has no such joint.
    pub fn inertial(&self, parameter: Inertial) -> f64 {
        let Some(joint) = self.joints.get(parameter.joint) else { return 0.0 };
        match parameter.quantity {
            Quantity::Mass => joint.body.mass,
            Quantity::First(i) => joint.body.first_moment[i],
            Quantity::Second(i, j) => joint.body.pseudo_inertia[i][j],
            Quantity::Armature => joint.armature,
        }
    }

    /// Sets a parameter.
    pub fn set_inertial(&mut self, parameter: Inertial, value: f64) {
        let Some(joint) = self.joints.get_mut(parameter.joint) else { return };
        match parameter.quantity {
            Quantity::Mass => joint.body.mass = value,
            Quantity::First(i) => joint.body.first_moment[i] = value,
            Quantity::Second(i, j) => {
                joint.body.pseudo_inertia[i][j] = value;
                joint.body.pseudo_inertia[j][i] = value;
            }
            Quantity::Armature => joint.armature = value,
        }
    }

    /// The same joints without any inertia.
    pub fn without_inertia(&self) -> Self {
        let mut out = self.clone();
        for joint in &mut out.joints {
            (joint.body, joint.armature) = (Body::default(), 0.0);
        }
        out
    }
}
