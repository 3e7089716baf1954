//! What changes evenly during a period: in proportion to time, and known from the set at its start.

use super::super::local::Local;
use super::super::numbers::{ROUNDED, middle, product, times};
use super::super::problem::Problem;
use crate::numerics::linalg::weighed;

/// What changes evenly. Times count from the start of the period.
pub(super) struct Trend {
    /// What D a_r + n gains for each unit of speed: 2C + B.
    pub(super) along: Vec<Vec<f64>>,
    /// Rate of D a_r + n beyond that on the desired motion, as rows on x, N·m/s or N/s.
    pub(super) torque: Vec<Vec<f64>>,
    /// Wᵀ Ḋ on the desired motion, by rows.
    pub(super) inertia: Vec<f64>,
    /// The rate of −q̈_e that both make, as rows on x, and a bound on what that rounds by.
    pub(super) acceleration: Vec<Vec<f64>>,
    pub(super) rounded: Vec<f64>,
    /// The rate of q̈_e that the desired motion makes: M times that of the lag, less the jerk.
    pub(super) pulled: Vec<f64>,
    /// Torque over the square of time that D a_r + n changes by because of `pulled`.
    pub(super) bent: Vec<f64>,
    /// Wᵀ Ḋ M of the rate of the lag.
    pub(super) lag: Vec<f64>,
}

impl Trend {
    /// For u = `control` x, and errors of at most `x`.
    pub(super) fn new(problem: &Problem, local: &Local, control: &[Vec<f64>], x: &[f64]) -> Self {
        let n = control.len();
        let speed = &local.course.target.qd;
        let at = |i: usize| -> f64 {
            local.slopes.iter().zip(speed).map(|(slope, speed)| slope.left[i] * speed).sum()
        };
        let inertia: Vec<f64> = (0..n * n).map(at).collect();
        let pushed = product(&local.inverse, control);
        let along = along(problem, local);
        let torque = rates(problem, local, &along, &pushed);
        let turned: Vec<Vec<f64>> = inertia.chunks(n).map(<[f64]>::to_vec).collect();
        let turning = product(&local.w, &product(&turned, &pushed));
        let mut acceleration = product(&local.inverse, &torque);
        for (row, more) in acceleration.iter_mut().zip(turning) {
            row.iter_mut().zip(more).for_each(|(out, more)| *out += more);
        }
        let lag: Vec<f64> = local.lag.rate.iter().map(|rate| middle(*rate)).collect();
        let moved = times(&local.inverse, &lag);
        let pulled: Vec<f64> = moved.iter().zip(&local.course.jerk).map(|(x, jerk)| x - jerk).collect();
        let bent = times(&along, &pulled).iter().map(|x| 0.5 * x).collect();
        let lag = times(&turned, &moved);
        let sized = |m: &[Vec<f64>], x: &[f64]| -> Vec<f64> { m.iter().map(|row| weighed(row, x)).collect() };
        let most = sized(&local.inverse_size, &sized(control, x));
        let rounded = rounded(problem, local, &most, x);
        Self { along, torque, inertia, acceleration, rounded, pulled, bent, lag }
    }
}

/// ∂n/∂q̇ = 2C + B on the desired motion, for the Christoffel form of C.
fn along(problem: &Problem, local: &Local) -> Vec<Vec<f64>> {
    let n = problem.arm.dof();
    let entry = |i: usize, j: usize| {
        let viscous = if i == j { problem.arm.joints[i].viscous_friction } else { 0.0 };
        2.0 * local.arm.coriolis.centre[i * n + j] + viscous
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// d/dt(D a_r + n) at the errors x less that on the desired motion, to first order, where D⁻¹u = `pushed` x.
fn rates(problem: &Problem, local: &Local, along: &[Vec<f64>], pushed: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (n, c) = (pushed.len(), &local.arm.coriolis.centre);
    let row = |i: usize| {
        let mut row = local.arm.rate.slopes(i).to_vec();
        for j in 0..n {
            row.iter_mut().zip(&pushed[j]).for_each(|(out, push)| *out += along[i][j] * push);
            // Ḋ = C + Cᵀ.
            let slowed = along[i][j] + c[i * n + j] + c[j * n + i];
            row[n..].iter_mut().zip(&problem.gains.p12[j]).for_each(|(out, p12)| *out -= slowed * p12);
        }
        row
    };
    (0..n).map(row).collect()
}

/// Bound on what the rate of −q̈_e rounds by that comes from errors of at most `x` where D⁻¹u is at most `pushed`.
pub(super) fn rounded(problem: &Problem, local: &Local, pushed: &[f64], x: &[f64]) -> Vec<f64> {
    let n = pushed.len();
    let sized = |m: &[Vec<f64>], x: &[f64]| -> Vec<f64> { m.iter().map(|row| weighed(row, x)).collect() };
    let pulled = sized(&problem.gains.p12, &x[n..]);
    let torque = |i: usize| {
        let row = |j: usize| {
            let (at, back) = (i * n + j, j * n + i);
            let [c, other] = [at, back].map(|at| local.arm.coriolis.centre[at].abs());
            let slopes = local.mass_matrix.slopes.iter().zip(&local.course.target.qd);
            let rate: f64 = slopes.map(|(slopes, qd)| (slopes[at] * qd).abs()).sum();
            (2.0 * c + rate) * pushed[j] + (3.0 * c + other) * pulled[j]
        };
        let viscous = problem.arm.joints[i].viscous_friction * (pushed[i] + pulled[i]);
        weighed(local.arm.rate.slopes(i), x) + (0..n).map(row).sum::<f64>() + viscous
    };
    let torques: Vec<f64> = (0..n).map(torque).collect();
    sized(&local.inverse_size, &torques).iter().map(|size| ROUNDED * size).collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::course::Course;
    use super::super::super::tests::moving;
    use super::super::sample::control;
    use super::*;
    use crate::dynamics::{inverse_dynamics, mass_matrix};
    use crate::numerics::linalg::inverse;
    use crate::numerics::low_discrepancy::LowDiscrepancy;

    /// Half the distance of values for a rate, s.
    const H: f64 = 1e-4;

    fn plus(x: &[f64], factor: f64, y: &[f64]) -> Vec<f64> {
        x.iter().zip(y).map(|(x, y)| x + factor * y).collect()
    }

    /// D a_r + n + B q̇ at a time after a state with this acceleration.
    fn torque(problem: &Problem, [q, qd, qdd]: [&[f64]; 3], a_r: &[f64], time: f64) -> Vec<f64> {
        let q = plus(&plus(q, time, qd), 0.5 * time * time, qdd);
        let qd = plus(qd, time, qdd);
        let rubs: Vec<f64> =
            problem.arm.joints.iter().zip(&qd).map(|(joint, qd)| joint.viscous_friction * qd).collect();
        plus(&inverse_dynamics(problem.arm, &q, &qd, a_r), 1.0, &rubs)
    }

    fn rate(of: &dyn Fn(f64) -> Vec<f64>) -> Vec<f64> {
        plus(&of(H), -1.0, &of(-H)).iter().map(|x| x / (2.0 * H)).collect()
    }

    #[test]
    fn the_trend_is_the_rate_at_the_start_to_first_order_in_the_errors() {
        moving(|problem| {
            let n = problem.arm.dof();
            let course = Course::new(problem.motion, 0.2, problem.period, 0.0);
            let local = Local::new(problem, course, vec![1e-3; 2 * n]).unwrap();
            let control = control(problem, &local, &vec![0.0; n]);
            let trend = Trend::new(problem, &local, &control, &vec![1e-5; 2 * n]);
            let target = &local.course.target;
            let points = LowDiscrepancy::new(2 * n);
            for index in 0..20 {
                let x: Vec<f64> = points.point(index).iter().map(|u| 1e-5 * (2.0 * u - 1.0)).collect();
                let (push, slowed) = (times(&control, &x), times(&problem.gains.p12, &x[n..]));
                let pushed = times(&local.inverse, &push);
                let a_r = plus(&target.qdd, -1.0, &slowed);
                let (q, qd) = (plus(&target.q, 1.0, &x[..n]), plus(&target.qd, 1.0, &x[n..]));
                let qdd = plus(&a_r, 1.0, &pushed);
                let off = rate(&|time| torque(problem, [&q, &qd, &qdd], &a_r, time));
                let desired = [&target.q[..], &target.qd, &target.qdd];
                let nominal = rate(&|time| torque(problem, desired, &target.qdd, time));
                let seen = plus(&off, -1.0, &nominal);
                let said = times(&trend.torque, &x);
                let inverted = |time: f64| -> Vec<f64> {
                    let d = mass_matrix(problem.arm, &plus(&target.q, time, &target.qd));
                    times(&inverse(&d).unwrap(), &push)
                };
                let turned = plus(&times(&local.inverse, &seen), -1.0, &rate(&inverted));
                let acceleration = times(&trend.acceleration, &x);
                let size = |x: &[f64]| x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                assert!(size(&said) > 1e-3 && size(&acceleration) > 1e-3, "{said:?} {acceleration:?}");
                for (said, seen) in [(&said, &seen), (&acceleration, &turned)] {
                    let apart = size(&plus(said, -1.0, seen));
                    assert!(apart < 2e-3 * size(seen), "{said:?} {seen:?}");
                }
            }
        });
    }
}
