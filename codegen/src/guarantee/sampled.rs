//! The sampled loop of a controller: its problem, and the errors that its bounds hold for.

use super::declared::Declared;
use super::follow::{Open, Sampled, follow};
use super::funnel::Lost;
use super::problem::{Problem, Switching, Wrong, numbers};
use super::repetition::Repetition;
use crate::arm::{Arm, Uncertainty};
use crate::bounds::{Bounds, Rates};
use crate::control::{Design, LoopErrors};
use crate::motion::Motion;
use crate::number::{decimal, short};
use crate::numerics::linalg::weighed;

/// What the sampled loop is made of.
#[derive(Clone, Copy)]
pub struct SampledLoop<'a> {
    /// The arm as specified, and its family.
    pub arm: &'a Arm,
    /// What is known of it only to intervals.
    pub uncertainty: &'a Uncertainty,
    /// The desired motion.
    pub motion: &'a Motion,
    /// Half the width of the domain around it, by joint, rad or m.
    pub tube: &'a [f64],
    /// The controller.
    pub design: &'a Design,
    /// The bounds in its switching gain.
    pub bounds: &'a Bounds,
    /// Largest initial errors of position and speed, by joint.
    pub initial: [&'a [f64]; 2],
    /// Time from which errors count as settled, s; `None` for eight time constants of the slowest error.
    pub settle: Option<f64>,
    /// What the emitted step is wrong by while the errors stay below these.
    pub wrong: &'a dyn Fn(&LoopErrors) -> Wrong,
}

impl SampledLoop<'_> {
    /// What is proved of the loop, or why nothing is.
    pub fn judge(&self) -> Result<Sampled, Vec<String>> {
        let n = self.arm.dof();
        let p12 = &self.design.gains.p12;
        let [position, velocity] = self.initial;
        let mut declared: Vec<f64> = (0..n).map(|i| 1.2 * position[i] + 0.02 * self.tube[i]).collect();
        let pulled: Vec<f64> = p12.iter().map(|row| weighed(row, &declared)).collect();
        declared.extend(velocity.iter().zip(pulled).map(|(velocity, pulled)| 1.2 * velocity + 2.0 * pulled));
        let repetition = Repetition::of(self.motion, self.design.period);
        let wrong = |declared: &[f64]| (self.wrong)(&self.errors(declared));
        let followed = follow(&self.problem(repetition), Declared::new(declared, &wrong), self.settle);
        followed.map_err(|open| {
            vec![match open {
                Open::Long(periods) => format!(
                    "the motion takes {periods} periods, and more than 400000 are not followed: repeat a shorter one"
                ),
                Open::Short => format!(
                    "the motion takes {} s, less than one control period of {} s, and does not end at rest",
                    short(self.motion.duration()),
                    short(self.design.period)
                ),
                Open::Growing(declared) => format!(
                    "the errors grow without a bound that is found, beyond a speed error of {}",
                    list(&declared[n..])
                ),
                Open::Lost(lost) => self.lost(&lost),
            }]
        })
    }

    /// What the step's own error is bounded for, while |q_e|, then |q̇_e|, are at most `declared`.
    fn errors(&self, declared: &[f64]) -> LoopErrors {
        let n = self.arm.dof();
        let p12 = &self.design.gains.p12;
        let (position, velocity) = declared.split_at(n);
        let pulled = |x: &[f64]| -> Vec<f64> { (0..n).map(|i| weighed(&p12[i], x)).collect() };
        let sum = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
        let own = Rates::of(self.motion);
        LoopErrors {
            rates: Rates {
                speed: sum(&own.speed, velocity),
                reference_speed: sum(&own.speed, &pulled(position)),
                reference_acceleration: sum(&own.reference_acceleration, &pulled(velocity)),
            },
            position: position.to_vec(),
            s: sum(velocity, &pulled(position)),
        }
    }

    fn problem(&self, repetition: Option<Repetition>) -> Problem<'_> {
        let design = self.design;
        let n = self.arm.dof();
        Problem {
            arm: self.arm,
            numbers: numbers(self.arm, self.uncertainty),
            viscous: match self.uncertainty.viscous.is_empty() {
                true => vec![0.0; n],
                false => self.uncertainty.viscous.clone(),
            },
            motion: self.motion,
            gains: &design.gains,
            damping: design.damping(),
            switching: Switching::of(design, self.bounds),
            compensated: &design.coulomb,
            period: design.period,
            repetition,
            initial: self.initial,
            tube: self.tube.to_vec(),
        }
    }

    fn lost(&self, lost: &Lost) -> String {
        match lost {
            Lost::Tube { joint, time } => format!(
                "joint {} ({}) may leave the tube of {} at t = {} s",
                joint + 1,
                self.arm.joints[*joint].name,
                short(self.tube[*joint]),
                decimal(*time, 4)
            ),
            Lost::Inertia { time } => {
                format!("the errors may grow so far that D is not bounded at t = {} s", decimal(*time, 4))
            }
        }
    }
}

fn list(x: &[f64]) -> String {
    x.iter().map(|x| short(*x)).collect::<Vec<_>>().join(", ")
}
