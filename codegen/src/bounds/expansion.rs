//! A residual expanded about a point: cells near it are enclosed by a polynomial of a few hundred terms, whose
//! derivatives are bounded after what cancels between the residual's own terms.

use std::rc::Rc;

use super::envelope::{Enclosure, Envelope};
use super::polynomial::{Complex, Polynomial, times};
use super::region::Frame;
use super::residual::Residual;
use super::rounding::ENCLOSURE;
use super::taylor::{Buffers, Monomials, ORDER, degree, jet};
use super::tensors::Tensors;
use crate::lagrangian::MAX_JOINTS;

/// Expansions of one residual at a time; each takes up to 20 kB.
const MOST: usize = 4096;

/// Least order of an expansion: below it the bound on the third derivatives would be empty.
const LEAST: usize = 3;

/// Makes expansions of one residual.
#[derive(Clone, Debug)]
pub struct Expander<'a> {
    residual: &'a Residual,
    /// |c_l| times the largest powers of the prismatic coordinates, and by joint how fast the term varies: no
    /// directional derivative of order a along δ exceeds |c_l| (Σ_j rate_j |δ_j|)^a.
    terms: Vec<(f64, [f64; MAX_JOINTS])>,
    /// Σ_l |c_l|.
    size: f64,
    /// Σ_l |c_l| rate_j, by joint.
    slope: Vec<f64>,
    /// Derivatives over one joint more, by number of joints below: exponent in the new joint and index below.
    steps: Vec<Vec<(usize, usize)>>,
    /// By order.
    monomials: Vec<Monomials>,
    /// Shared by all expansions in use.
    alive: Rc<()>,
    buffers: Buffers,
    below: Vec<Complex>,
    above: Vec<Complex>,
    turned: Vec<Complex>,
}

/// The expansion about one point, good for all positions near it.
#[derive(Clone, Debug)]
pub struct Expansion {
    origin: [f64; MAX_JOINTS],
    /// Degree of the polynomial.
    pub order: usize,
    coefficients: Vec<f64>,
    envelope: Envelope,
    /// Counts those in use.
    _alive: Rc<()>,
}

impl<'a> Expander<'a> {
    /// Prepares the expansions of `residual`.
    pub fn new(residual: &'a Residual) -> Self {
        let Polynomial { joints, prismatic, .. } = &residual.polynomial;
        let k = joints.len();
        let term = |(size, exponents): (f64, &[i8])| {
            let (mut most, mut rates) = (size, [0.0; MAX_JOINTS]);
            for slot in 0..k {
                let (e, position_bound) = (f64::from(exponents[slot]).abs(), residual.position_bound[slot]);
                if !prismatic[slot] {
                    rates[slot] = e;
                } else if e > 0.0 && position_bound > 0.0 {
                    rates[slot] = e / position_bound;
                    most *= libm::pow(position_bound, e);
                }
            }
            (most, rates)
        };
        let terms: Vec<_> = residual.polynomial.terms().map(term).collect();
        let mut steps = Vec::new();
        let mut degrees = vec![0];
        for _ in 0..k {
            let pair = |a: usize| {
                let below = degrees.iter().enumerate().filter(move |(_, d)| *d + a <= ORDER);
                below.map(move |(index, d)| (a, index, d + a))
            };
            let all: Vec<(usize, usize, usize)> = (0..=ORDER).flat_map(pair).collect();
            steps.push(all.iter().map(|&(a, index, _)| (a, index)).collect());
            degrees = all.into_iter().map(|(_, _, degree)| degree).collect();
        }
        Self {
            residual,
            size: terms.iter().map(|(size, _)| size).sum(),
            slope: (0..k).map(|slot| terms.iter().map(|(size, rates)| size * rates[slot]).sum()).collect(),
            terms,
            steps,
            monomials: (0..=ORDER).map(|order| Monomials::new(k, order)).collect(),
            alive: Rc::new(()),
            buffers: Buffers::default(),
            below: Vec::new(),
            above: Vec::new(),
            turned: Vec::new(),
        }
    }

    /// Expands about the centre of `frame`, for all positions of the frame. `None` where that would leave a remainder
    /// above `limit`, or where too many expansions are in use.
    pub fn expand(&mut self, frame: &Frame, limit: f64) -> Option<Expansion> {
        if Rc::strong_count(&self.alive) > MOST {
            return None;
        }
        let k = self.residual.polynomial.joints.len();
        // Rounded centres of cells stay inside.
        let position_bound = &self.residual.position_bound;
        let wider = |(t, position_bound): (&f64, &f64)| t * (1.0 + 1e-9) + 1e-12 * (1.0 + position_bound);
        let total: Vec<f64> = frame.total.iter().zip(position_bound).map(wider).collect();
        let (mut remainder, mut slack) = self.beyond(&total, limit)?;
        let mut coefficients = self.derivatives(&frame.centre[..k]);

        // What the highest orders hold can be less than what is left out in any case.
        let mut order = ORDER;
        while order > LEAST {
            let (mut dropped, mut slopes) = (0.0, vec![0.0; k]);
            for (c, exponents) in coefficients.iter().zip(&self.monomials[order].exponents) {
                if degree(exponents) == order {
                    let size = c.abs() * monomial(exponents, &total);
                    dropped += size;
                    for i in (0..k).filter(|&i| total[i] > 0.0) {
                        slopes[i] += f64::from(exponents[i]) * size / total[i];
                    }
                }
            }
            if remainder + dropped > limit {
                break;
            }
            remainder += dropped;
            slack.iter_mut().zip(slopes).for_each(|(slack, slope)| *slack += slope);
            let mut exponents = self.monomials[order].exponents.iter();
            coefficients.retain(|_| exponents.next().is_some_and(|e| degree(e) < order));
            order -= 1;
        }
        let terms = coefficients.iter().zip(&self.monomials[order].exponents);
        let terms = terms.map(|(c, exponents)| (c.abs(), exponents.as_slice()));
        let tensors = Tensors::new(terms, |_| true, &total);
        let widest: Vec<f64> = total.iter().map(|t| 2.0 * t).collect();
        let more = 1.0 + 1e-9;
        slack.iter_mut().for_each(|slack| *slack *= more);
        let envelope =
            Envelope::new(tensors, &widest, &self.residual.position_bound, remainder * more, slack);
        let alive = Rc::clone(&self.alive);
        Some(Expansion { origin: frame.centre, order, coefficients, envelope, _alive: alive })
    }

    /// Encloses σf over a frame for which `expansion` is good.
    pub fn enclose(&mut self, expansion: &Expansion, frame: &Frame, sign: f64) -> Enclosure {
        let mut at = [0.0; MAX_JOINTS];
        for i in 0..MAX_JOINTS {
            at[i] = frame.centre[i] - expansion.origin[i];
        }
        let monomials = &self.monomials[expansion.order];
        let jet = jet(monomials, &expansion.coefficients, &at, &mut self.buffers);
        expansion.envelope.enclose(frame, &jet, sign)
    }

    /// Bounds on the value and the slopes of what an expansion leaves out within `total` of its origin, its own
    /// rounding included; `None` where the value may exceed `limit`.
    ///
    /// A coefficient of order a errs by [`ENCLOSURE`] Σ_l |c_l| rate^a/a!; summed over all orders, by e^{Σ rate δ}.
    fn beyond(&self, total: &[f64], limit: f64) -> Option<(f64, Vec<f64>)> {
        let factorial: f64 = (1..=ORDER).map(|a| a as f64).product();
        let (mut value, mut slopes, mut largest) = (0.0, vec![0.0; total.len()], 0.0_f64);
        for (size, rates) in &self.terms {
            let x: f64 = rates.iter().zip(total).map(|(r, t)| r * t).sum();
            let slope = (0..ORDER).fold(size / factorial, |power, _| power * x);
            value += slope * x / (ORDER + 1) as f64;
            if value > limit {
                return None;
            }
            slopes.iter_mut().zip(rates).for_each(|(sum, rate)| *sum += slope * rate);
            largest = largest.max(x);
        }
        let noise = ENCLOSURE * libm::exp(largest);
        value += noise * self.size;
        slopes.iter_mut().zip(&self.slope).for_each(|(sum, slope)| *sum += noise * slope);
        (value <= limit).then_some((value, slopes))
    }

    /// All derivatives up to [`ORDER`] at `q`, divided by their factorials.
    fn derivatives(&mut self, q: &[f64]) -> Vec<f64> {
        let polynomial = &self.residual.polynomial;
        let k = polynomial.joints.len();
        let Self { below, above, turned, .. } = self;
        below.clear();
        below.extend_from_slice(&polynomial.coefficients);
        for (slot, level) in polynomial.levels.iter().enumerate().rev() {
            let factors = factors(q[slot], polynomial.largest[slot], polynomial.angle(slot));
            let steps = &self.steps[k - 1 - slot];
            // Those without a derivative in the new joint come first.
            let inner = steps.iter().filter(|(a, _)| *a == 0).count();
            above.clear();
            above.resize((level.starts.len() - 1) * steps.len(), [0.0; 2]);
            for (group, out) in above.chunks_exact_mut(steps.len()).enumerate() {
                for child in level.starts[group]..level.starts[group + 1] {
                    let (factor, scales) = factors[level.factor[child]];
                    turned.clear();
                    turned
                        .extend(below[child * inner..(child + 1) * inner].iter().map(|&c| times(factor, c)));
                    let constant = scales[1..].iter().all(|&scale| scale == 0.0);
                    let count = if constant { inner } else { steps.len() };
                    for (out, &(a, index)) in out[..count].iter_mut().zip(steps) {
                        let [re, im] = turned[index];
                        out[0] += scales[a] * re;
                        out[1] += scales[a] * im;
                    }
                }
            }
            std::mem::swap(below, above);
        }
        // Each derivative of a revolute factor brings a factor i.
        let turns = |exponents: &[i8; MAX_JOINTS]| -> usize {
            (0..k).filter(|&slot| !polynomial.prismatic[slot]).map(|slot| exponents[slot] as usize).sum()
        };
        let real = |(c, exponents): (&Complex, &[i8; MAX_JOINTS])| match turns(exponents) % 4 {
            0 => c[0],
            1 => -c[1],
            2 => -c[0],
            _ => c[1],
        };
        below.iter().zip(&self.monomials[ORDER].exponents).map(real).collect()
    }
}

/// For all exponents from −largest to largest a factor φ and what its derivatives divided by their factorials are
/// times φ, without the powers of i; φ = 1 for a prismatic joint.
fn factors(q: f64, largest: i8, angle: Option<f64>) -> Vec<(Complex, [f64; ORDER + 1])> {
    let unit = angle.unwrap_or(1.0);
    let (sin, cos) = libm::sincos(q * unit);
    let factor = |e: i8| {
        let mut scales = [0.0; ORDER + 1];
        let top = usize::from(e.unsigned_abs());
        if angle.is_none() {
            // The binomial theorem; there are no negative powers.
            let mut binomial = 1.0;
            for a in 0..=top.min(ORDER) {
                scales[a] = (a..top).fold(binomial, |power, _| power * q);
                binomial = binomial * (top - a) as f64 / (a + 1) as f64;
            }
            return ([1.0, 0.0], scales);
        }
        scales[0] = 1.0;
        for a in 1..=ORDER {
            scales[a] = scales[a - 1] * (f64::from(e) * unit) / a as f64;
        }
        let turn = [cos, if e < 0 { -sin } else { sin }];
        ((0..top).fold([1.0, 0.0], |power, _| times(power, turn)), scales)
    };
    (-largest..=largest).map(factor).collect()
}

/// δ^a at `total`.
fn monomial(exponents: &[i8; MAX_JOINTS], total: &[f64]) -> f64 {
    exponents.iter().zip(total).fold(1.0, |product, (&e, t)| (0..e).fold(product, |p, _| p * t))
}
