//! One residual over one domain: enclosures of its cells, and where it only rises.

use super::envelope::{Enclosure, Envelope};
use super::polynomial::{Jet, Polynomial, Scratch};
use super::region::{Cell, Frame, Region};
use super::tensors::Tensors;
use crate::domain::Domain;

/// A polynomial with all that its enclosures need.
#[derive(Clone, Debug)]
pub struct Residual {
    /// f.
    pub polynomial: Polynomial,
    /// Bounds on |q_j|, one for each of the polynomial's joints.
    pub position_bound: Vec<f64>,
    /// Bounds over the whole domain.
    envelope: Envelope,
}

impl Residual {
    /// Prepares `polynomial` for `domain`, in which |q_j| ≤ `position_bound`.
    pub fn new(polynomial: Polynomial, domain: &Domain, position_bound: &[f64]) -> Self {
        let position_bound: Vec<f64> = polynomial.joints.iter().map(|&j| position_bound[j]).collect();
        let tensors = Tensors::new(polynomial.terms(), |slot| polynomial.prismatic[slot], &position_bound);
        let region = Region::new(domain, &polynomial.joints);
        let widest = region.frame(&region.root).total;
        let slack = vec![0.0; position_bound.len()];
        let envelope = Envelope::new(tensors, &widest, &position_bound, 0.0, slack);
        Self { polynomial, position_bound, envelope }
    }

    /// The jet at the centre of `frame`.
    pub fn jet(&self, frame: &Frame, scratch: &mut Scratch) -> Jet {
        self.polynomial.jet(&frame.centre[..self.polynomial.joints.len()], scratch)
    }

    /// Encloses σf over the positions of `frame`, given the jet at its centre.
    pub fn enclose(&self, frame: &Frame, jet: &Jet, sign: f64) -> Enclosure {
        self.envelope.enclose(frame, jet, sign)
    }
}

/// Encloses a function over `cell` by `enclose`, first shrinking it to the sides on which σf must be largest. `None`
/// where no maximum of the whole region can lie in the cell: σf strictly rises beyond one of its inner sides.
pub fn narrow(
    region: &Region,
    mut cell: Cell,
    mut enclose: impl FnMut(&Frame) -> Enclosure,
) -> Option<(Cell, Enclosure)> {
    loop {
        let found = enclose(&region.frame(&cell));
        let mut narrowed = false;
        for i in 0..region.variables() {
            match found.slope[i] {
                1 if cell.high[i] < region.root.high[i] => return None,
                -1 if cell.low[i] > region.root.low[i] => return None,
                1 => cell.low[i] = cell.high[i],
                -1 => cell.high[i] = cell.low[i],
                _ => continue,
            }
            narrowed = true;
        }
        if !narrowed {
            return Some((cell, found));
        }
    }
}
