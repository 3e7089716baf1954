//! Mode `tolerance`: the cheapest model whose certified torque error is small enough.

mod points;
mod proofs;
mod simplified_arm;
pub(crate) mod sparse;

use std::sync::Arc;

use crate::arm::Arm;
use crate::bounds::{SCATTERED, TorqueScale, position_bound};
use crate::domain::{Domain, Measure};
use crate::graph::Graph;
use crate::lagrangian::{Absolute, Coordinates, Lagrangian};
use crate::model::Model;
use crate::parallel::Parallelize;
use crate::progress::{Progress, Stage};
use crate::reduction::{self, extremes};
use crate::torque::{self, Form};
use points::{points, seen_within};
use proofs::Proofs;
use sparse::SparseProblem;

/// Sparse members whose error at the points is above the tolerance by up to this factor are looked at, too: the error
/// jumps between one member and the next.
const BEYOND: f64 = 1.13;
/// Terms of the exact model beyond which no sparse one is sought: at a useful tolerance none would be cheaper than the
/// recursion.
const LONG: usize = 4000;
/// Code is made of the sparse members whose cost the search puts at no more than this times the exact one's: the graph
/// seldom saves more than the difference.
const SHARED: f64 = 1.25;
/// Recursions of simpler arms are sought until they save this part of the exact one's cost. Where a sparse model saves
/// more, none is sought: they rarely save so much.
const MOST: f64 = 0.45;
/// Of long models, those are tried whose coefficients' largest errors at the points leave this part of the tolerance.
const LIKELY: f64 = 0.93;

/// What a model is sought for.
#[derive(Clone, Copy)]
pub struct ToleranceRequest<'a> {
    /// The arm.
    pub arm: &'a Arm,
    /// Its exact model, every parameter known.
    pub lagrangian: &'a Lagrangian,
    /// Where the model must hold.
    pub domain: &'a Domain,
    /// Points of the domain.
    pub measure: &'a Measure,
    /// The torques that errors are compared with; `None` where they are unknown.
    pub scale: Option<&'a TorqueScale>,
    /// Form and code of the exact model.
    pub exact: (Form, &'a Graph),
    /// Who hears of it.
    pub progress: &'a dyn Progress,
}

impl ToleranceRequest<'_> {
    fn is_long(&self) -> bool {
        self.lagrangian.terms() > LONG
    }

    fn unreduced(&self) -> Model {
        let (form, code) = self.exact;
        Model { reduced: reduction::exact(self.lagrangian), form, code: code.clone() }
    }
}

/// Why a model of `arm` to a tolerance is the exact one, in one sentence; `peak` is the largest torque by joint, N·m or N.
pub fn why_exact(arm: &Arm, lagrangian: &Lagrangian, peak: Option<&[f64]>, fraction: f64) -> String {
    let neither = |sparse: String| {
        format!(
            "{sparse}, and no recursion of a simplified arm that was found within the tolerance is cheaper than the exact one"
        )
    };
    let still = arm.joints.iter().zip(peak.unwrap_or_default()).find(|(_, peak)| **peak <= 0.0);
    let why = if let Some((joint, _)) = still {
        format!("The exact model takes no torque of {}, so no part of it can be allowed", joint.name)
    } else if lagrangian.terms() > LONG {
        let terms = lagrangian.terms();
        neither(format!("An expansion of {terms} terms is too long for a search of sparse models"))
    } else if BEYOND * fraction < sparse::STRICTEST {
        let least = 100.0 * sparse::STRICTEST / BEYOND;
        neither(format!("No sparse model is sought for tolerances below {least:.2} %"))
    } else {
        "No reduced model that was found within the tolerance is cheaper than the exact one".to_string()
    };
    why + ", so this is the exact model."
}

/// The cheapest among the exact model, the family of sparse ones and the recursions of simpler arms whose certified
/// torque error over the domain stays within `fraction` of each joint's peak torque.
///
/// Cheap means few multiplications and additions of the code, with every sine-cosine pair as
/// [`crate::graph::TRIG_PAIR`]. The families of a larger fraction hold those of a smaller one, certificates do not depend on
/// it, and the first certified member in ascending cost is taken, so that a larger fraction never costs more.
pub fn cheapest(request: &ToleranceRequest, fraction: f64) -> Model {
    let Some(scale) = request.scale.filter(|scale| scale.peak.iter().all(|&peak| peak > 0.0)) else {
        return request.unreduced();
    };
    let cost = request.exact.1.operations().cost();
    let domain = request.domain.within_a_turn(request.arm, SCATTERED);
    let everywhere = extremes(request.measure, &domain);
    let points = points(&domain, &everywhere);
    let shares = scale.shares(|i| scale.rates.multipliers(request.lagrangian, i));
    let limits = scale.limits(fraction);
    if limits.iter().any(|limit| *limit <= 0.0) {
        return request.unreduced();
    }
    let mut proofs = Proofs::default();
    let mut first = |choices: Vec<Model>| {
        let stage = Stage::new(request.progress, "models within the tolerance", choices.len());
        choices.into_iter().find(|choice| {
            let _part = stage.part();
            let seen = || seen_within(request.lagrangian, &choice.reduced, &shares, &everywhere, fraction);
            choice.reduced.is_finite()
                && (request.is_long() || seen())
                && proofs.within(request, &choice.reduced, &limits)
        })
    };
    let sparse =
        if request.is_long() { Vec::new() } else { sparse(request, scale, &shares, &points, fraction) };
    let best = first(sparse);
    let least = if request.is_long() { 0 } else { cost - (MOST * cost as f64) as usize };
    let best = match best {
        Some(best) if best.cost() < least => return best,
        other => other,
    };
    let most = best.as_ref().map_or(cost, Model::cost);
    let problem = simplified_arm::ArmProblem {
        arm: request.arm,
        lagrangian: request.lagrangian,
        shares: &shares,
        points: &points,
    };
    let position_bound = position_bound(request.domain);
    let simpler = simplified_arm::family(&problem, fraction, least)
        .into_iter()
        .filter(|member| member.cost() < most && member.error <= fraction)
        .filter(|member| !request.is_long() || member.separate <= LIKELY * fraction);
    let mut simpler: Vec<_> = simpler.collect();
    simpler.sort_by_key(simplified_arm::ArmCandidate::cost);
    // One after the other: an expansion takes long where the model is.
    let simpler = simpler
        .into_iter()
        .find_map(|member| first(member.model(request.lagrangian, &position_bound).into_iter().collect()));
    simpler.or(best).unwrap_or_else(|| request.unreduced())
}

/// The sparse models that are cheaper than the exact one, in ascending cost.
fn sparse(
    request: &ToleranceRequest,
    scale: &TorqueScale,
    shares: &[Vec<f64>],
    points: &[Vec<f64>],
    fraction: f64,
) -> Vec<Model> {
    let ToleranceRequest { arm, lagrangian, exact, .. } = *request;
    let beyond = BEYOND * fraction;
    let absolute = Coordinates::of(arm).and_then(|coordinates| Absolute::new(lagrangian, coordinates));
    let family = match absolute.map(Arc::new) {
        None => sparse::family(&SparseProblem { lagrangian, absolute: None, shares, points }, beyond),
        Some(absolute) => {
            let shares = scale.shares(|i| scale.rates.multipliers_in(&absolute, i));
            let (lagrangian, absolute) = (&absolute.lagrangian, Some(&absolute));
            sparse::family(&SparseProblem { lagrangian, absolute, shares: &shares, points }, beyond)
        }
    };
    let most = exact.1.operations().cost();
    let mut choices: Vec<Model> = family
        .into_par_iter()
        .filter(|member| member.cost as f64 <= SHARED * most as f64)
        .map(|member| {
            let reduced = member.model.reduced(lagrangian);
            let code = match reduced.sparse() {
                Some(model) => torque::sparse(lagrangian, model),
                None => exact.1.clone(),
            };
            Model { reduced, form: Form::Sparse, code }
        })
        .filter(|choice| choice.cost() < most)
        .collect();
    choices.sort_by_key(Model::cost);
    choices
}
