//! A controller: its law, its gains, what they promise, and its step.

use super::step::{RobustGain, StepGraph, StepParts};
use super::{Adaptation, Envelope, Gains, Guarantee, ReferenceLimits, least_eigenvalue, outweighs};
use crate::bounds::{Bounds, Rates};
use crate::check::Control;
use crate::error::Diagnostics;
use crate::graph::Graph;
use crate::spec::{CoriolisTermSpec, LawSpec, OnFaultSpec};
use crate::torque::Regressor;

/// Everything a controller needs beside its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Which law.
    pub law: LawSpec,
    /// P12, K and Pqq.
    pub gains: Gains,
    /// W of equation (16), n×n, N·m·s/rad.
    pub w: Vec<Vec<f64>>,
    /// Ω of equation (16), n×n, N·m/(rad·s).
    pub omega: Vec<Vec<f64>>,
    /// What the errors and speeds stay below, given the initial error.
    pub envelope: Envelope,
    /// The largest rates that multiply the model while the errors stay in the envelope, feedback included; `None` where no
    /// level of V holds them.
    pub rates: Option<Rates>,
    /// ΔC of equation (30), n×n, N·m·s/rad.
    pub delta_c: Vec<Vec<f64>>,
    /// k* = λ_max(sym ΔC), N·m·s/rad.
    pub k_star: f64,
    /// The variant of (34).
    pub coriolis_term: CoriolisTermSpec,
    /// What a robust law switches with.
    pub robust_gain: RobustGain,
    /// ΔC1, n×n: the specification's, which was verified, or k*·I.
    pub delta_c1: Vec<Vec<f64>>,
    /// Bound on the Coulomb friction that the command does not cancel, by joint, N·m or N.
    pub disturbance: Vec<f64>,
    /// φ of the boundary layer by joint; `None` for the sign function.
    pub boundary_layer: Option<Vec<f64>>,
    /// Control period, s.
    pub period: f64,
    /// Largest torque by joint, N·m or N.
    pub torque_limit: Vec<Option<f64>>,
    /// Coulomb friction to compensate, forwards and backwards, by joint; zero where not asked for.
    pub coulomb: Vec<[f64; 2]>,
    /// What to command when a measurement is not finite.
    pub on_fault: OnFaultSpec,
    /// What law `adaptive` learns.
    pub adaptation: Option<Adaptation>,
    /// What the desired motion must keep for that; `None` with a motion in the specification.
    pub reference: Option<ReferenceLimits>,
    /// What all that promises.
    pub guarantee: Guarantee,
}

/// The model that a step computes with.
#[derive(Clone, Copy, Debug)]
pub struct StepModel<'a> {
    /// The passivity torque.
    pub code: &'a Graph,
    /// The same as a function of what the law learns.
    pub regressor: Option<&'a Regressor>,
    /// What it leaves out.
    pub bounds: &'a Bounds,
    /// Viscous friction of each joint, N·m·s/rad or N·s/m.
    pub viscous: &'a [f64],
}

impl Design {
    /// The step of this law about the model `code` with these `bounds`.
    pub fn step(&self, model: &StepModel) -> StepGraph {
        StepParts {
            law: self.law,
            gains: &self.gains,
            damping: &self.damping(),
            robust_gain: &self.robust_gain,
            coriolis_term: self.coriolis_term,
            delta_c: &self.delta_c,
            bounds: model.bounds,
            disturbance: &self.disturbance,
            boundary_layer: self.boundary_layer.as_deref(),
            viscous: model.viscous,
            coulomb: &self.coulomb,
            torque_limit: &self.torque_limit,
            period: self.period,
            adaptation: self.adaptation.as_ref(),
            code: model.code,
            regressor: model.regressor,
        }
        .graph()
    }

    /// What multiplies s in the law beside the switching term: K, with ΔC1 where the law subtracts ΔC1 s, n×n, N·m·s/rad.
    pub fn damping(&self) -> Vec<Vec<f64>> {
        let more = self.law.has_bracket()
            && self.coriolis_term == CoriolisTermSpec::Matrix
            && self.robust_gain == RobustGain::State;
        if !more {
            return self.gains.damping.clone();
        }
        let sum = |(k, c): (&Vec<f64>, &Vec<f64>)| k.iter().zip(c).map(|(k, c)| k + c).collect();
        self.gains.damping.iter().zip(&self.delta_c1).map(sum).collect()
    }

    /// The step of the same law about the exact model, whose code is `code`, with nothing left out.
    pub fn exact_step(&self, code: &Graph, viscous: &[f64]) -> StepGraph {
        let n = viscous.len();
        let zero = vec![vec![0.0; n]; n];
        let bounds = Bounds { d: zero.clone(), h: vec![zero.clone(); n], b: vec![0.0; n], g: vec![0.0; n] };
        let exact =
            Self { robust_gain: RobustGain::State, delta_c: zero.clone(), delta_c1: zero, ..self.clone() };
        exact.step(&StepModel { code, regressor: None, bounds: &bounds, viscous })
    }

    /// True where everything that is computed is a finite number.
    pub fn is_finite(&self) -> bool {
        let Envelope { v_max, position_error, velocity_error, speed, level } = &self.envelope;
        let lists = [position_error, velocity_error, speed].into_iter().chain(&self.delta_c);
        self.gains.is_finite() && lists.flatten().chain([v_max, level, &self.k_star]).all(|v| v.is_finite())
    }

    /// What of the specification these numbers break.
    pub(super) fn check(&self, control: &Control, faults: &mut Diagnostics) {
        let least = least_eigenvalue(&self.delta_c1, &self.delta_c);
        if control.delta_c1.is_some() && !outweighs(least, &self.delta_c) {
            faults.push(
                "control.delta_c1",
                format!(
                    "does not outweigh ΔC: for some δC with |δC| ≤ ΔC the least eigenvalue of ΔC1 + sym(δC) is {least:.6}"
                ),
                format!(
                    "add {:.6} to its diagonal, or leave it out for {:.6} times the identity",
                    -least, self.k_star
                ),
            );
        }
    }
}
