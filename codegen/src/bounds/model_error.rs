//! What an emitted model leaves out: certificates, bounds, torque.

use super::{
    Bounds, Certificate, Effort, Met, Rates, Torque, TorqueScale, certified_telling, code_rounding,
    position_bound, published, recursion, recursion_rounding, separate_error, torque_error, vanishing,
    with_sines,
};
use crate::arm::{Arm, Uncertainty};
use crate::domain::Domain;
use crate::graph::Graph;
use crate::lagrangian::Lagrangian;
use crate::load::Loaded;
use crate::progress::Progress;
use crate::reduction::Reduced;
use crate::spec::{ScalarSpec, Spec};
use crate::torque::Form;
use crate::trig::Trig;

/// Where the torque error alone is what counts, no single coefficient is worth more boxes and more starts of a search.
const BOXES: usize = 2000;
const STARTS: usize = 4;

/// What bounds follow from.
pub(crate) struct ModelError<'a> {
    pub loaded: &'a Loaded,
    pub arm: &'a Arm,
    pub uncertainty: &'a Uncertainty,
    pub lagrangian: &'a Lagrangian,
    pub reduced: &'a Reduced,
    pub domain: &'a Domain,
    pub form: Form,
    /// The passivity torque.
    pub code: &'a Graph,
    pub sines: &'a Trig,
    /// What rounding the arm's rotations has changed.
    pub angles: Option<&'a Bounds>,
}

impl ModelError<'_> {
    /// A certificate for each coefficient, and the bounds that follow.
    pub fn bounds(&self, effort: &Effort, progress: &dyn Progress) -> (Vec<Certificate>, Bounds) {
        let Self { lagrangian, reduced, domain, sines, .. } = *self;
        let Spec { model, control, .. } = &self.loaded.spec;
        // A switching gain is made of the bounds themselves.
        let switches = control.as_ref().is_some_and(|control| control.law.is_robust());
        let effort = match model.tolerance() {
            Some(_) if !switches => {
                Effort { boxes: effort.boxes.min(BOXES), starts: effort.starts.min(STARTS), ..*effort }
            }
            _ => *effort,
        };
        let certificates = certified_telling(lagrangian, reduced, domain, &effort, progress);
        let (mut certificates, bounds) = if self.form == Form::Recursive && !sines.rounds() {
            self.recursive(certificates)
        } else {
            let certificates = with_sines(certificates, lagrangian, reduced, domain, sines);
            let bounds = Bounds::of(lagrangian, &certificates);
            (certificates, bounds)
        };
        let Some(angles) = self.angles else { return (certificates, bounds) };
        for (certificate, more) in certificates.iter_mut().zip(angles.certificates(lagrangian)) {
            certificate.bound = (certificate.bound + more.bound).next_up();
        }
        (certificates, bounds.plus(angles))
    }

    /// Those of the plain recursion with sines off by more than rounding: what they do to it, and what uncertain
    /// parameters do, which is what the `certificates` given say.
    fn recursive(&self, certificates: Vec<Certificate>) -> (Vec<Certificate>, Bounds) {
        let Self { lagrangian, reduced, domain, sines, .. } = *self;
        // Only what a law learns is in expanded form.
        let learnt =
            Reduced { combinations: vec![Vec::new(); reduced.combinations.len()], ..reduced.clone() };
        let certificates = with_sines(certificates, lagrangian, &learnt, domain, sines);
        let own = recursion(self.arm, &position_bound(domain), sines.error);
        let bounds = Bounds::of(lagrangian, &certificates).plus(&own);
        let add = |(mut certificate, more): (Certificate, Certificate)| {
            certificate.bound = (certificate.bound + more.bound).next_up();
            certificate.sines = (certificate.sines + more.bound).next_up();
            certificate
        };
        (certificates.into_iter().zip(own.certificates(lagrangian)).map(add).collect(), bounds)
    }

    /// What that costs in torque, rounding in f64 and of the arm's rotations included.
    pub fn torque(&self, certificates: &[Certificate], bounds: &Bounds, scale: TorqueScale) -> Torque {
        let known = self.uncertainty.parameters.is_empty();
        let fraction = self.loaded.spec.model.tolerance().filter(|_| known);
        let proved = fraction.map(|fraction| scale.limits(fraction));
        let single = self.single_rounding(&scale.rates);
        let own = self.error(certificates, bounds, &scale.rates, Sought::All(proved));
        let error = plus(own, single.as_deref());
        let rounding = plus(self.rounding().torque(&scale.rates), single.as_deref());
        Torque { error, peak: scale.peak, rounding, rates: scale.rates }
    }

    /// The same at the rates that a law meets, from its torque error without what f32 code rounds by.
    pub fn met(&self, error: Vec<f64>, rates: &Rates) -> Met {
        Met { error: plus(error, self.single_rounding(rates).as_deref()), rates: rates.clone() }
    }

    /// Bound on the torque error by joint for rates up to `rates`, N·m or N, without what f32 code rounds by. Without a `search` over
    /// the domain it is what the coefficients do if all are off by most at once.
    pub fn torque_error(
        &self,
        certificates: &[Certificate],
        bounds: &Bounds,
        rates: &Rates,
        search: bool,
    ) -> Vec<f64> {
        self.error(certificates, bounds, rates, if search { Sought::All(None) } else { Sought::Nothing })
    }

    /// Whether the search that found `torque` bounds it lower than the coefficients by themselves. Where it does not, it would only take
    /// time at other rates.
    pub fn search_pays(&self, certificates: &[Certificate], bounds: &Bounds, torque: &Torque) -> bool {
        let separate = self.torque_error(certificates, bounds, &torque.rates, false);
        torque.error.iter().zip(separate).any(|(found, separate)| *found < separate)
    }

    /// What f32 code rounds by, by joint, N·m or N, for rates up to `rates`; `None` for f64 code, whose rounding is part of every
    /// other bound.
    fn single_rounding(&self, rates: &Rates) -> Option<Vec<f64>> {
        let scalar = self.loaded.spec.emit.scalar;
        (scalar == ScalarSpec::F32).then(|| code_rounding(self.code, self.domain, rates, scalar.format()))
    }

    /// Bounds by joint, N·m or N, for rates up to `rates`.
    fn error(
        &self,
        certificates: &[Certificate],
        bounds: &Bounds,
        rates: &Rates,
        sought: Sought,
    ) -> Vec<f64> {
        let Self { lagrangian, reduced, domain, .. } = *self;
        let own: Vec<f64> = if self.form == Form::Recursive && reduced.is_exact() {
            bounds.torque(rates)
        } else {
            let (mut error, proved) = match sought {
                Sought::All(proved) => {
                    (torque_error(lagrangian, reduced, domain, certificates, rates), proved)
                }
                Sought::Nothing => (separate_error(lagrangian, certificates, rates), None),
            };
            for (i, (error, limit)) in error.iter_mut().zip(proved.into_iter().flatten()).enumerate() {
                let multipliers = rates.multipliers(lagrangian, i);
                let sines: f64 = certificates.iter().zip(&multipliers).map(|(c, u)| c.sines * u).sum();
                *error = error.min((limit.max(0.0) + sines).next_up());
            }
            let angles = self.angles.map_or_else(|| vec![0.0; error.len()], |angles| angles.torque(rates));
            error.iter().zip(angles).map(|(error, angles)| error + angles).collect()
        };
        let sum = |(own, rounding): (&f64, f64)| {
            // Where there is nothing to compute, nothing is off.
            if *own == 0.0 && rounding == 0.0 { 0.0 } else { (own + rounding).next_up() }
        };
        own.iter().zip(self.rounding().torque(rates)).map(sum).collect()
    }

    /// Rounding in f64 of what is not simplified, entry by entry; that of the rest is in its certificates.
    pub fn rounding(&self) -> Bounds {
        let Self { lagrangian, reduced, domain, .. } = *self;
        let position_bound = position_bound(domain);
        let recursion = || recursion_rounding(self.arm, &position_bound);
        if self.form == Form::Recursive && reduced.is_exact() {
            return recursion();
        }
        let each: Vec<f64> =
            (0..lagrangian.coefficients.len())
                .map(|m| {
                    if reduced.simplified[m] {
                        0.0
                    } else {
                        published(lagrangian, m, reduced, &position_bound)
                    }
                })
                .collect();
        let mut bounds = Bounds::new(lagrangian, &each);
        for (entry, most) in vanishing(lagrangian, &position_bound) {
            bounds.set(entry, most);
        }
        match self.form {
            Form::Recursive => bounds.plus(&recursion()),
            Form::Expanded | Form::Sparse => bounds,
        }
    }
}

/// How the torque error is bounded.
enum Sought {
    /// By a search over the domain; what the choice of a model has proved, perhaps with more work, is for sines within an ulp.
    All(Option<Vec<f64>>),
    /// By the bounds of the coefficients alone.
    Nothing,
}

/// The sum by joint, rounded up.
fn plus(mut error: Vec<f64>, more: Option<&[f64]>) -> Vec<f64> {
    for (error, more) in error.iter_mut().zip(more.into_iter().flatten()) {
        *error = (*error + more).next_up();
    }
    error
}
