//! Certificates of the models that are looked at.

use std::collections::BTreeMap;

use super::ToleranceRequest;
use crate::bounds::{Certificate, Effort, certified_beside, separate_error, torque_exceeds};
use crate::domain::Domain;
use crate::reduction::Reduced;

/// Work for each coefficient's certificate.
const EFFORT: Effort = Effort { tolerance: 0.03, boxes: 2000, starts: 3, seek_tube: false };
/// Around a motion, where the sum of the coefficients' largest errors exceeds the limit by more than this, the sharper
/// sum of the errors at the same position is not tried: its proof would not end.
const SEPARATE_MOST: f64 = 1.8;

/// A coefficient, what it is made of, and what it can round by.
type Key = (usize, Vec<(usize, u64)>, [u64; 3]);

/// Certificates by coefficient and form: members of a family share most.
#[derive(Default)]
pub(super) struct Proofs {
    known: BTreeMap<Key, Certificate>,
}

impl Proofs {
    /// Whether the torque errors of `reduced` are certified to stay within `limits`, N·m or N.
    pub fn within(&mut self, request: &ToleranceRequest, reduced: &Reduced, limits: &[f64]) -> bool {
        let ToleranceRequest { lagrangian, .. } = *request;
        let domain = &request.domain.within_a_turn(request.arm, 1.0);
        let Some(scale) = request.scale else { return false };
        let certificates = self.of(request, domain, reduced);
        let separate = separate_error(lagrangian, &certificates, &scale.rates);
        let part = separate.iter().zip(limits).map(|(e, limit)| e / limit).fold(0.0, f64::max);
        let exceeds = || torque_exceeds(lagrangian, reduced, domain, &certificates, &scale.rates, limits);
        let hopeful = match domain {
            Domain::Workspace(_) => true,
            _ => part <= SEPARATE_MOST,
        };
        part <= 1.0 || !request.is_long() && hopeful && exceeds().is_none()
    }

    fn of(&mut self, request: &ToleranceRequest, domain: &Domain, reduced: &Reduced) -> Vec<Certificate> {
        let key = |m: usize| -> Key {
            let terms = reduced.combinations[m].iter().map(|&(l, k)| (l, k.to_bits())).collect();
            let (size, count) = reduced.sparse().map_or((0.0, 0), |sparse| sparse.magnitude(m));
            let recursion = reduced.simplified_arm().map_or(0.0, |simplified_arm| simplified_arm.rounding[m]);
            (m, terms, [size.to_bits(), recursion.to_bits(), count as u64])
        };
        let known = |m: usize| self.known.get(&key(m)).cloned();
        let all = certified_beside(request.lagrangian, reduced, domain, &EFFORT, known);
        for (m, certificate) in all.iter().enumerate() {
            self.known.insert(key(m), certificate.clone());
        }
        all
    }
}
