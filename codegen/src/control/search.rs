//! The search for gains that keep a target: diagonal ones, in proportion to what each joint bears.
//!
//! T (λ_max(D⁻¹K) + λ_max(P12)) < 2 limits the whole gain on s, slope ρ/φ of the layer included, and a light wrist
//! bears less of it than the base: so joint i gets κ/(D⁻¹)_ii, with its least inertia over the domain. What is sought
//! are κ and three shares of it; every candidate is judged as given gains are.

use super::Stage;
use super::form::{BUDGET, TOLERANCE, fastest};
use super::guarantee::Judgement;
use super::inertia::Inertia;
use super::mix::{GRADED, LINEAR, Mix, START, STIFF, diagonal};
use super::region::{cells, position_bound};
use crate::check::Tuning;
use crate::error::Error;

/// Share of the sampled loop's limit that gains may use.
const USED: f64 = 0.85;
/// Judgements in which ρ and the layer made for it must agree.
const ROUNDS: usize = 4;
/// Halvings of the interval of exponents in which the smallest gain lies, and its lower end.
const HALVINGS: u32 = 6;
const SOFTEST: f64 = 1.0 / 256.0;
/// Least and largest ratio from one gain to the next, where a softer one is sought for the sake of a torque limit.
const SOFTER: [f64; 2] = [0.2, 0.8];

/// Errors relative to the room with which a search for one of several periods does not go on.
pub(super) const FAR: f64 = 2.0;

/// What the gains are to achieve.
pub(super) struct Target {
    /// Time in which a position error falls to 1/20, s.
    pub(super) time: f64,
    /// What |q_e| must stay within, by joint, rad or m.
    pub(super) room: Vec<f64>,
}

/// Gains and how near they come to the target.
pub(super) struct GainCandidate {
    pub(super) tuning: Tuning,
    pub(super) judged: Judgement,
    /// Largest |q_e| relative to the room; infinite where no level of V holds it.
    pub(super) position_bound: f64,
    /// Whether the guarantee holds inside the room, with the period's margin.
    pub(super) holds: bool,
    /// The worse of errors and period, relative to what is allowed.
    score: f64,
}

/// The arm as the search sees it.
pub(super) struct Scene<'a> {
    pub(super) stage: &'a Stage<'a>,
    pub(super) target: &'a Target,
    /// Largest (D⁻¹)_ii and d_ii over the domain.
    pub(super) mobility: Vec<f64>,
    pub(super) heaviest: Vec<f64>,
    /// λ_max(D⁻¹ diag(1/(D⁻¹)_ii)): what coupling adds to the joints by themselves.
    pub(super) coupling: f64,
    /// Whether these could be certified.
    pub(super) certified: bool,
}

impl<'a> Scene<'a> {
    pub(super) fn new(stage: &'a Stage<'a>, target: &'a Target) -> Self {
        let super::DesignProblem { arm, lagrangian, domain, uncertainty, .. } = *stage.problem;
        let n = arm.dof();
        let over = cells(domain, &domain.width().unwrap_or(vec![0.0; n]));
        let inertia =
            Inertia::of_family(arm, uncertainty, lagrangian, &position_bound(&over, n), stage.problem.angles);
        let extremes = inertia.largest(over.clone(), TOLERANCE, BUDGET / (n * n), |low, high| {
            let inverse = low.clone().cholesky().map(|factor| factor.inverse());
            let mobility = |i: usize| inverse.as_ref().map_or(f64::INFINITY, |m| m[(i, i)]);
            (0..n).map(mobility).chain((0..n).map(|i| high[(i, i)])).collect()
        });
        let certified = extremes.bound.iter().all(|b| b.is_finite());
        let values = if certified { extremes.bound } else { extremes.seen };
        let (mobility, heaviest) = (values[..n].to_vec(), values[n..].to_vec());
        let inertias: Vec<f64> = mobility.iter().map(|m| 1.0 / m).collect();
        let coupling = fastest(&inertia, over, &diagonal(&inertias)).rate;
        Self { stage, target, mobility, heaviest, coupling, certified }
    }

    /// The same arm before another target.
    pub(super) fn for_target<'b>(&'b self, target: &'b Target) -> Scene<'b> {
        let (mobility, heaviest) = (self.mobility.clone(), self.heaviest.clone());
        Scene { target, mobility, heaviest, ..*self }
    }

    /// Gains for `period` that hold and with which each joint by itself is fast enough, or those that come nearest;
    /// `None` where none are fast enough. The search ends where its first errors reach `give_up` rooms.
    pub(super) fn find_each(
        &self,
        period: f64,
        give_up: Option<f64>,
    ) -> Result<Option<GainCandidate>, Error> {
        let Some((mix, firmest)) = self.firmest(period, give_up)? else { return Ok(None) };
        let (most, firmest) = match firmest.holds {
            true => (1.0, firmest),
            false => match self.softer(period, mix, &firmest)? {
                Some(softer) => softer,
                None => return Ok(Some(firmest)),
            },
        };
        // Each in the middle between the softest gains that hold and the firmest that the period bears.
        let rho = firmest.judged.gain.clone();
        let holds = |gain: f64, mix: Mix| self.candidate(period, gain, mix, &rho, f64::INFINITY);
        let gain = middle(SOFTEST, most, |gain| Ok(holds(gain, mix)?.is_some_and(|c| c.holds)))?;
        let chosen = holds(gain, mix)?.filter(|candidate| candidate.holds);
        let (gain, chosen) = chosen.map_or((most, firmest), |chosen| (gain, chosen));
        let (w, pqq, omega) = (&chosen.tuning.w, &chosen.tuning.pqq, &chosen.tuning.omega);
        let rate = |i: usize| (w[i][i] + pqq[i][i] * pqq[i][i] / omega[i][i]) / self.heaviest[i];
        let most = (0..w.len()).map(rate).fold(0.0, f64::max);
        let capped = |cap: f64| holds(gain, Mix { cap, ..mix });
        let cap = middle(SOFTEST * most, most, |cap| Ok(capped(cap)?.is_some_and(|c| c.holds)))?;
        Ok(Some(capped(cap)?.filter(|candidate| candidate.holds).unwrap_or(chosen)))
    }

    /// The most gain for which the drives bear the first step, where it is this alone that `firmest` fails by; `None` where
    /// it is not, or less gain does not help.
    fn softer(
        &self,
        period: f64,
        mix: Mix,
        firmest: &GainCandidate,
    ) -> Result<Option<(f64, GainCandidate)>, Error> {
        // What the first step asks grows about as the gain does.
        let down = |asked: f64| (1.0 / asked).clamp(SOFTER[0], SOFTER[1]);
        let mut gain = down(firmest.judged.first_step);
        while firmest.score <= 1.0 && firmest.judged.first_step >= 1.0 && gain > SOFTEST {
            let candidate = self.candidate(period, gain, mix, &firmest.judged.gain, f64::INFINITY)?;
            match candidate {
                Some(candidate) if candidate.holds => return Ok(Some((gain, candidate))),
                // Too soft by now.
                Some(candidate) if candidate.score > 1.0 => break,
                Some(candidate) => gain *= down(candidate.judged.first_step),
                None => break,
            }
        }
        Ok(None)
    }

    /// The best mix of the most gain that the period bears; the search ends where its first errors reach `give_up` rooms.
    pub(super) fn firmest(
        &self,
        period: f64,
        give_up: Option<f64>,
    ) -> Result<Option<(Mix, GainCandidate)>, Error> {
        let none = vec![0.0; self.mobility.len()];
        let mut best: Option<(Mix, GainCandidate)> = None;
        let consider = |best: &mut Option<(Mix, GainCandidate)>, change: &dyn Fn(Mix) -> Mix| {
            let (mix, enough) = match best {
                Some((mix, candidate)) => (*mix, candidate.score),
                None => (START, f64::INFINITY),
            };
            let mix = change(mix);
            if best.as_ref().is_some_and(|(judged, _)| *judged == mix) {
                return Ok(());
            }
            if let Some(candidate) = self.candidate(period, 1.0, mix, &none, enough)?
                && (candidate.score < enough || best.is_none())
            {
                *best = Some((mix, candidate));
            }
            Ok::<(), Error>(())
        };
        for round in 0..2 {
            for graded in GRADED {
                consider(&mut best, &|mix| Mix { graded, ..mix })?;
            }
            let reached = |most: f64| best.as_ref().is_none_or(|(_, first)| first.position_bound >= most);
            if round == 0 && give_up.is_some_and(reached) {
                break;
            }
            for linear in LINEAR {
                consider(&mut best, &|mix| Mix { linear, ..mix })?;
            }
            for stiff in STIFF {
                consider(&mut best, &|mix| Mix { stiff, ..mix })?;
            }
            if best.as_ref().is_some_and(|(_, candidate)| candidate.holds) {
                break;
            }
        }
        Ok(best)
    }

    /// Gains with the share `gain` of what the period bears, with a layer for the ρ that they need themselves.
    ///
    /// From a `rho` below, layer and errors grow from round to round, so that errors beyond `enough` end the matter.
    fn candidate(
        &self,
        period: f64,
        gain: f64,
        mix: Mix,
        rho: &[f64],
        enough: f64,
    ) -> Result<Option<GainCandidate>, Error> {
        let mut rho = rho.to_vec();
        let mut last: Option<GainCandidate> = None;
        for _ in 0..ROUNDS {
            let Some(tuning) = self.tuning(period, gain, mix, &rho) else { break };
            // Only the layer differs from round to round.
            let facts = last.as_ref().map(|candidate| &candidate.judged.guarantee.inertia);
            let judged = match self.stage.sketch(&tuning, facts) {
                Ok(judged) => judged,
                Err(Error::Input(_)) => break,
                Err(other) => return Err(other),
            };
            let agree = judged.gain.iter().zip(&rho).all(|(new, old)| (new - old).abs() <= 0.03 * new);
            rho.clone_from(&judged.gain);
            let (settled, finite) = (judged.settled, judged.gain.iter().all(|r| r.is_finite()));
            let candidate = self.candidate_of(tuning, judged);
            let beyond = candidate.position_bound > enough;
            last = Some(candidate);
            if agree || beyond || !settled || !finite || !self.stage.problem.control.law.is_robust() {
                break;
            }
        }
        Ok(last)
    }

    fn candidate_of(&self, tuning: Tuning, judged: Judgement) -> GainCandidate {
        let share = |(error, room): (&f64, &f64)| error / room.max(f64::MIN_POSITIVE);
        let errors = judged.envelope.position_error.iter().zip(&self.target.room);
        let position_bound =
            if judged.settled { errors.map(share).fold(0.0, f64::max) } else { f64::INFINITY };
        let pace = tuning.period / judged.guarantee.period_max / USED;
        let holds = judged.guarantee.holds && position_bound <= 1.0 && pace <= 1.0;
        GainCandidate { tuning, score: position_bound.max(pace), position_bound, holds, judged }
    }
}

/// The geometric middle between `high` and the smallest number above `low` for which `holds`.
fn middle(low: f64, high: f64, holds: impl Fn(f64) -> Result<bool, Error>) -> Result<f64, Error> {
    let (mut below, mut above) = (low, high);
    for _ in 0..HALVINGS {
        let between = libm::sqrt(below * above);
        if holds(between)? { above = between } else { below = between }
    }
    Ok(libm::sqrt(above * high))
}
