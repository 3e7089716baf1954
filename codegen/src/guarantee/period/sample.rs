//! The set at a sample: what follows from it before the period begins.

use super::super::local::Local;
use super::super::numbers::{ROUNDED, UP, product, scale};
use super::super::problem::{Problem, Wrong};
use super::super::set::{ErrorSet, Image};
use super::Stop;
use super::family::Family;
use super::switching::{compensation, switched};
use super::trend::Trend;
use crate::numerics::linalg::weighed;

/// The set at a sample and what follows from it alone.
pub(super) struct Sample<'a> {
    pub(super) problem: &'a Problem<'a>,
    /// What the step is wrong by while the errors are no larger than those of the set.
    step: &'a Wrong,
    pub(super) local: &'a Local,
    pub(super) n: usize,
    /// Bounds on |q_e| and |v|, one list.
    pub(super) x: Vec<f64>,
    /// Bounds on the displacements from the target.
    away: Vec<f64>,
    /// u = `control` x, with the switching term as a line.
    pub(super) control: Vec<Vec<f64>>,
    /// D⁻¹ of the start times u and what the uncertain numbers do on the desired motion: the two nearly cancel at rest.
    pub(super) pushed: Image,
    pub(super) pushed_size: Vec<f64>,
    pub(super) trend: Trend,
    pub(super) family: Family,
    /// Bounds on the trends of torque and of −q̈_e on the set.
    pub(super) rates: Vec<f64>,
    pub(super) turning: Vec<f64>,
    /// Torque that is wrong and held for the period.
    pub(super) wrong: Vec<f64>,
    /// Gains of the line through the switching term, and what that differs from it by.
    line: Vec<f64>,
    off_line: Vec<f64>,
    /// Least and largest Coulomb friction that is compensated.
    pub(super) fed: Vec<[f64; 2]>,
}

impl<'a> Sample<'a> {
    pub(super) fn new(
        problem: &'a Problem<'a>,
        step: &'a Wrong,
        local: &'a Local,
        set: &ErrorSet,
    ) -> Result<Self, Stop> {
        let n = problem.arm.dof();
        let x = set.hull();
        let s = set.turned_hull(problem.gains).split_off(n);
        let away: Vec<f64> = x.iter().zip(&local.course.apart).map(|(x, apart)| UP * (x + apart)).collect();
        let lambda = scale(&away, &local.half);
        if lambda > 1.0 {
            return Err(Stop::Beyond(away));
        }
        let (line, off_line) = switched(problem, step, local, &x, &s);
        let control = control(problem, local, &line);
        let trend = Trend::new(problem, local, &control, &x);
        let mut family = Family::new(problem, local);
        let mut pushed = set.image(&product(&local.inverse, &control));
        family.drive(problem, &mut pushed, None);
        family.multiply(problem, local, set, &pushed, &x);
        let mut rates = set.image(&trend.torque);
        family.drive(problem, &mut rates, Some(&trend.along));
        let (course, coriolis) = (&local.course, &local.arm.coriolis);
        let turned =
            |i: usize| -> f64 { (0..n).map(|j| coriolis.change(i * n + j, &away, lambda) * s[j]).sum() };
        let added = |i: usize| -> f64 {
            let each = problem.numbers.iter().zip(&local.added).map(|(number, added)| {
                let torque = &added.enclosure.torque;
                number.most() * (weighed(torque.slopes(i), &course.apart) + torque.beyond(i, lambda))
            });
            each.sum::<f64>() + family.torque[i].rest
        };
        let wrong: Vec<f64> = (0..n).map(|i| step.torque[i] + off_line[i] + turned(i) + added(i)).collect();
        let fed = (0..n)
            .map(|i| compensation(problem.compensated[i], course.target.qd[i], course.apart[n + i]))
            .collect();
        let pushed_size = pushed.sizes();
        let turning = pushed.sizes_under(&trend.inertia);
        Ok(Self {
            problem,
            step,
            local,
            n,
            x,
            away,
            control,
            pushed,
            pushed_size,
            trend,
            family,
            rates: rates.sizes(),
            turning,
            wrong,
            line,
            off_line,
            fed,
        })
    }

    /// Range of the torque that the law asks for.
    pub(super) fn torque(&self, set: &ErrorSet) -> Vec<[f64; 2]> {
        let Self { problem, local, n, .. } = *self;
        let torque = &local.arm.torque;
        let lambda = scale(&self.away, &local.half);
        let row = |i: usize| -> Vec<f64> {
            let mut row = torque.slopes(i).to_vec();
            for j in 0..n {
                let damping = problem.damping[i][j] + if i == j { self.line[i] } else { 0.0 };
                row[j] += problem.gains.pqq[i][j];
                row[n + j] -= damping;
                for k in 0..n {
                    row[k] -= damping * problem.gains.p12[j][k];
                }
            }
            row[n + i] += problem.arm.joints[i].viscous_friction;
            row
        };
        let rows: Vec<Vec<f64>> = (0..n).map(row).collect();
        let around = set.image(&rows).sizes();
        (0..n)
            .map(|i| {
                let friction = problem.arm.joints[i].viscous_friction * local.course.target.qd[i];
                let middle = torque.centre[i] + friction;
                let half = around[i]
                    + torque.beyond(i, lambda)
                    + weighed(torque.slopes(i), &local.course.apart)
                    + self.off_line[i]
                    + self.step.torque[i]
                    + ROUNDED * (middle.abs() + weighed(&rows[i], &self.x));
                let [low, high] = self.fed[i];
                [middle + low - half, middle + high + half]
            })
            .collect()
    }
}

/// u as rows on x: Pqq q_e − (K + C + line) s, with C of the desired motion.
pub(super) fn control(problem: &Problem, local: &Local, line: &[f64]) -> Vec<Vec<f64>> {
    let n = line.len();
    let row = |i: usize| {
        let mut row = vec![0.0; 2 * n];
        row[..n].copy_from_slice(&problem.gains.pqq[i]);
        for j in 0..n {
            let slope = if i == j { line[i] } else { 0.0 };
            let damping = problem.damping[i][j] + local.arm.coriolis.centre[i * n + j] + slope;
            row[n + j] -= damping;
            for k in 0..n {
                row[k] -= damping * problem.gains.p12[j][k];
            }
        }
        row
    };
    (0..n).map(row).collect()
}
