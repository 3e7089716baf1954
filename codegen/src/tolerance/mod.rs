//! Mode `tolerance`: the cheapest model whose certified torque error is small enough.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use crate::arm::Arm;
use crate::body::{self, Form};
use crate::bounds::{
    Certificate, Effort, Rates, certified_beside, separate_error, torque_exceeds, workspace_peak_torque,
};
use crate::graph::Graph;
use crate::lagrangian::{Absolute, Combination, Coordinates, Lagrangian, evaluate};
use crate::measure::{Domain, Measure};
use crate::motion::Motion;
use crate::progress::{Progress, Stage};
use crate::reduction::{self, Problem, Reduced, extremes};
use crate::spread::{Spread, corner, in_box};

/// Points of the domain at which the family of models is fitted, besides corners.
const POINTS: usize = 400;
/// How far points are spread beyond a workspace before they are moved back to its sides, where errors are largest.
const STRETCH: f64 = 1.5;
/// Around a motion, where the sum of the coefficients' largest errors exceeds the limit by more than this, the sharper
/// sum of the errors at the same position is not tried: its proof would not end.
const HOPELESS: f64 = 1.8;
/// Members whose error at the points is above the tolerance by this factor are looked at, too: between two of them the
/// error jumps.
const BEYOND: f64 = 1.13;
/// Work for each coefficient's certificate.
const EFFORT: Effort = Effort { tolerance: 0.03, boxes: 2000, starts: 3, seek_tube: false };
/// Corners of the joint box beside them.
const CORNERS: usize = 32;
/// The exact model beyond which no sparse one is sought: none of a useful tolerance would be cheaper than the recursion.
const LONG: usize = 4000;

/// What the torque error is measured with: rates and the largest torques that they lead to.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Over a workspace the joints' limits, around a motion the motion's own.
    pub rates: Rates,
    /// Largest |τ| by joint, N·m or N: along the motion, or the largest found over the workspace with the same rates,
    /// which is attained there.
    pub peak: Vec<f64>,
}

impl Scale {
    /// `None` over a workspace where a joint lacks a limit.
    pub fn new(arm: &Arm, domain: &Domain, motion: Option<&Motion>) -> Option<Self> {
        match (domain, motion) {
            (Domain::Workspace(limits), _) => {
                let rates = Rates::limits(arm)?;
                Some(Self { peak: workspace_peak_torque(arm, limits, &rates), rates })
            }
            (_, Some(motion)) => {
                Some(Self { rates: Rates::of(motion), peak: crate::bounds::peak_torque(arm, motion) })
            }
            (_, None) => None,
        }
    }
}

impl Scale {
    /// By joint, Ū over the joint's torque.
    fn shares(&self, multipliers: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        let of = |(i, peak): (usize, &f64)| multipliers(i).into_iter().map(|u| u / peak).collect();
        self.peak.iter().enumerate().map(of).collect()
    }
}

/// A model and its code.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The model.
    pub reduced: Reduced,
    /// How it computes the torque.
    pub form: Form,
    /// The torque.
    pub code: Graph,
}

/// Why a model to a tolerance is the exact one, in one sentence; `peak` is the largest torque by joint, N·m or N.
pub fn why_exact(lagrangian: &Lagrangian, peak: Option<&[f64]>, fraction: f64) -> String {
    let why = if lagrangian.terms() > LONG {
        format!("an expansion of {} terms is too long for a search of reduced models", lagrangian.terms())
    } else if peak.is_none_or(|peak| peak.iter().any(|&peak| peak <= 0.0)) {
        "a joint without torque has no tolerance".to_string()
    } else if BEYOND * fraction < reduction::STRICTEST {
        format!(
            "no reduced model is sought for tolerances below {:.2} %",
            100.0 * reduction::STRICTEST / BEYOND
        )
    } else {
        "no reduced model that was found within the tolerance is cheaper than the exact one".to_string()
    };
    why + ", so this is the exact model."
}

/// The cheapest among the exact model and the family of sparse ones whose certified torque error over the domain
/// stays within `fraction` of each joint's peak torque.
///
/// Cheap means few multiplications and additions of the code, with every sine-cosine pair as
/// [`crate::graph::TRIG_PAIR`]. The family of a larger fraction holds that of a smaller one, certificates do not depend on
/// it, and the first member in ascending price that is certified is taken, so that a larger fraction never costs more.
#[allow(clippy::too_many_arguments, reason = "what a model is chosen by, and who hears of it")]
pub fn cheapest(
    arm: &Arm,
    lagrangian: &Lagrangian,
    domain: &Domain,
    motion: Option<&Motion>,
    measure: &Measure,
    scale: Option<&Scale>,
    fraction: f64,
    exact: (Form, &Graph),
    progress: &dyn Progress,
) -> Choice {
    let unreduced = || Choice { reduced: reduction::exact(lagrangian), form: exact.0, code: exact.1.clone() };
    let Some(scale) = scale.filter(|scale| scale.peak.iter().all(|&peak| peak > 0.0)) else {
        return unreduced();
    };
    if lagrangian.terms() > LONG {
        return unreduced();
    }
    let shares = scale.shares(|i| scale.rates.multipliers(lagrangian, i));
    let everywhere = extremes(measure, domain, motion);
    let points = points(domain, &everywhere);
    let in_joints = Problem { lagrangian, absolute: None, shares: &shares, points: &points };
    let most = BEYOND * fraction;
    let family = match Coordinates::of(arm) {
        None => reduction::family(&in_joints, most),
        Some(coordinates) => {
            let absolute = Arc::new(Absolute::new(lagrangian, coordinates));
            let shares = scale.shares(|i| scale.rates.multipliers_in(&absolute, i));
            let lagrangian = &absolute.lagrangian;
            let absolute = Some(&absolute);
            reduction::family(&Problem { lagrangian, absolute, shares: &shares, points: &points }, most)
        }
    };
    let mut choices: Vec<Choice> = family
        .into_par_iter()
        .map(|member| {
            let reduced = member.model.reduced(lagrangian);
            let code = match &reduced.sparse {
                Some(model) => body::sparse(lagrangian, model),
                None => exact.1.clone(),
            };
            Choice { reduced, form: Form::Sparse, code }
        })
        .filter(|choice| choice.code.operations().price() < exact.1.operations().price())
        .collect();
    choices.sort_by_key(|choice| choice.code.operations().price());
    let limits: Vec<f64> = scale.peak.iter().map(|peak| fraction * peak).collect();
    let mut proofs = Proofs::default();
    let stage = Stage::new(progress, "models within the tolerance", choices.len());
    choices
        .into_iter()
        .find(|choice| {
            let _part = stage.part();
            let reduced = &choice.reduced;
            if !reduced.is_finite() || seen(lagrangian, reduced, &shares, &everywhere) > fraction {
                return false;
            }
            let certificates = proofs.of(lagrangian, reduced, domain, motion);
            let separate = separate_error(lagrangian, &certificates, &scale.rates);
            let part = separate.iter().zip(&limits).map(|(e, limit)| e / limit).fold(0.0, f64::max);
            let exceeds =
                || torque_exceeds(lagrangian, reduced, domain, motion, &certificates, &scale.rates, &limits);
            let hopeful = matches!(domain, Domain::Workspace(_)) || part <= HOPELESS;
            part <= 1.0 || hopeful && exceeds().is_none()
        })
        .unwrap_or_else(unreduced)
}

/// Certificates by coefficient and form: members of a family share most.
#[derive(Default)]
struct Proofs {
    known: BTreeMap<(usize, Vec<(usize, u64)>), Certificate>,
}

impl Proofs {
    fn of(
        &mut self,
        lagrangian: &Lagrangian,
        reduced: &Reduced,
        domain: &Domain,
        motion: Option<&Motion>,
    ) -> Vec<Certificate> {
        let key = |m: usize| (m, reduced.combinations[m].iter().map(|&(l, k)| (l, k.to_bits())).collect());
        let known = |m: usize| self.known.get(&key(m)).cloned();
        let all = certified_beside(lagrangian, reduced, domain, motion, &EFFORT, known);
        for (m, certificate) in all.iter().enumerate() {
            self.known.insert(key(m), certificate.clone());
        }
        all
    }
}

/// Largest Σ_m |r_m| `shares`_im over joints and `points`.
fn seen(lagrangian: &Lagrangian, reduced: &Reduced, shares: &[Vec<f64>], points: &[Vec<f64>]) -> f64 {
    let residuals: Vec<Combination> =
        (0..reduced.combinations.len()).map(|m| reduced.residual(lagrangian, m)).collect();
    let at = |q: &Vec<f64>| {
        let psi = lagrangian.evaluate_functions(q);
        let left: Vec<f64> = residuals.iter().map(|terms| evaluate(terms, &psi).abs()).collect();
        let row = |row: &Vec<f64>| row.iter().zip(&left).map(|(u, r)| u * r).sum::<f64>();
        shares.iter().map(row).fold(0.0, f64::max)
    };
    points.par_iter().map(at).reduce(|| 0.0, f64::max)
}

/// Points of the domain to fit to: few, evenly spread, with sides and corners.
fn points(domain: &Domain, all: &[Vec<f64>]) -> Vec<Vec<f64>> {
    match domain {
        Domain::Workspace(limits) => {
            let n = limits.len();
            let spread = Spread::new(n);
            let side = |u: &f64| (0.5 + STRETCH * (u - 0.5)).clamp(0.0, 1.0);
            let some = (0..POINTS).map(|index| spread.point(index).iter().map(side).collect::<Vec<_>>());
            let corners = 1_usize << n;
            let some_corners = (0..corners).step_by((corners / CORNERS).max(1)).map(|index| corner(index, n));
            some.chain(some_corners).map(|unit| in_box(limits, &unit)).collect()
        }
        // An odd stride, so that instants and sides of the box both take turns.
        _ => all.iter().step_by((all.len() / POINTS).max(1) | 1).cloned().collect(),
    }
}
