//! The sampled loop, linear about the desired motion and frozen piece by piece: it says which initial errors,
//! parameters and disturbances move one joint furthest at one instant.
//!
//! Its slopes are differences of the step graph and of the arm; nothing rests on them but the choice of runs.

use gramforge_runtime::law::{Law, Sample};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{Plant, RigidPlant};
use gramforge_runtime::{Desired, Model};

use super::family::Family;
use super::fast_arm::FastArm;
use crate::parallel::Parallelize;
use crate::simulate::reference::MotionReference;
use crate::simulate::step_law::StepLaw;

/// Most pieces of a run.
const PIECES: usize = 2048;
/// Half the distance of a difference, rad and rad/s, or m and m/s: well inside every boundary layer that is worth one.
const STEP: f64 = 1e-6;
/// Size beyond which an adjoint is scaled down: a loop that is not stable makes it grow, and only signs count.
const LARGE: f64 = 1e100;

type Square<const N: usize> = [[f64; N]; N];
/// By position and velocity.
type Torques<'a, const N: usize> = dyn Fn(&[f64; N], &[f64; N]) -> [f64; N] + 'a;

/// The loop over the whole run.
pub(super) struct FrozenLoop<const N: usize> {
    pieces: Vec<Piece<N>>,
    /// Control periods of a piece.
    length: usize,
    period: f64,
}

/// x = (q_e, q̇_e); the error accelerates by `position` q_e + `velocity` q̇_e.
struct Piece<const N: usize> {
    position: Square<N>,
    velocity: Square<N>,
    /// D⁻¹.
    mobility: Square<N>,
    /// By uncertain number, what its value 1 adds to the acceleration.
    parameters: Vec<[f64; N]>,
}

/// What one joint's error at one instant depends on: rows of a linear map.
pub(super) struct Sensitivity<const N: usize> {
    /// On the errors at the first instant, of position and velocity.
    pub initial: [[f64; N]; 2],
    /// On the torque held from each instant on, in order of time.
    pub torque: Vec<[f64; N]>,
    /// On each uncertain number, over all that time.
    pub parameters: Vec<f64>,
}

/// What the loop is made of.
pub(super) struct Parts<'a, const N: usize> {
    /// The arm as specified.
    pub arm: &'a FastArm<N>,
    /// The law in f64, with a boundary layer.
    pub law: &'a StepLaw<f64>,
    pub reference: &'a MotionReference<'a, N>,
    pub period: f64,
    /// Control periods of the run.
    pub steps: usize,
    pub family: &'a Family<'a>,
}

impl<const N: usize> FrozenLoop<N> {
    pub(super) fn new(parts: &Parts<N>) -> Self {
        let length = parts.steps.div_ceil(PIECES).max(1);
        let count = parts.steps.div_ceil(length).max(1);
        let middle = |piece: usize| (piece * length + (length - 1) / 2) as f64 * parts.period;
        let pieces = (0..count).into_par_iter().map(|piece| Piece::new(parts, middle(piece))).collect();
        Self { pieces, length, period: parts.period }
    }

    /// What the error of `joint` at the instant `until` depends on, from the instant `from` on.
    pub(super) fn sensitivity(&self, joint: usize, from: usize, until: usize) -> Sensitivity<N> {
        let period = self.period;
        let (mut position, mut velocity) = ([0.0; N], [0.0; N]);
        position[joint] = 1.0;
        let count = self.pieces.first().map_or(0, |piece| piece.parameters.len());
        let mut parameters = vec![0.0; count];
        let mut torque = Vec::with_capacity(until.saturating_sub(from));
        for step in (from..until).rev() {
            let Some(piece) = self.pieces.get(step / self.length).or(self.pieces.last()) else { break };
            // What an acceleration over the period does to the error later on.
            let pull: [f64; N] =
                std::array::from_fn(|i| 0.5 * period * period * position[i] + period * velocity[i]);
            torque.push(times(&pull, &piece.mobility));
            for (sum, shift) in parameters.iter_mut().zip(&piece.parameters) {
                *sum += pull.iter().zip(shift).map(|(a, b)| a * b).sum::<f64>();
            }
            let (of_position, of_velocity) = (times(&pull, &piece.position), times(&pull, &piece.velocity));
            velocity = std::array::from_fn(|i| velocity[i] + period * position[i] + of_velocity[i]);
            position = std::array::from_fn(|i| position[i] + of_position[i]);
            let size = position.iter().chain(&velocity).fold(0.0_f64, |m, x| m.max(x.abs()));
            if size > LARGE {
                let less = |x: &mut f64| *x /= LARGE;
                position.iter_mut().chain(&mut velocity).for_each(less);
                torque.iter_mut().flatten().chain(&mut parameters).for_each(less);
            }
        }
        torque.reverse();
        Sensitivity { initial: [position, velocity], torque, parameters }
    }
}

impl<const N: usize> Piece<N> {
    fn new(parts: &Parts<N>, time: f64) -> Self {
        let Parts { arm, law, reference, period, family, .. } = *parts;
        let desired = reference.at(time);
        let Desired { q, qd, qdd } = desired;
        let asked = |q: &[f64; N], qd: &[f64; N]| {
            let mut learnt = Law::<FastArm<N>, N>::initial_state(law);
            law.torque(arm, &mut learnt, &Sample { q: *q, qd: *qd, desired, period })
        };
        // Friction that jumps has no slope.
        let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; N] };
        let held = arm.inverse_dynamics(&q, &qd, &qdd);
        let moved = |q: &[f64; N], qd: &[f64; N], torque: &[f64; N]| {
            plant.acceleration(q, qd, torque).unwrap_or([0.0; N])
        };
        let rest = moved(&q, &qd, &held);
        let mobility = columns(|j| {
            let mut more = held;
            more[j] += 1.0;
            difference(&moved(&q, &qd, &more), &rest, 1.0)
        });
        let slopes = |of: &Torques<N>, velocity: bool| {
            columns(|j| {
                let at = |by: f64| {
                    let (mut q, mut qd) = (q, qd);
                    if velocity {
                        qd[j] += by
                    } else {
                        q[j] += by
                    }
                    of(&q, &qd)
                };
                difference(&at(STEP), &at(-STEP), 2.0 * STEP)
            })
        };
        // The torque is held: what it answers to counts apart from what moves the arm meanwhile.
        let free = |q: &[f64; N], qd: &[f64; N]| moved(q, qd, &held);
        let whole = |velocity: bool| -> Square<N> {
            let (own, answer) = (slopes(&free, velocity), slopes(&asked, velocity));
            std::array::from_fn(|i| {
                let answered = times(&mobility[i], &answer);
                std::array::from_fn(|j| own[i][j] + answered[j])
            })
        };
        let shift = |torque: Vec<f64>| -> [f64; N] {
            std::array::from_fn(|i| -mobility[i].iter().zip(&torque).map(|(m, t)| m * t).sum::<f64>())
        };
        let parameters = family.torques(&q, &qd, &qdd).into_iter().map(shift).collect();
        Self { position: whole(false), velocity: whole(true), mobility, parameters }
    }
}

/// The row x M.
fn times<const N: usize>(x: &[f64; N], m: &Square<N>) -> [f64; N] {
    let mut out = [0.0; N];
    for (x, row) in x.iter().zip(m) {
        out.iter_mut().zip(row).for_each(|(sum, entry)| *sum += x * entry);
    }
    out
}

fn difference<const N: usize>(a: &[f64; N], b: &[f64; N], by: f64) -> [f64; N] {
    std::array::from_fn(|i| (a[i] - b[i]) / by)
}

/// The matrix, by rows, whose columns are given.
fn columns<const N: usize>(column: impl Fn(usize) -> [f64; N]) -> Square<N> {
    let columns: Square<N> = std::array::from_fn(column);
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}
