//! Grids of positions, the first joint running fastest, and the values of combinations of ψ functions on them.

use super::polynomial::{Complex, Polynomial, times};

impl Polynomial {
    /// f at the grid that `axes` span, one axis for each of [`Polynomial::joints`]; the first joint runs fastest.
    ///
    /// What the joints after one have in common is summed once for all its points.
    pub(super) fn on_grid(&self, axes: &[&[f64]]) -> Vec<f64> {
        let mut out = Vec::with_capacity(axes.iter().map(|axis| axis.len()).product());
        if self.coefficients.is_empty() {
            out.resize(out.capacity(), 0.0);
            return out;
        }
        let factors: Vec<Vec<Vec<Complex>>> = axes
            .iter()
            .enumerate()
            .map(|(slot, axis)| axis.iter().map(|&q| self.factors(slot, q)).collect())
            .collect();
        let mut buffers: Vec<Vec<Complex>> =
            self.levels.iter().map(|level| vec![[0.0; 2]; level.starts.len() - 1]).collect();
        self.descend(&factors, &self.coefficients, &mut buffers, &mut out);
        out
    }

    /// Appends the values over the joints of `buffers`, given the sums over all later ones.
    fn descend(
        &self,
        factors: &[Vec<Vec<Complex>>],
        below: &[Complex],
        buffers: &mut [Vec<Complex>],
        out: &mut Vec<f64>,
    ) {
        let Some((above, rest)) = buffers.split_last_mut() else {
            out.push(below.first().map_or(0.0, |c| c[0]));
            return;
        };
        let slot = rest.len();
        let level = &self.levels[slot];
        for factors_here in &factors[slot] {
            for (group, sum) in above.iter_mut().enumerate() {
                let range = level.starts[group]..level.starts[group + 1];
                *sum = [0.0; 2];
                for (c, &factor) in below[range.clone()].iter().zip(&level.factor[range]) {
                    let [re, im] = times(factors_here[factor], *c);
                    sum[0] += re;
                    sum[1] += im;
                }
            }
            self.descend(factors, above, rest, out);
        }
    }

    /// φ for all exponents from −largest to largest.
    fn factors(&self, slot: usize, q: f64) -> Vec<Complex> {
        let top = usize::from(self.largest[slot].unsigned_abs());
        let (sin, cos) = self.angle(slot).map_or((0.0, q), |unit| libm::sincos(q * unit));
        let mut out = vec![[0.0; 2]; 2 * top + 1];
        let mut power = [1.0, 0.0];
        for e in 0..=top {
            out[top + e] = power;
            // Negative exponents are those of revolute joints alone.
            out[top - e] = if e == 0 { power } else { [power[0], -power[1]] };
            power = times(power, [cos, sin]);
        }
        out
    }

    /// ∂²f/∂q² of the joint `slot` up to its sign.
    pub(super) fn curvature(&self, slot: usize) -> Self {
        self.mapped(|exponents| {
            let e = exponents[slot];
            if let Some(unit) = self.angle(slot) {
                let frequency = f64::from(e) * unit;
                return (exponents.to_vec(), frequency * frequency);
            }
            let mut lower = exponents.to_vec();
            lower[slot] = (e - 2).max(0);
            (lower, if e < 2 { 0.0 } else { f64::from(e) * f64::from(e - 1) })
        })
    }

    /// Σ|c| |∂²/∂q²| over the terms, for the joint `slot` and |q| ≤ `position_bound` by slot.
    pub(super) fn curvature_within(&self, slot: usize, position_bound: &[f64]) -> f64 {
        let most = self.curvature(slot);
        let size = |(size, exponents): (f64, &[i8])| {
            let powers = (0..exponents.len()).filter(|&s| self.prismatic[s]);
            powers.fold(size, |size, s| (0..exponents[s]).fold(size, |p, _| p * position_bound[s]))
        };
        most.terms().map(size).sum()
    }
}

/// Visits all points of a grid over `joints` with the index of each in a grid over the joints `own` among them.
pub(super) fn spread(own: &[usize], joints: &[usize], sizes: &[usize], mut visit: impl FnMut(usize, usize)) {
    let mut strides = vec![0; joints.len()];
    let mut stride = 1;
    for joint in own {
        if let Some(slot) = joints.iter().position(|j| j == joint) {
            strides[slot] = stride;
            stride *= sizes[slot];
        }
    }
    let mut at = vec![0; joints.len()];
    let mut index = 0;
    for slot in 0..sizes.iter().product() {
        visit(slot, index);
        for axis in 0..joints.len() {
            at[axis] += 1;
            index += strides[axis];
            if at[axis] < sizes[axis] {
                break;
            }
            index -= strides[axis] * sizes[axis];
            at[axis] = 0;
        }
    }
}

/// Visits the cells of a grid: the index of the lower end by axis, and the grid's index by corner.
pub(super) fn each_cell(sizes: &[usize], mut visit: impl FnMut(&[usize], &dyn Fn(usize) -> usize)) {
    let k = sizes.len();
    let cells: Vec<usize> = sizes.iter().map(|size| size.saturating_sub(1).max(1)).collect();
    let mut strides = vec![1; k];
    for slot in 1..k {
        strides[slot] = strides[slot - 1] * sizes[slot - 1];
    }
    let offset =
        |corner: usize| (0..k).filter(|slot| corner >> slot & 1 == 1).map(|slot| strides[slot]).sum();
    let offsets: Vec<usize> = (0..1 << k).map(offset).collect();
    let mut at = vec![0; k];
    for _ in 0..cells.iter().product() {
        let base: usize = at.iter().zip(&strides).map(|(i, s)| i * s).sum();
        visit(&at, &|corner| base + offsets[corner]);
        for slot in 0..k {
            at[slot] += 1;
            if at[slot] < cells[slot] {
                break;
            }
            at[slot] = 0;
        }
    }
}
