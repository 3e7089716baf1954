//! A weighted sum of absolute residuals, and the same of their second derivatives.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::spread;
use super::polynomial::Polynomial;
use super::residual::Residual;
use super::rounding::ENCLOSURE;

/// One residual in the sum.
pub(super) struct Part<'a> {
    /// The residual at the vertices of the box of uncertain parameters; |r_m| is the largest of them.
    pub vertices: &'a [Residual],
    /// What it is multiplied by.
    pub multiplier: f64,
    /// It exceeds this nowhere.
    pub cap: f64,
}

/// What branch and bound says of a sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    /// A value that the sum attains.
    pub found: f64,
    /// It exceeds this nowhere.
    pub upper: f64,
}

/// Where to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stop {
    /// Relative distance of the two values.
    pub tolerance: f64,
    /// Cells at most.
    pub cells: usize,
    /// It is settled once both values are on the same side of this.
    pub limit: Option<f64>,
}

/// Σ_m Ū_m |r_m|, |r_m| the largest over the vertices of the box of uncertain parameters.
pub(super) struct Sum {
    /// The joints on which it depends, ascending.
    pub joints: Vec<usize>,
    members: Vec<Member>,
    /// Σ_m Ū_m Σ_l |c_l|.
    pub size: f64,
}

struct Member {
    multiplier: f64,
    vertices: Vec<Polynomial>,
}

impl Sum {
    /// That of `parts`.
    pub fn new<'a>(parts: impl Iterator<Item = &'a Part<'a>>) -> Self {
        let member = |part: &Part| Member {
            multiplier: part.multiplier,
            vertices: part.vertices.iter().map(|residual| residual.polynomial.clone()).collect(),
        };
        Self::of(parts.map(member).collect())
    }

    fn of(members: Vec<Member>) -> Self {
        let all = members.iter().flat_map(|member| &member.vertices);
        let joints: BTreeSet<usize> = all.flat_map(|f| f.joints.iter().copied()).collect();
        let size = |member: &Member| {
            let one = |f: &Polynomial| f.terms().map(|(size, _)| size).sum::<f64>();
            member.multiplier * member.vertices.iter().map(one).fold(0.0, f64::max)
        };
        Self { joints: joints.into_iter().collect(), size: members.iter().map(size).sum(), members }
    }

    /// Σ_m Ū_m |∂²r_m/∂q²| for the position q of `joint`.
    pub fn curvature(&self, joint: usize) -> Self {
        let member = |member: &Member| {
            let curved = |f: &Polynomial| Some(f.curvature(f.joints.iter().position(|&j| j == joint)?));
            let vertices: Vec<Polynomial> = member.vertices.iter().filter_map(curved).collect();
            (!vertices.is_empty()).then_some(Member { multiplier: member.multiplier, vertices })
        };
        Self::of(self.members.iter().filter_map(member).collect())
    }

    /// Bound on Σ_m Ū_m |∂²r_m/∂q²| for the position q of `joint`, over the box `limits`.
    pub fn curvature_within(&self, joint: usize, limits: &[[f64; 2]]) -> f64 {
        let one = |f: &Polynomial| {
            let position_bound: Vec<f64> =
                f.joints.iter().map(|&j| limits[j][0].abs().max(limits[j][1].abs())).collect();
            f.joints
                .iter()
                .position(|&j| j == joint)
                .map_or(0.0, |slot| f.curvature_within(slot, &position_bound))
        };
        let member = |m: &Member| m.multiplier * m.vertices.iter().map(one).fold(0.0, f64::max);
        self.members.iter().map(member).sum::<f64>() * (1.0 + ENCLOSURE)
    }

    /// Its values on the grid of `axes`, one for each of `joints`, the first running fastest.
    pub fn on_grid(&self, joints: &[usize], axes: &[Vec<f64>]) -> Vec<f64> {
        let axis = |joint: &usize| {
            let slot = joints.iter().position(|j| j == joint);
            slot.map_or([].as_slice(), |slot| axes[slot].as_slice())
        };
        // Sums over the same joints are spread over the others together.
        let mut sums: BTreeMap<Vec<usize>, Vec<f64>> = BTreeMap::new();
        for Member { multiplier, vertices } in &self.members {
            let own: BTreeSet<usize> = vertices.iter().flat_map(|f| f.joints.iter().copied()).collect();
            let own: Vec<usize> = own.into_iter().collect();
            let sizes: Vec<usize> = own.iter().map(|joint| axis(joint).len()).collect();
            let mut largest = vec![0.0_f64; sizes.iter().product()];
            for f in vertices {
                let values = f.on_grid(&f.joints.iter().map(axis).collect::<Vec<_>>());
                spread(&f.joints, &own, &sizes, |slot, i| largest[slot] = largest[slot].max(values[i].abs()));
            }
            let sum = sums.entry(own).or_insert_with(|| vec![0.0; largest.len()]);
            sum.iter_mut().zip(&largest).for_each(|(sum, r)| *sum += multiplier * r);
        }
        let sizes: Vec<usize> = axes.iter().map(Vec::len).collect();
        let mut out = vec![0.0; sizes.iter().product()];
        for (own, values) in &sums {
            spread(own, joints, &sizes, |slot, i| out[slot] += values[i]);
        }
        out
    }
}
