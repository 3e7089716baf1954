//! The dynamics about one desired state: values, slopes, and what is of second order over a box of displacements.

use crate::arm::Arm;
use crate::dynamics::{Jet, enclosed_positions, inertia, passivity_torque};
use crate::motion::Target;
use crate::numerics::linear::Linear;
use crate::numerics::quadratic::Quadratic;

/// Numbers as functions of displacements x: centre + slopes x ± λ² rest ± rounding, where |x_k| ≤ λ times the half side of the
/// box that they were made for, λ ≤ 1.
#[derive(Clone, Debug, Default)]
pub(super) struct Forms {
    pub(super) centre: Vec<f64>,
    /// Row by row, per unit of the displacements.
    slopes: Vec<f64>,
    pub(super) rest: Vec<f64>,
    pub(super) rounding: Vec<f64>,
    variables: usize,
}

impl Forms {
    /// Where the unknowns stand for displacements up to `half`, of which only the first `variables` count.
    fn new<const V: usize>(numbers: &[Linear<V>], half: &[f64], variables: usize) -> Self {
        let mut out = Self { variables, ..Self::default() };
        for number in numbers {
            out.centre.push(number.centre);
            out.rest.push(number.rest);
            out.rounding.push(number.rounding);
            let slopes = number.slopes.iter().zip(half).take(variables);
            out.slopes.extend(slopes.map(|(slope, half)| slope / half));
        }
        out
    }

    /// The slopes of number `row`.
    pub(super) fn slopes(&self, row: usize) -> &[f64] {
        self.slopes.get(row * self.variables..(row + 1) * self.variables).unwrap_or(&[])
    }

    /// Bound on what number `row` differs from its centre by, for |x| ≤ `x` and that `lambda`.
    pub(super) fn change(&self, row: usize, x: &[f64], lambda: f64) -> f64 {
        let linear: f64 = self.slopes(row).iter().zip(x).map(|(slope, x)| slope.abs() * x).sum();
        linear + self.beyond(row, lambda)
    }

    /// The same without what is linear.
    pub(super) fn beyond(&self, row: usize, lambda: f64) -> f64 {
        lambda * lambda * self.rest[row] + self.rounding[row]
    }
}

/// D as a function of the displacement of q: centre + Σ slopes_k x_k + Σ_(k≤l) bends_kl x_k x_l ± λ³ rest ± rounding, entries by rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Curved {
    pub(super) centre: Vec<f64>,
    /// For each k the derivatives of all entries.
    pub(super) slopes: Vec<Vec<f64>>,
    /// For each pair k ≤ l.
    pub(super) bends: Vec<((usize, usize), Vec<f64>)>,
    pub(super) rest: Vec<f64>,
    pub(super) rounding: Vec<f64>,
}

impl Curved {
    fn new<const V: usize, const B: usize>(entries: &[Quadratic<V, B>], half: &[f64], n: usize) -> Self {
        let mut pairs = (0..V).flat_map(|k| (k..V).map(move |l| (k, l))).zip(0..B);
        let all = |of: &dyn Fn(&Quadratic<V, B>) -> f64| entries.iter().map(of).collect::<Vec<f64>>();
        Self {
            centre: all(&|entry| entry.centre),
            slopes: (0..n).map(|k| all(&|entry| entry.slopes[k] / half[k])).collect(),
            bends: pairs
                .by_ref()
                .filter(|((k, l), _)| *k < n && *l < n)
                .map(|((k, l), at)| ((k, l), all(&|entry| entry.bends[at] / (half[k] * half[l]))))
                .collect(),
            rest: all(&|entry| entry.rest),
            rounding: all(&|entry| entry.rounding),
        }
    }

    /// Bound on what entry `at` is off its centre, slopes and bends by, for displacements of q with that λ.
    pub(super) fn beyond(&self, at: usize, lambda: f64) -> f64 {
        lambda * lambda * lambda * self.rest[at] + self.rounding[at]
    }
}

/// One arm about a desired state, but for its mass matrix. Displacements are those of (q, q̇) from (q_d, q̇_d).
#[derive(Clone, Debug)]
pub(super) struct Enclosure {
    /// The Christoffel form C(q, q̇), n×n.
    pub(super) coriolis: Forms,
    /// D a_r + C v + G with a_r = q̈_d − P12 q̇_e: v is v_r = q̇_d − P12 q_e for the arm of the model, and q̇ for what an
    /// uncertain number adds to it.
    pub(super) torque: Forms,
    /// d/dt(D q̈_d + C q̇ + G) along q̇ and q̈_d, with q̈_d held.
    pub(super) rate: Forms,
}

/// About which state, and how far around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around<'a> {
    pub(super) target: &'a Target,
    pub(super) p12: &'a [Vec<f64>],
    /// Half the sides of the box of displacements of q, then of q̇; each above 0.
    pub(super) half: &'a [f64],
}

impl Enclosure {
    /// Of `arm`; of what an uncertain number adds, where it is not `own`.
    pub(super) fn new(arm: &Arm, around: Around, own: bool) -> Self {
        // 2N for at most N joints: each size takes the compiler seconds, and the larger one gives the same bits.
        match arm.dof() {
            0..=3 => enclose::<6>(arm, around, own),
            4..=6 => enclose::<12>(arm, around, own),
            7 => enclose::<14>(arm, around, own),
            _ => enclose::<16>(arm, around, own),
        }
    }
}

impl Curved {
    /// D of `arm`.
    pub(super) fn of(arm: &Arm, around: Around) -> Self {
        // N and N(N + 1)/2.
        match arm.dof() {
            0..=3 => curved::<3, 6>(arm, around),
            4..=6 => curved::<6, 21>(arm, around),
            7 => curved::<7, 28>(arm, around),
            _ => curved::<8, 36>(arm, around),
        }
    }
}

impl Forms {
    /// D of `arm`, n×n, as a function of the displacement of q.
    pub(super) fn of_inertia(arm: &Arm, around: Around) -> Self {
        match arm.dof() {
            0..=3 => straight::<6>(arm, around),
            4..=6 => straight::<12>(arm, around),
            7 => straight::<14>(arm, around),
            _ => straight::<16>(arm, around),
        }
    }
}

fn enclose<const V: usize>(arm: &Arm, around: Around, own: bool) -> Enclosure {
    let Around { target, p12, half } = around;
    let n = arm.dof();
    let zero = Linear::<V>::point(0.0);
    let rest = vec![zero; n];
    let unit = |j: usize| -> Vec<Linear<V>> {
        (0..n).map(|i| Linear::point(if i == j { 1.0 } else { 0.0 })).collect()
    };
    let q: Vec<Linear<V>> = (0..n).map(|i| Linear::unknown(target.q[i], i, half[i])).collect();
    let qd: Vec<Linear<V>> = (0..n).map(|i| Linear::unknown(target.qd[i], n + i, half[n + i])).collect();
    let positions = enclosed_positions(arm, &q);
    let columns = |of: &dyn Fn(usize) -> Vec<Linear<V>>, variables: usize| {
        let columns: Vec<Vec<Linear<V>>> = (0..n).map(of).collect();
        let entries: Vec<Linear<V>> = (0..n * n).map(|at| columns[at % n][at / n]).collect();
        Forms::new(&entries, half, variables)
    };
    let coriolis = columns(&|j| passivity_torque(arm, [0.0; 3], &positions, &qd, &unit(j), &rest), 2 * n);
    let weighed = |i: usize, from: usize| {
        let term = |sum: Linear<V>, j: usize| {
            sum + Linear::point(p12[i][j]) * Linear::unknown(0.0, from + j, half[from + j])
        };
        (0..n).fold(zero, term)
    };
    let a_r: Vec<Linear<V>> = (0..n).map(|i| Linear::point(target.qdd[i]) - weighed(i, n)).collect();
    let v_r: Vec<Linear<V>> = (0..n).map(|i| Linear::point(target.qd[i]) - weighed(i, 0)).collect();
    let v = if own { &v_r } else { &qd };
    let torque = passivity_torque(arm, arm.gravity, &positions, &qd, v, &a_r);
    let rate = rate(arm, target, &q, &qd);
    let forms = |numbers: &[Linear<V>]| Forms::new(numbers, half, 2 * n);
    Enclosure { coriolis, torque: forms(&torque), rate: forms(&rate) }
}

fn curved<const N: usize, const B: usize>(arm: &Arm, around: Around) -> Curved {
    let (n, target, half) = (arm.dof(), around.target, around.half);
    let q: Vec<Quadratic<N, B>> = (0..n).map(|i| Quadratic::unknown(target.q[i], i, half[i])).collect();
    let d = inertia(arm, &enclosed_positions(arm, &q), Quadratic::point(0.0));
    Curved::new(&d.concat(), half, n)
}

fn straight<const V: usize>(arm: &Arm, around: Around) -> Forms {
    let (n, target, half) = (arm.dof(), around.target, around.half);
    let q: Vec<Linear<V>> = (0..n).map(|i| Linear::unknown(target.q[i], i, half[i])).collect();
    let d = inertia(arm, &enclosed_positions(arm, &q), Linear::point(0.0));
    Forms::new(&d.concat(), half, n)
}

fn rate<const V: usize>(arm: &Arm, target: &Target, q: &[Linear<V>], qd: &[Linear<V>]) -> Vec<Linear<V>> {
    let with = |value: &[Linear<V>], rate: &[Linear<V>]| -> Vec<Jet<Linear<V>>> {
        value.iter().zip(rate).map(|(&value, &rate)| Jet { value, rate }).collect()
    };
    let qdd: Vec<Linear<V>> = target.qdd.iter().map(|&x| Linear::point(x)).collect();
    let still = vec![Linear::point(0.0); q.len()];
    let positions = enclosed_positions(arm, &with(q, qd));
    let speed = with(qd, &qdd);
    let torque = passivity_torque(arm, arm.gravity, &positions, &speed, &speed, &with(&qdd, &still));
    torque.into_iter().map(|jet| jet.rate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{coriolis, gravity, mass_matrix};
    use crate::numerics::low_discrepancy::LowDiscrepancy;
    use crate::simulate::example::three_link;

    fn dot(row: &[f64], x: &[f64]) -> f64 {
        row.iter().zip(x).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn no_displacement_inside_the_box_leaves_the_forms() {
        let (arm, n) = (three_link(), 3);
        let target = Target { q: vec![0.2, 0.5, -1.4], qd: vec![0.8, -0.6, 1.1], qdd: vec![2.0, -1.0, 0.5] };
        let p12: Vec<Vec<f64>> =
            (0..n).map(|i| (0..n).map(|j| if i == j { 5.0 } else { 0.2 }).collect()).collect();
        let half = [0.05, 0.08, 0.1, 0.3, 0.2, 0.5];
        let around = Around { target: &target, p12: &p12, half: &half };
        let made = Enclosure::new(&arm, around, true);
        let (curved, straight) = (Curved::of(&arm, around), Forms::of_inertia(&arm, around));
        let spread = LowDiscrepancy::new(6);
        for index in 0..3000 {
            for size in [1.0, 0.2] {
                let x: Vec<f64> =
                    spread.point(index).iter().zip(half).map(|(u, h)| size * h * (2.0 * u - 1.0)).collect();
                let at = |of: &[f64], from: usize| -> Vec<f64> {
                    of.iter().zip(&x[from..]).map(|(a, b)| a + b).collect()
                };
                let (q, qd) = (at(&target.q, 0), at(&target.qd, n));
                let (d, c, g) = (mass_matrix(&arm, &q), coriolis(&arm, &q, &qd), gravity(&arm, &q));
                let v_r: Vec<f64> = (0..n).map(|i| target.qd[i] - dot(&p12[i], &x[..n])).collect();
                let a_r: Vec<f64> = (0..n).map(|i| target.qdd[i] - dot(&p12[i], &x[n..])).collect();
                for i in 0..n {
                    for j in 0..n {
                        let known = straight.centre[i * n + j] + dot(straight.slopes(i * n + j), &x[..n]);
                        assert!((d[i][j] - known).abs() <= straight.beyond(i * n + j, size) + 1e-12);
                        let form = &curved;
                        let known = form.centre[i * n + j]
                            + (0..n).map(|k| form.slopes[k][i * n + j] * x[k]).sum::<f64>()
                            + form.bends.iter().map(|((k, l), b)| b[i * n + j] * x[*k] * x[*l]).sum::<f64>();
                        assert!((d[i][j] - known).abs() <= form.beyond(i * n + j, size) + 1e-12);
                        let form = &made.coriolis;
                        let known = form.centre[i * n + j] + dot(form.slopes(i * n + j), &x);
                        assert!((c[i][j] - known).abs() <= form.beyond(i * n + j, size) + 1e-12);
                    }
                    let exact = dot(&d[i], &a_r) + dot(&c[i], &v_r) + g[i];
                    let known = made.torque.centre[i] + dot(made.torque.slopes(i), &x);
                    assert!((exact - known).abs() <= made.torque.beyond(i, size) + 1e-12);
                }
            }
        }
    }

    #[test]
    fn rates_are_those_of_the_torque_along_the_velocity() {
        let (arm, n) = (three_link(), 3);
        let target = Target { q: vec![0.2, 0.5, -1.4], qd: vec![0.8, -0.6, 1.1], qdd: vec![2.0, -1.0, 0.5] };
        let p12 = vec![vec![0.0; n]; n];
        let around = Around { target: &target, p12: &p12, half: &[0.05; 6] };
        let made = Enclosure::new(&arm, around, true);
        let torque = |t: f64| -> Vec<f64> {
            let q: Vec<f64> = (0..n).map(|i| target.q[i] + t * target.qd[i]).collect();
            let qd: Vec<f64> = (0..n).map(|i| target.qd[i] + t * target.qdd[i]).collect();
            crate::dynamics::inverse_dynamics(&arm, &q, &qd, &target.qdd)
        };
        let h = 1e-5;
        let (before, after) = (torque(-h), torque(h));
        for i in 0..n {
            let seen = (after[i] - before[i]) / (2.0 * h);
            assert!((seen - made.rate.centre[i]).abs() < 1e-6 * (1.0 + seen.abs()), "{seen}");
        }
    }
}
