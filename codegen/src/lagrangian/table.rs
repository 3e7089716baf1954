//! The functions that the expansion of an arm may hold, numbered in their order.

use super::Combination;
use super::coupled;
use super::function::{Function, MAX_JOINTS, WHOLE};
use super::transform::{Axis, Complex, grid_point, grid_size};
use crate::arm::{Arm, JointKind};

/// Functions by number, with their derivatives.
///
/// Holds: the functions ascend and differ; with a function of D the table has its derivatives.
pub(super) struct Table {
    pub functions: Vec<Function>,
    /// By joint and function the number of the derivative and its factor, which is 0 where the derivative vanishes.
    slopes: Vec<Vec<(usize, f64)>>,
}

/// The number of the function and the grid point of each term of a transform, by ascending function.
pub(super) type Places = Vec<(usize, usize)>;

impl Table {
    /// Whatever D, h and G of `arm` can hold, whatever its bodies are.
    pub fn of(arm: &Arm) -> Self {
        match &arm.linkage {
            None => Self::new(serial(arm)),
            Some(linkage) => Self::new(coupled::functions(arm, linkage, &serial(&linkage.chain))),
        }
    }

    fn new(mut functions: Vec<Function>) -> Self {
        functions.sort_unstable();
        functions.dedup();
        let slope = |l: usize, j: usize| {
            let (derivative, factor) = functions[l].derivative(j)?;
            // Sine and cosine of the same angle stand side by side.
            let beside = [l + 1, l.wrapping_sub(1)];
            let near = beside.into_iter().find(|&at| functions.get(at) == Some(&derivative));
            Some((near.or_else(|| functions.binary_search(&derivative).ok())?, factor))
        };
        let of_joint = |j| (0..functions.len()).map(|l| slope(l, j).unwrap_or((l, 0.0))).collect();
        let slopes = (0..MAX_JOINTS).map(of_joint).collect();
        Self { functions, slopes }
    }

    /// The number of a function.
    pub fn number(&self, psi: &Function) -> Option<usize> {
        self.functions.binary_search(psi).ok()
    }

    /// Where the terms of a transform over `axes` stand, those of the first joints of an arm.
    pub fn places(&self, axes: &[Axis]) -> Places {
        let grid = |psi: &Function| {
            let beyond = (axes.len()..MAX_JOINTS).any(|j| psi.kappa[j] != 0 || psi.power[j] != 0);
            let step = |index: usize, (j, axis): (usize, &Axis)| {
                let wanted = psi.kappa[j] + i8::try_from(psi.power[j]).unwrap_or(i8::MAX);
                Some(index * axis.index.len() + axis.index.iter().position(|&k| k == wanted)?)
            };
            if beyond { None } else { axes.iter().enumerate().try_fold(0, step) }
        };
        self.functions.iter().enumerate().filter_map(|(l, psi)| Some((l, grid(psi)?))).collect()
    }

    /// The real terms of a transformed sample array.
    pub fn collect(&self, places: &Places, transformed: &[Complex]) -> Combination {
        let term = |&(l, index): &(usize, usize)| {
            let (re, im) = transformed[index];
            let psi = &self.functions[l];
            // c e^{iκq} and its conjugate partner at −κ together make 2 Re c cos(κq) − 2 Im c sin(κq).
            let k = if psi.kappa == [0; MAX_JOINTS] {
                re
            } else if psi.sine {
                -2.0 * im
            } else {
                2.0 * re
            };
            (l, k)
        };
        places.iter().map(term).filter(|term| term.1 != 0.0).collect()
    }

    /// The derivative of `terms` along a joint, times `factor`.
    pub fn derivative(&self, terms: &Combination, joint: usize, factor: f64) -> Combination {
        let slopes = &self.slopes[joint];
        let mut out = Combination::with_capacity(terms.len());
        for &(l, k) in terms {
            let (l, slope) = slopes[l];
            if slope == 0.0 {
                continue;
            }
            // The order changes between sine and cosine alone.
            let mut at = out.len();
            while at > 0 && out[at - 1].0 > l {
                at -= 1;
            }
            match out[..at].last_mut().filter(|last| last.0 == l) {
                Some(last) => last.1 += factor * slope * k,
                None => out.insert(at, (l, factor * slope * k)),
            }
        }
        out
    }
}

/// The functions that D and G of an arm can hold whose joints move by themselves.
fn serial(arm: &Arm) -> Vec<Function> {
    let kinds: Vec<JointKind> = arm.joints.iter().map(|joint| joint.kind).collect();
    [mass_matrix_axes(&kinds), gravity_axes(&kinds)]
        .iter()
        .flat_map(|axes| grid_functions(axes, &kinds))
        .collect()
}

/// The grid on which D is sampled: it does not depend on the first joint.
pub(super) fn mass_matrix_axes(kinds: &[JointKind]) -> Vec<Axis> {
    let axis = |(j, &kind): (usize, &JointKind)| if j == 0 { Axis::constant() } else { Axis::new(kind, 2) };
    kinds.iter().enumerate().map(axis).collect()
}

/// The grid on which G is sampled.
pub(super) fn gravity_axes(kinds: &[JointKind]) -> Vec<Axis> {
    kinds.iter().map(|&kind| Axis::new(kind, 1)).collect()
}

fn grid_functions(axes: &[Axis], kinds: &[JointKind]) -> Vec<Function> {
    let at = |index: usize| {
        let mut psi = Function { part: WHOLE, ..Function::ONE };
        for (j, (axis, k)) in axes.iter().zip(grid_point(axes, index)).enumerate() {
            match kinds[j] {
                JointKind::Revolute => psi.kappa[j] = axis.index[k],
                JointKind::Prismatic => psi.power[j] = axis.index[k].unsigned_abs(),
            }
        }
        let both = [psi, Function { sine: true, ..psi }];
        both.into_iter().filter(|psi| psi.canonical().is_some_and(|(canonical, _)| canonical == *psi))
    };
    (0..grid_size(axes)).flat_map(at).collect()
}

/// a + b, both by ascending function; what both have is added in this order.
pub(super) fn merged(a: Combination, b: &Combination) -> Combination {
    let mut out = Combination::with_capacity(a.len() + b.len());
    let mut rest = b.iter().copied().peekable();
    for (l, mut k) in a {
        while let Some(term) = rest.next_if(|term| term.0 < l) {
            out.push(term);
        }
        while let Some(term) = rest.next_if(|term| term.0 == l) {
            k += term.1;
        }
        out.push((l, k));
    }
    out.extend(rest);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A joint of each kind, two of them revolute.
    fn table() -> Table {
        use JointKind::{Prismatic, Revolute};
        let kinds = [Revolute, Prismatic, Revolute, Revolute];
        let axes = [mass_matrix_axes(&kinds), gravity_axes(&kinds)];
        Table::new(axes.iter().flat_map(|axes| grid_functions(axes, &kinds)).collect())
    }

    #[test]
    fn derivatives_are_those_of_the_functions_in_order() {
        let table = table();
        assert!(table.functions.windows(2).all(|pair| pair[0] < pair[1]));
        let d: Vec<usize> =
            (0..table.functions.len()).filter(|&l| table.functions[l].kappa[0] == 0).collect();
        let terms: Combination = d.iter().map(|&l| (l, 1.0 + l as f64)).collect();
        for joint in 0..4 {
            let mut wanted: Vec<(Function, f64)> = d
                .iter()
                .filter_map(|&l| {
                    let (psi, slope) = table.functions[l].derivative(joint)?;
                    Some((psi, -0.5 * slope * (1.0 + l as f64)))
                })
                .collect();
            wanted.sort_by_key(|term| term.0);
            let found = table.derivative(&terms, joint, -0.5);
            let found: Vec<(Function, f64)> =
                found.into_iter().map(|(l, k)| (table.functions[l], k)).collect();
            assert_eq!(found, wanted, "joint {joint}");
        }
    }

    #[test]
    fn terms_stand_where_their_function_is_in_the_transform() {
        use super::super::transform::transform;
        use JointKind::{Prismatic, Revolute};
        let table = table();
        let axes = mass_matrix_axes(&[Revolute, Prismatic, Revolute]);
        let places = table.places(&axes);
        for &(l, _) in &places {
            let psi = table.functions[l];
            let at = |index: usize| {
                let point = grid_point(&axes, index);
                psi.evaluate(&axes.iter().zip(point).map(|(axis, k)| axis.nodes[k]).collect::<Vec<f64>>())
            };
            let samples: Vec<f64> = (0..grid_size(&axes)).map(at).collect();
            let terms = table.collect(&places, &transform(&axes, &samples));
            let large: Vec<_> = terms.iter().filter(|term| term.1.abs() > 1e-12).collect();
            assert_eq!(large.len(), 1, "{psi}");
            assert!(large[0].0 == l && (large[0].1 - 1.0).abs() < 1e-12, "{psi}: {large:?}");
        }
        assert_eq!(places.len(), 3 * 5);
    }

    #[test]
    fn sums_hold_the_terms_of_both() {
        let (a, b) = (vec![(1, 1.0), (4, 2.0)], vec![(0, 3.0), (4, -1.0), (9, 5.0)]);
        assert_eq!(merged(a.clone(), &b), [(0, 3.0), (1, 1.0), (4, 1.0), (9, 5.0)]);
        assert_eq!(merged(Vec::new(), &a), a);
        assert_eq!(merged(a.clone(), &Vec::new()), a);
    }
}
