//! The figures of one size.

use serde::{Deserialize, Serialize};

use super::Size;
use crate::bounds::six_digits_up;
use crate::control::RobustGain;
use crate::emit::functions;
use crate::error::Error;
use crate::graph::Operations;
use crate::guarantee::Statement;
use crate::pipeline::Generation;

/// The figures of one specification at one size. Vectors are by joint; what is not known is `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name of the specification.
    pub spec: String,
    /// Name of the size.
    pub size: String,
    /// How the code computes the torque: `expanded`, `sparse`, `recursive`.
    pub form: String,
    /// Whether nothing is left out: asked for, or because no reduced model pays.
    pub exact: bool,
    /// Number of kept functions; 0 for the exact model.
    pub functions: usize,
    /// Of a control step, or of one passivity torque without a controller.
    pub operations: Counts,
    /// The same with the exact model; `None` for a law that learns.
    pub exact_operations: Option<Counts>,
    /// Whether the reduction pays, in a sentence.
    pub verdict: String,
    /// Certified bound on the torque error, N·m or N, for the rates of the motion, over a workspace up to the joints' limits.
    pub torque_error: Option<Vec<f64>>,
    /// Largest torque, N·m or N.
    pub peak_torque: Option<Vec<f64>>,
    /// `torque_error` as a fraction of `peak_torque`; `None` for a joint without torque.
    pub torque_fraction: Option<Vec<Option<f64>>>,
    /// Whether the switching gain is a constant or the law's own; `None` for a law that does not switch.
    pub gain: Option<Gain>,
    /// The switching gain, N·m or N: the constant one, or a bound on the law's own. See [`Generation::switching_gain`].
    pub switching_gain: Option<Vec<f64>>,
    /// Control period, s.
    pub period: Option<f64>,
    /// Longest period at which the loop is stable with D kept constant, s; `None` where it is not certified.
    pub period_max: Option<f64>,
    /// What is promised of the controller; `None` without one, or where it was not looked at.
    pub guarantee: Option<Promise>,
    /// Length of the module's text. It says less where the guarantee was not looked at.
    pub bytes: usize,
    /// Lines of the module's text.
    pub lines: usize,
}

/// Operations, counted as the verdict counts them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// Multiplications, those together with an addition included.
    pub mul: usize,
    /// Additions, subtractions, negations and absolute values.
    pub add: usize,
    /// Joints whose sine and cosine are taken.
    pub sines: usize,
    /// All together, a pair of sine and cosine as 12 and a clamp as 2.
    pub total: usize,
}

/// What a robust law switches with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gain {
    /// The law's own bracket, at the state of the instant.
    State,
    /// One number by joint.
    Constant,
}

/// What is promised.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Promise {
    /// `sampled`, `continuous` or `none`.
    pub kind: String,
    /// Why no stronger one holds.
    pub reasons: Vec<String>,
    /// Bound on |q − q_d| at any time, rad or m; for `sampled`.
    pub reach: Option<Vec<f64>>,
    /// The same once the errors have settled; for `continuous` without the initial errors.
    pub settled_error: Option<Vec<f64>>,
    /// The same at the end of the motion; for `sampled`.
    pub end_error: Option<Vec<f64>>,
    /// Largest torque that the law asks for in either direction, N·m or N; for `sampled`.
    pub torque: Option<Vec<f64>>,
    /// Time until which that holds, s; `None` for ever.
    pub valid_until: Option<f64>,
}

impl Row {
    /// The figures of `generation`, which was made at `size`.
    ///
    /// # Errors
    /// As [`Generation::module`].
    pub fn new(size: &Size, generation: &Generation) -> Result<Self, Error> {
        let text = generation.module()?;
        let (design, torque) = (generation.design(), generation.torque());
        let [operations, exact] = generation.compared_operations();
        let fraction = |i: usize| torque.filter(|torque| !torque.is_still(i)).map(|t| t.error[i] / t.peak[i]);
        let certified = design.map(|design| &design.guarantee).filter(|promised| promised.period_certified);
        Ok(Self {
            spec: generation.spec().name.clone(),
            size: size.label(),
            form: generation.form().name().to_string(),
            exact: generation.reduced().is_exact(),
            functions: functions(generation.lagrangian(), generation.reduced()).len(),
            operations: operations.unwrap_or_default().into(),
            exact_operations: exact.map(Counts::from),
            verdict: generation.verdict(),
            torque_error: torque.map(|torque| torque.error.clone()),
            peak_torque: torque.map(|torque| torque.peak.clone()),
            torque_fraction: torque.map(|torque| (0..torque.error.len()).map(fraction).collect()),
            gain: design.filter(|design| design.law.has_choice()).map(|design| match design.robust_gain {
                RobustGain::State => Gain::State,
                RobustGain::Constant(_) => Gain::Constant,
            }),
            switching_gain: generation.switching_gain(),
            period: design.map(|design| design.period),
            period_max: certified.map(|promised| promised.period_max).filter(|period| period.is_finite()),
            guarantee: generation.statement().map(|statement| promise(statement, generation)),
            bytes: text.len(),
            lines: text.lines().count(),
        })
    }

    /// The largest of [`Row::torque_fraction`]; `None` where one of them is not known.
    pub fn worst_fraction(&self) -> Option<f64> {
        let fractions: Option<Vec<f64>> = self.torque_fraction.as_ref()?.iter().copied().collect();
        Some(fractions?.into_iter().fold(0.0, f64::max))
    }
}

impl From<Operations> for Counts {
    fn from(operations: Operations) -> Self {
        Self {
            mul: operations.mul + operations.fused,
            add: operations.add,
            sines: operations.trig_pairs,
            total: operations.cost(),
        }
    }
}

fn promise(statement: &Statement, generation: &Generation) -> Promise {
    let up = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| six_digits_up(*x)).collect() };
    let sampled = statement.promised();
    let continuous = (generation.design()).filter(|design| sampled.is_none() && design.guarantee.holds);
    let final_error = continuous.map(|design| up(&design.guarantee.final_error));
    Promise {
        kind: statement.kind.name().to_string(),
        reasons: statement.reasons.clone(),
        reach: sampled.map(|sampled| up(&sampled.reach)),
        settled_error: match sampled {
            Some(sampled) => sampled.settled_error.as_deref().map(up),
            None => final_error,
        },
        end_error: sampled.map(|sampled| up(&sampled.end_error)),
        torque: sampled.map(|sampled| {
            let [low, high] = sampled.torque_range();
            low.iter().zip(high).map(|(low, high)| high.max(-low)).collect()
        }),
        valid_until: sampled.and_then(|sampled| sampled.valid_until),
    }
}
