//! Enclosures against dense points.

use std::sync::Arc;

use super::branch::{halves, maximum};
use super::entries::DIGITS;
use super::expansion::Expander;
use super::polynomial::{Polynomial, Scratch};
use super::region::{Cell, Region};
use super::residual::Residual;
use super::{Bounds, Effort};
use crate::domain::Domain;
use crate::lagrangian::{Function, MAX_JOINTS};
use crate::motion::Motion;
use crate::numerics::low_discrepancy::LowDiscrepancy;

/// Twenty terms over three revolute joints and a prismatic one, in slots 0, 1, 3 and 2.
fn terms() -> Vec<(Function, f64)> {
    let spread = LowDiscrepancy::new(6);
    let term = |index: usize| {
        let u = spread.point(index);
        let pick = |x: f64, low: i8, count: f64| low + (x * count) as i8;
        let mut kappa = [0; MAX_JOINTS];
        (kappa[0], kappa[1], kappa[3]) = (pick(u[0], 1, 2.0), pick(u[1], -2, 5.0), pick(u[2], -2, 5.0));
        let mut power = [0; MAX_JOINTS];
        power[2] = (u[3] * 3.0) as u8;
        (Function { kappa, power, sine: u[4] > 0.5, ..Function::ONE }, 2.0 * u[5] - 1.0)
    };
    (0..20).map(term).collect()
}

fn value(terms: &[(Function, f64)], q: &[f64]) -> f64 {
    terms.iter().map(|(psi, k)| k * psi.evaluate(q)).sum()
}

fn motion() -> Motion {
    Motion::Quintic { from: vec![-0.5, 0.2, 0.3, -1.0], to: vec![0.8, -0.9, 0.8, 0.7], duration: 2.0 }
}

#[test]
fn the_jet_is_value_gradient_and_hessian() {
    let terms = terms();
    let polynomial = Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k)));
    assert_eq!(polynomial.joints, [0, 1, 2, 3]);
    let q = [0.3, -1.2, 0.7, 2.1];
    let mut scratch = Scratch::default();
    let jet = polynomial.jet(&q, &mut scratch);
    assert!((jet.value - value(&terms, &q)).abs() < 1e-13);
    let h = 1e-5;
    for i in 0..4 {
        let (mut after, mut before) = (q, q);
        after[i] += h;
        before[i] -= h;
        let slope = (value(&terms, &after) - value(&terms, &before)) / (2.0 * h);
        assert!((jet.gradient[i] - slope).abs() < 1e-8, "gradient {i}");
        let (after, before) = (polynomial.jet(&after, &mut scratch), polynomial.jet(&before, &mut scratch));
        for j in 0..4 {
            let bend = (after.gradient[j] - before.gradient[j]) / (2.0 * h);
            assert!((jet.hessian[i][j] - bend).abs() < 1e-7, "hessian {i}{j}");
        }
    }
}

#[test]
fn no_point_of_a_cell_exceeds_its_enclosure() {
    let terms = terms();
    let tube = Domain::Tube(Arc::new(motion()), vec![0.2; 4]);
    let workspace = Domain::Workspace(vec![[-1.0, 2.0], [-3.0, 0.5], [0.1, 0.9], [-2.0, 2.0]]);
    for domain in [tube, workspace] {
        let polynomial = Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k)));
        let position_bound = super::position_bound(&domain);
        let residual = Residual::new(polynomial, &domain, &position_bound);
        let region = Region::new(&domain, &residual.polynomial.joints);
        let (count, mut scratch) = (region.variables(), Scratch::default());
        let mut expander = Expander::new(&residual);
        let (cells, inside) = (LowDiscrepancy::new(2 * count), LowDiscrepancy::new(count));
        for index in 0..300 {
            let unit = cells.point(index);
            let size = [1.0, 0.3, 0.1, 0.01][index % 4];
            let mut cell: Cell = region.root;
            for i in 0..count {
                let range = region.root.high[i] - region.root.low[i];
                cell.low[i] += range * unit[i] * (1.0 - size);
                cell.high[i] = (cell.low[i] + range * size * unit[count + i]).min(region.root.high[i]);
            }
            let frame = region.frame(&cell);
            let jet = residual.jet(&frame, &mut scratch);
            let direct = [1.0, -1.0].map(|sign| residual.enclose(&frame, &jet, sign));
            // An expansion holds for its own cell and for any in it.
            let expansion = expander.expand(&frame, f64::INFINITY).unwrap();
            let expanded = [1.0, -1.0].map(|sign| expander.enclose(&expansion, &frame, sign));
            let [_, corner] = halves(&cell, index % count);
            let [corner, _] = halves(&corner, (index / 3) % count);
            let part = region.frame(&corner);
            let nested = [1.0, -1.0].map(|sign| expander.enclose(&expansion, &part, sign));
            for (cell, [up, down], point) in (0..300).map(|point| match point % 3 {
                0 => (cell, direct, point),
                1 => (cell, expanded, point),
                _ => (corner, nested, point),
            }) {
                let u = inside.point(point);
                let x: Vec<f64> =
                    (0..count).map(|i| cell.low[i] + u[i] * (cell.high[i] - cell.low[i])).collect();
                let q = position(domain.motion(), &x);
                let f = value(&terms, &q);
                assert!(f <= up.upper && -f <= down.upper, "cell {index}: {f} {} {}", up.upper, down.upper);
                for i in (0..count).filter(|&i| up.slope[i] != 0) {
                    let mut further = x.clone();
                    further[i] = cell.high[i];
                    let rise = value(&terms, &position(domain.motion(), &further)) - f;
                    assert!(rise * f64::from(up.slope[i]) >= -1e-13, "cell {index}, slope {i}: {rise}");
                }
            }
        }
    }
}

fn position(motion: Option<&Motion>, x: &[f64]) -> Vec<f64> {
    match motion {
        Some(motion) => motion.at(x[4]).q.iter().zip(x).map(|(q, e)| q + e).collect(),
        None => x.to_vec(),
    }
}

#[test]
fn the_excess_over_the_quadratic_falls_with_the_third_power() {
    let terms = terms();
    let domain = Domain::Workspace(vec![[-1.0, 1.0]; 4]);
    let polynomial = Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k)));
    let residual = Residual::new(polynomial, &domain, &[1.0; 4]);
    let region = Region::new(&domain, &residual.polynomial.joints);
    let mut scratch = Scratch::default();
    // Along one variable the quadratic is maximised exactly, so only the remainder is left.
    let mut excess = |w: f64| {
        let mut cell = Region::point(&[0.3, -0.4, 0.5, 0.2]);
        (cell.low[1], cell.high[1]) = (-0.4 - w, -0.4 + w);
        let frame = region.frame(&cell);
        let enclosure = residual.enclose(&frame, &residual.jet(&frame, &mut scratch), 1.0);
        let at = |i: i32| value(&terms, &[0.3, -0.4 + w * f64::from(i) / 1000.0, 0.5, 0.2]);
        enclosure.upper - (-1000..=1000).map(at).fold(f64::MIN, f64::max)
    };
    let (wide, narrow) = (excess(0.04), excess(0.01));
    assert!(narrow > 0.0 && (50.0..80.0).contains(&(wide / narrow)), "{wide} {narrow}");
}

#[test]
fn a_joint_maximum_is_the_largest_of_the_separate_ones_for_fewer_boxes() {
    let domain = Domain::Tube(Arc::new(motion()), vec![0.2; 4]);
    let position_bound = super::position_bound(&domain);
    // What uncertain parameters do to a residual: each vertex of their box changes a few of its coefficients, and at
    // some a joint drops out.
    let vertex = |bits: usize| {
        let mut terms = terms();
        for (l, (_, k)) in terms.iter_mut().enumerate() {
            *k *= if bits >> (l % 3) & 1 == 1 { 1.0 + 0.1 * l as f64 } else { 1.0 };
        }
        if bits == 4 {
            terms.retain(|(psi, _)| psi.power[2] == 0);
        }
        let polynomial = Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k)));
        Residual::new(polynomial, &domain, &position_bound)
    };
    let residuals: Vec<Residual> = (0..8).map(vertex).collect();
    let effort = Effort { boxes: 20_000, ..Effort::default() };
    let joint = maximum(&residuals, &domain, &effort, 0.0);
    let separate: Vec<_> = residuals
        .iter()
        .map(|residual| maximum(std::slice::from_ref(residual), &domain, &effort, 0.0))
        .collect();
    let found = separate.iter().map(|proof| proof.found.height).fold(0.0, f64::max);
    let upper = separate.iter().map(|proof| proof.upper).fold(0.0, f64::max);
    assert!((joint.found.height - found).abs() <= 1e-3 * found, "{} {found}", joint.found.height);
    assert!(joint.upper >= found && upper >= joint.found.height);
    assert!(joint.upper <= (1.0 + effort.tolerance) * joint.found.height);
    assert!((joint.found.height - separate[joint.residual].found.height).abs() <= 1e-3 * found);
    let boxes: usize = separate.iter().map(|proof| proof.boxes).sum();
    assert!(joint.boxes < boxes / 2, "{} of {boxes}", joint.boxes);
    assert_eq!(maximum(&[], &domain, &effort, 0.0), super::branch::Proof::default());
}

#[test]
fn an_expansion_is_near_the_residual_and_its_bounds_nearer_than_the_residual_s() {
    let terms = terms();
    let domain = Domain::Workspace(vec![[-1.0, 1.0]; 4]);
    let polynomial = Polynomial::new(terms.iter().map(|(psi, k)| (psi, *k)));
    let residual = Residual::new(polynomial, &domain, &[1.0; 4]);
    let region = Region::new(&domain, &residual.polynomial.joints);
    let (mut expander, mut scratch) = (Expander::new(&residual), Scratch::default());
    let mut cell = Region::point(&[0.3, -0.4, 0.5, 0.2]);
    for i in 0..4 {
        (cell.low[i], cell.high[i]) = (cell.low[i] - 0.03, cell.high[i] + 0.03);
    }
    let frame = region.frame(&cell);
    assert!(expander.expand(&frame, 1e-9).is_none());
    // With a hair of room all orders are kept, with more the upper ones are not worth their work.
    for (limit, orders) in [(1e-6, 5), (1e-1, 3)] {
        let expansion = expander.expand(&frame, limit).unwrap();
        assert_eq!(expansion.order, orders);
        for x in [[0.3, -0.4, 0.5, 0.2], [0.32, -0.42, 0.48, 0.21]] {
            let frame = region.frame(&Region::point(&x));
            let jet = residual.jet(&frame, &mut scratch);
            for sign in [1.0, -1.0] {
                let at = expander.enclose(&expansion, &frame, sign);
                assert!(at.least <= sign * jet.value && sign * jet.value <= at.upper);
                assert!(at.upper - at.least <= 2.1 * limit);
            }
        }
        let jet = residual.jet(&frame, &mut scratch);
        if limit < 1e-4 {
            let (direct, expanded) =
                (residual.enclose(&frame, &jet, 1.0), expander.enclose(&expansion, &frame, 1.0));
            assert!(expanded.upper < direct.upper, "{} {}", expanded.upper, direct.upper);
        }
    }
}

#[test]
fn published_bounds_have_few_digits_and_never_lie_below() {
    let spread = LowDiscrepancy::new(1);
    let value = |index: usize| 10.0 * spread.point(index)[0] + 1e-7;
    let row = |from: usize| (from..from + 3).map(value).collect::<Vec<f64>>();
    let own = Bounds {
        d: (0..3).map(|i| row(3 * i)).collect(),
        h: (0..3).map(|i| (0..3).map(|j| row(9 + 9 * i + 3 * j)).collect()).collect(),
        b: row(40),
        g: row(50),
    };
    let all = |bounds: &Bounds| -> Vec<f64> {
        let h = bounds.h.iter().flatten();
        bounds.d.iter().chain(h).chain([&bounds.b, &bounds.g]).flatten().copied().collect()
    };
    let published = all(&own.clone().rounded_up());
    assert_eq!(published.len(), 9 + 27 + 6);
    for (own, published) in all(&own).into_iter().zip(published) {
        assert!(own <= published && published <= own * (1.0 + 1e-5), "{own} {published}");
        let mantissa = format!("{published:e}");
        let digits = mantissa.split('e').next().map_or(0, |m| m.chars().filter(char::is_ascii_digit).count());
        assert!(digits <= DIGITS, "{published}");
    }
}
