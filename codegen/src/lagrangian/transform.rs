//! The one-dimensional transforms that turn samples on a tensor grid into coefficients.

use crate::arm::JointKind;

/// A complex number (real, imaginary).
pub(super) type Complex = (f64, f64);

/// One axis of the tensor grid: where a joint is sampled, and how samples become coefficients.
pub(super) struct Axis {
    /// Sample positions, rad or m.
    pub nodes: Vec<f64>,
    /// What each transformed index stands for: κ_j of a revolute joint, the exponent of a prismatic one.
    pub index: Vec<i8>,
    /// Transform, by rows of coefficients.
    matrix: Vec<Vec<Complex>>,
}

impl Axis {
    /// The axis of a joint in which the function has degree ≤ `degree` (1 or 2).
    pub fn new(kind: JointKind, degree: u8) -> Self {
        match kind {
            JointKind::Revolute => Self::fourier(i8::try_from(degree).unwrap_or(2)),
            JointKind::Prismatic => Self::quadratic(),
        }
    }

    /// The axis of a joint on which the function does not depend.
    pub fn constant() -> Self {
        Self { nodes: vec![0.0], index: vec![0], matrix: vec![vec![(1.0, 0.0)]] }
    }

    fn fourier(degree: i8) -> Self {
        let count = 2 * i32::from(degree) + 1;
        let turn = std::f64::consts::TAU / f64::from(count);
        let index: Vec<i8> = (-degree..=degree).collect();
        let row = |&kappa: &i8| {
            (0..count)
                .map(|node| {
                    let (sin, cos) =
                        libm::sincos(-turn * f64::from((i32::from(kappa) * node).rem_euclid(count)));
                    (cos / f64::from(count), sin / f64::from(count))
                })
                .collect()
        };
        Self {
            nodes: (0..count).map(|node| turn * f64::from(node)).collect(),
            matrix: index.iter().map(row).collect(),
            index,
        }
    }

    fn quadratic() -> Self {
        let real = |row: [f64; 3]| row.map(|x| (x, 0.0)).to_vec();
        Self {
            nodes: vec![-1.0, 0.0, 1.0],
            index: vec![0, 1, 2],
            matrix: vec![real([0.0, 1.0, 0.0]), real([-0.5, 0.0, 0.5]), real([0.5, -1.0, 0.5])],
        }
    }
}

/// Grid point number `index`, the last axis fastest.
pub(super) fn grid_point(axes: &[Axis], mut index: usize) -> Vec<usize> {
    let mut point = vec![0; axes.len()];
    for (slot, axis) in point.iter_mut().zip(axes).rev() {
        *slot = index % axis.nodes.len();
        index /= axis.nodes.len();
    }
    point
}

/// Number of grid points.
pub(super) fn grid_size(axes: &[Axis]) -> usize {
    axes.iter().map(|axis| axis.nodes.len()).product()
}

/// Transforms samples (grid order) to coefficients (the same order of transformed indices), axis by axis.
pub(super) fn transform(axes: &[Axis], samples: &[f64]) -> Vec<Complex> {
    let mut data: Vec<Complex> = samples.iter().map(|&x| (x, 0.0)).collect();
    let mut stride = 1;
    for axis in axes.iter().rev() {
        let count = axis.nodes.len();
        let mut line = vec![(0.0, 0.0); count];
        for block in data.chunks_exact_mut(stride * count) {
            for offset in 0..stride {
                for (slot, row) in line.iter_mut().zip(&axis.matrix) {
                    *slot = row.iter().enumerate().fold((0.0, 0.0), |sum, (k, &w)| {
                        let x = block[offset + k * stride];
                        (sum.0 + w.0 * x.0 - w.1 * x.1, sum.1 + w.0 * x.1 + w.1 * x.0)
                    });
                }
                for (k, &value) in line.iter().enumerate() {
                    block[offset + k * stride] = value;
                }
            }
        }
        stride *= count;
    }
    data
}
