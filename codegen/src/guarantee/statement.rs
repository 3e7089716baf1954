//! What is promised of a controller, and of which kind the promise is.

use super::follow::Sampled;
use crate::arm::Arm;
use crate::bounds::printed_up;
use crate::control::Guarantee;
use crate::number::decimal;

/// Which loop a promise is about; the strongest promise first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The loop that runs: its errors are followed from sample to sample along the motion.
    Sampled,
    /// The continuous law with a level of V, the lag of a held torque counted to first order.
    Continuous,
    /// Nothing is promised.
    None,
}

impl Kind {
    /// As it is written in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sampled => "sampled",
            Self::Continuous => "continuous",
            Self::None => "none",
        }
    }
}

/// What is promised.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Which kind of promise holds: the strongest one.
    pub kind: Kind,
    /// Why no stronger one holds; empty for [`Kind::Sampled`], and without a motion for [`Kind::Continuous`].
    pub reasons: Vec<String>,
    /// What is proved of the sampled loop, torque limits aside; `None` where its errors could not be followed, or without a motion.
    pub sampled: Option<Sampled>,
}

impl Statement {
    /// The bounds of the sampled loop, where they are promised: not where a torque limit may cut in.
    pub fn promised(&self) -> Option<&Sampled> {
        self.sampled.as_ref().filter(|_| self.kind == Kind::Sampled)
    }

    /// Of what is proved of the sampled loop of `arm`, `None` without a motion, and of the continuous one.
    pub fn new(
        arm: &Arm,
        limits: &[Option<f64>],
        sampled: Option<Result<Sampled, Vec<String>>>,
        continuous: &Guarantee,
    ) -> Self {
        let (sampled, mut reasons) = match sampled {
            None => (None, Vec::new()),
            Some(Ok(sampled)) => {
                let cut = saturation(arm, limits, &sampled);
                if cut.is_empty() {
                    return Self { kind: Kind::Sampled, reasons: Vec::new(), sampled: Some(sampled) };
                }
                // Where the loop that runs may be cut, so may the continuous one.
                return Self { kind: Kind::None, reasons: cut, sampled: Some(sampled) };
            }
            Some(Err(reasons)) => (None, reasons),
        };
        let kind = if continuous.holds { Kind::Continuous } else { Kind::None };
        reasons.extend(continuous.reasons.iter().cloned());
        Self { kind, reasons, sampled }
    }
}

/// The joints that may ask for more than their limit, one reason each.
fn saturation(arm: &Arm, limits: &[Option<f64>], sampled: &Sampled) -> Vec<String> {
    let cut = |i: usize| {
        let limit = limits.get(i).copied().flatten()?;
        let [low, high] = sampled.torque[i];
        let most = high.max(-low);
        (most > limit).then(|| {
            format!(
                "joint {} ({}) may ask for {} at t = {} s, {} more than its limit of {limit}",
                i + 1,
                arm.joints[i].name,
                printed_up(most),
                decimal(sampled.torque_time[i], 3),
                printed_up(most - limit)
            )
        })
    };
    (0..arm.dof()).filter_map(cut).collect()
}
