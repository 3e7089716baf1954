//! The exact arm and the reduced graph as models that the runtime's laws can drive.

use std::array::from_fn;

use gramforge_runtime::{Bounds as RuntimeBounds, Model};

use super::array::{cube, matrix, vector};
use crate::arm::Arm;
use crate::bounds::Bounds;
use crate::dynamics;
use crate::error::Error;
use crate::graph::Graph;

/// The exact model of an arm with `N` joints, by the Newton–Euler recursion: zero bounds.
#[derive(Clone, Copy, Debug)]
pub struct ArmModel<'a, const N: usize> {
    arm: &'a Arm,
    viscous_friction: [f64; N],
    bounds: RuntimeBounds<f64, N>,
}

impl<'a, const N: usize> ArmModel<'a, N> {
    /// The model of `arm`.
    ///
    /// # Errors
    /// [`Error::Internal`] where the arm has not `N` joints.
    pub fn new(arm: &'a Arm) -> Result<Self, Error> {
        Ok(Self { arm, viscous_friction: viscous_friction(arm)?, bounds: RuntimeBounds::ZERO })
    }
}

impl<const N: usize> Model<N> for ArmModel<'_, N> {
    type Scalar = f64;

    fn passivity_torque(&self, q: &[f64; N], qd: &[f64; N], v_r: &[f64; N], a_r: &[f64; N]) -> [f64; N] {
        let q = dynamics::positions(self.arm, q);
        exactly(&dynamics::passivity_torque(self.arm, self.arm.gravity, &q, qd, v_r, a_r))
    }

    fn viscous_friction(&self) -> [f64; N] {
        self.viscous_friction
    }

    fn bounds(&self) -> &RuntimeBounds<f64, N> {
        &self.bounds
    }

    // The default subtracts gravity from every column; without gravity there is nothing to cancel.
    fn mass_matrix(&self, q: &[f64; N]) -> [[f64; N]; N] {
        let rows = dynamics::mass_matrix(self.arm, q);
        from_fn(|i| rows.get(i).map_or([f64::NAN; N], |row| exactly(row)))
    }
}

/// A model in the form of its expression graph, interpreted: the numbers of the generated code, bit by bit.
#[derive(Clone, Copy, Debug)]
pub struct GraphModel<'a, const N: usize> {
    graph: &'a Graph,
    viscous_friction: [f64; N],
    bounds: RuntimeBounds<f64, N>,
}

impl<'a, const N: usize> GraphModel<'a, N> {
    /// The model whose passivity torque, N·m or N, `graph` computes, with the bounds on what it leaves out and the viscous
    /// friction of `arm`.
    ///
    /// # Errors
    /// [`Error::Internal`] where arm, graph or bounds are not those of `N` joints.
    pub fn new(graph: &'a Graph, bounds: &Bounds, arm: &Arm) -> Result<Self, Error> {
        vector::<_, N>("the graph's output", &graph.outputs)?;
        let bounds = RuntimeBounds {
            d: matrix("ΔD", &bounds.d)?,
            h: cube("Δh", &bounds.h)?,
            b: vector("ΔB", &bounds.b)?,
            g: vector("ΔG", &bounds.g)?,
        };
        Ok(Self { graph, viscous_friction: viscous_friction(arm)?, bounds })
    }

    /// The same of an exact model, which leaves nothing out.
    ///
    /// # Errors
    /// As [`GraphModel::new`].
    pub fn exact(graph: &'a Graph, arm: &Arm) -> Result<Self, Error> {
        vector::<_, N>("the graph's output", &graph.outputs)?;
        Ok(Self { graph, viscous_friction: viscous_friction(arm)?, bounds: RuntimeBounds::ZERO })
    }
}

impl<const N: usize> Model<N> for GraphModel<'_, N> {
    type Scalar = f64;

    fn passivity_torque(&self, q: &[f64; N], qd: &[f64; N], v_r: &[f64; N], a_r: &[f64; N]) -> [f64; N] {
        exactly(&self.graph.interpret(q, qd, v_r, a_r))
    }

    fn viscous_friction(&self) -> [f64; N] {
        self.viscous_friction
    }

    fn bounds(&self) -> &RuntimeBounds<f64, N> {
        &self.bounds
    }
}

fn viscous_friction<const N: usize>(arm: &Arm) -> Result<[f64; N], Error> {
    let friction: Vec<f64> = arm.joints.iter().map(|joint| joint.viscous_friction).collect();
    vector("the arm", &friction)
}

/// The first `N` values. The constructors have seen to the length; were one missing, the controller would report the
/// NaN.
fn exactly<const N: usize>(values: &[f64]) -> [f64; N] {
    from_fn(|i| values.get(i).copied().unwrap_or(f64::NAN))
}
