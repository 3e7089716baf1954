//! What the uncertain numbers make of the errors, which they themselves drive: the square of a number has one sign.

use super::super::local::{Added, Local};
use super::super::numbers::{ROUNDED, UP, times};
use super::super::problem::Problem;
use super::super::set::{ErrorSet, Image, Known};
use crate::numerics::linalg::weighed;

/// Sums of products of an uncertain number and what is linear in the errors.
pub(super) struct Family {
    /// M (D_m a_r + C_m q̇ + G_m) on the desired motion, by number.
    pub(super) moved: Vec<Vec<f64>>,
    /// −Σ u_m (D_m a_r + C_m q̇ + G_m) less its value on the desired motion, to first order in the errors, by joint, N·m or N.
    pub(super) torque: Vec<Known>,
    /// Σ u_m Wᵀ D_m D⁻¹ of what pushes at the start, by eigenvector.
    pub(super) turned: Vec<Known>,
}

impl Family {
    /// Without products.
    pub(super) fn new(problem: &Problem, local: &Local) -> Self {
        let moved = |added: &Added| times(&local.inverse, &added.enclosure.torque.centre);
        let n = problem.arm.dof();
        let nothing = || (0..n).map(|_| Known::nothing(2 * problem.numbers.len())).collect();
        Self { moved: local.added.iter().map(moved).collect(), torque: nothing(), turned: nothing() }
    }

    /// Adds to `image`, of accelerations under `map`, what the numbers do on the desired motion.
    pub(super) fn drive(&self, problem: &Problem, image: &mut Image, map: Option<&[Vec<f64>]>) {
        for (m, (number, moved)) in problem.numbers.iter().zip(&self.moved).enumerate() {
            let moved = map.map_or_else(|| moved.clone(), |map| times(map, moved));
            let part = |factor: f64| -> Vec<f64> { moved.iter().map(|x| factor * x).collect() };
            image.add(Some(m), &part(-number.half));
            image.add(None, &part(-number.middle));
        }
    }

    /// The products with the errors of `set`, at most `x`, and with the accelerations `pushed` at the start.
    pub(super) fn multiply(
        &mut self,
        problem: &Problem,
        local: &Local,
        set: &ErrorSet,
        pushed: &Image,
        x: &[f64],
    ) {
        let n = self.torque.len();
        for (m, (number, added)) in problem.numbers.iter().zip(&local.added).enumerate() {
            let form = &added.enclosure.torque;
            let rows: Vec<Vec<f64>> = (0..n).map(|i| form.slopes(i).iter().map(|x| -x).collect()).collect();
            let (torques, turned) = (set.image(&rows), pushed.under(&added.inertia.left));
            for i in 0..n {
                let mut product = torques.times_number(i, m, number.middle, number.half);
                product.rest += ROUNDED * number.most() * weighed(&rows[i], x);
                self.torque[i].add(product);
                self.turned[i].add(turned.times_number(i, m, number.middle, number.half));
            }
        }
    }
}

impl Known {
    fn nothing(shared: usize) -> Self {
        Self { weights: vec![0.0; 1 + shared], rest: 0.0 }
    }

    fn add(&mut self, other: Self) {
        self.weights.iter_mut().zip(other.weights).for_each(|(sum, x)| *sum += x);
        self.rest += other.rest;
    }

    /// Bound on what is known.
    pub(super) fn size(&self) -> f64 {
        UP * self.weights.iter().map(|x| x.abs()).sum::<f64>()
    }
}
