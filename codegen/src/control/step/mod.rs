//! Law and model as one graph: the control step that is emitted, counted, interpreted and judged.
//!
//! Constants are folded: zero gains and bounds leave no operation, K and ΔC1 are one matrix, a boundary layer is a product
//! with 1/φ. The terms are those of the runtime's laws, so that both differ by rounding alone.

mod bracket;
mod learning;
mod rounding;

pub use rounding::{StepRounding, StepStates, Surroundings, step_rounding};

use super::{Adaptation, Gains};
use crate::bounds::Bounds;
use crate::dynamics::Scalar;
use crate::graph::{Builder, Expr, Graph, Leaf, Node, Operations, Variable};
use crate::spec::{CoriolisTermSpec, LawSpec};
use crate::torque::Regressor;

/// What a robust law switches with.
#[derive(Clone, Debug, PartialEq)]
pub enum RobustGain {
    /// The law's own bracket, at the state of the instant.
    State,
    /// One number by joint, N·m or N.
    Constant(Vec<f64>),
}

/// What a step is made of.
#[derive(Clone, Copy, Debug)]
pub struct StepParts<'a> {
    /// Which law.
    pub law: LawSpec,
    /// P12, K and Pqq.
    pub gains: &'a Gains,
    /// K, with ΔC1 where the law subtracts ΔC1 s.
    pub damping: &'a [Vec<f64>],
    /// ρ of a robust law.
    pub robust_gain: &'a RobustGain,
    /// The variant of (34).
    pub coriolis_term: CoriolisTermSpec,
    /// ΔC of equation (30), n×n, N·m·s/rad.
    pub delta_c: &'a [Vec<f64>],
    /// What the model leaves out.
    pub bounds: &'a Bounds,
    /// Bound on torques that no model has, by joint, N·m or N.
    pub disturbance: &'a [f64],
    /// φ by joint; `None` for the sign function.
    pub boundary_layer: Option<&'a [f64]>,
    /// Viscous friction of each joint, N·m·s/rad or N·s/m.
    pub viscous: &'a [f64],
    /// Coulomb friction that the command compensates, forwards and backwards, by joint, N·m or N.
    pub coulomb: &'a [[f64; 2]],
    /// Largest torque by joint, N·m or N.
    pub torque_limit: &'a [Option<f64>],
    /// Control period, s.
    pub period: f64,
    /// What the law learns.
    pub adaptation: Option<&'a Adaptation>,
    /// The passivity torque.
    pub code: &'a Graph,
    /// The same as a function of what is learnt.
    pub regressor: Option<&'a Regressor>,
}

/// A control step as a graph.
///
/// Holds: the outputs are the torques within their limits by joint, then what the period takes off the parameters, then the sum of
/// the inputs that no torque depends on, if there are any. An infinite or NaN input makes that sum or some torque, before it is
/// limited, infinite or NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct StepGraph {
    /// The graph.
    pub code: Graph,
    /// Number of joints.
    pub joints: usize,
    /// Number of parameters that the law learns.
    pub parameters: usize,
}

/// Errors and reference motion of the instant, by joint: [`gramforge_runtime::law::Tracking`].
struct Tracking<'g> {
    q_e: Vec<Expr<'g>>,
    qd_e: Vec<Expr<'g>>,
    s: Vec<Expr<'g>>,
    v_r: Vec<Expr<'g>>,
    a_r: Vec<Expr<'g>>,
}

impl StepParts<'_> {
    /// The step; its products are fused with sums where those of the model are.
    pub fn graph(&self) -> StepGraph {
        let step = self.graph_with(&[]);
        let step = match step.unread() {
            unread if unread.is_empty() => step,
            unread => self.graph_with(&unread),
        };
        StepGraph { code: self.code.alike(step.code), ..step }
    }

    /// The step with the sum of these inputs as its last output, if there are any.
    fn graph_with(&self, unread: &[Variable]) -> StepGraph {
        let builder = Builder::new();
        builder.divide(self.code.parts);
        let n = self.gains.p12.len();
        let tracking = self.tracking(&builder);
        let (passivity, columns) = self.passivity(&builder, &tracking);
        let switched = self.switched(&builder, &tracking);
        let feedback = |i: usize| {
            let inputs = |of: fn(usize) -> Variable| builder.input(of(i));
            let [forwards, backwards] = self.coulomb[i].map(|level| builder.constant(level));
            let viscous = builder.constant(self.viscous[i]) * inputs(Variable::Qd);
            let coulomb = inputs(Variable::DesiredQd).select(forwards, backwards, builder.constant(0.0));
            let torque =
                passivity[i] + viscous + coulomb + weighed(&builder, &self.gains.pqq[i], &tracking.q_e)
                    - weighed(&builder, &self.damping[i], &tracking.s);
            switched[i].map_or(torque, |switched| torque - switched).named(&format!("tau{}", i + 1), true)
        };
        let torques: Vec<Expr> = (0..n).map(feedback).collect();
        let mut outputs: Vec<Expr> = torques.iter().zip(self.torque_limit).map(limited).collect();
        let learnt = self.learnt(&builder, &tracking, &columns);
        let parameters = learnt.len();
        outputs.extend(learnt);
        let inputs = unread.iter().map(|&variable| builder.input(variable));
        outputs.extend(inputs.reduce(|sum, input| sum + input));
        let outputs: Vec<_> = outputs.into_iter().map(Expr::id).collect();
        StepGraph { code: builder.finish(&outputs), joints: n, parameters }
    }

    fn tracking<'g>(&self, builder: &'g Builder) -> Tracking<'g> {
        let n = self.gains.p12.len();
        let all = |make: &dyn Fn(usize) -> Expr<'g>, name: &str| -> Vec<Expr<'g>> {
            (0..n).map(|i| make(i).named(&format!("{name}{}", i + 1), true)).collect()
        };
        let input = |variable| builder.input(variable);
        let q_e = all(&|i| input(Variable::Q(i)) - input(Variable::DesiredQ(i)), "q_e");
        let qd_e = all(&|i| input(Variable::Qd(i)) - input(Variable::DesiredQd(i)), "qd_e");
        let pulled = all(&|i| weighed(builder, &self.gains.p12[i], &q_e), "p12_q_e");
        let s = all(&|i| qd_e[i] + pulled[i], "s");
        let v_r = all(&|i| input(Variable::DesiredQd(i)) - pulled[i], "v_r");
        let slowed = |i: usize| weighed(builder, &self.gains.p12[i], &qd_e);
        let a_r = all(&|i| input(Variable::DesiredQdd(i)) - slowed(i), "a_r");
        Tracking { q_e, qd_e, s, v_r, a_r }
    }

    /// The passivity torque at θ̂ by joint, and Y by columns.
    fn passivity<'g>(
        &self,
        builder: &'g Builder,
        tracking: &Tracking<'g>,
    ) -> (Vec<Expr<'g>>, Vec<Vec<Expr<'g>>>) {
        let leaf = |leaf| match leaf {
            Leaf::Input(Variable::Vr(j)) => tracking.v_r[j],
            Leaf::Input(Variable::Ar(j)) => tracking.a_r[j],
            Leaf::Input(variable) => builder.input(variable),
            Leaf::Sin(j) => builder.sin_cos(j).0,
            Leaf::Cos(j) => builder.sin_cos(j).1,
        };
        // Above the line of the model's torque the law's stands.
        let name = |name: &str| Some(name.replace("tau", "model"));
        let embedded = |graph: &Graph| -> Vec<Expr<'g>> {
            let made = builder.embed(graph, leaf, name);
            graph.outputs.iter().map(|&output| made[output]).collect()
        };
        let n = self.gains.p12.len();
        let Some(regressor) = self.regressor else { return (embedded(self.code), Vec::new()) };
        let mut outputs = if regressor.own_base { embedded(self.code) } else { Vec::new() };
        outputs.extend(embedded(&regressor.code));
        let columns: Vec<Vec<Expr>> = outputs.split_off(n).chunks(n).map(<[Expr]>::to_vec).collect();
        let at_theta = |(i, &base): (usize, &Expr<'g>)| {
            columns
                .iter()
                .enumerate()
                .fold(base, |sum, (k, column)| sum + builder.input(Variable::Theta(k)) * column[i])
        };
        (outputs.iter().enumerate().map(at_theta).collect(), columns)
    }
}

impl StepGraph {
    /// What one step computes, with the sums of a law that learns: the loop's [`gramforge_runtime::Estimate::correct`] takes four
    /// additions and a clamp for each parameter.
    pub fn operations(&self) -> Operations {
        let graph = self.code.operations();
        Operations { add: graph.add + 4 * self.parameters, other: graph.other + self.parameters, ..graph }
    }

    /// The torques before they are limited.
    pub fn asked(&self) -> Vec<usize> {
        let raw = |&output: &usize| match self.code.nodes[output] {
            Node::Clamp(raw, ..) => raw,
            _ => output,
        };
        self.code.outputs[..self.joints].iter().map(raw).collect()
    }

    /// The inputs whose infinity or NaN reaches no torque before it is limited. The others have a way to a torque through sums,
    /// products, negations, absolute values, sines and cosines alone. None of these makes a finite number of what is not finite.
    fn unread(&self) -> Vec<Variable> {
        let mut reaches = vec![false; self.code.nodes.len()];
        self.asked().into_iter().for_each(|torque| reaches[torque] = true);
        for (id, node) in self.code.nodes.iter().enumerate().rev() {
            if reaches[id] && !matches!(node, Node::Clamp(..) | Node::Select(..)) {
                node.operands().for_each(|operand| reaches[operand] = true);
            }
        }
        let read = |variable: Variable| {
            self.code.nodes.iter().zip(&reaches).any(|(node, &reached)| {
                reached
                    && match *node {
                        Node::Input(input) => input == variable,
                        Node::Sin(j) | Node::Cos(j) => variable == Variable::Q(j),
                        _ => false,
                    }
            })
        };
        let inputs: [fn(usize) -> Variable; 5] =
            [Variable::Q, Variable::Qd, Variable::DesiredQ, Variable::DesiredQd, Variable::DesiredQdd];
        let all = (0..self.joints).flat_map(|j| inputs.map(|input| input(j)));
        all.filter(|&variable| !read(variable)).collect()
    }
}

/// Σ w_j x_j over the weights that are not 0.
fn weighed<'g>(builder: &'g Builder, weights: &[f64], x: &[Expr<'g>]) -> Expr<'g> {
    let terms = weights.iter().zip(x).filter(|(w, _)| **w != 0.0);
    terms.fold(builder.constant(0.0), |sum, (&w, &x)| sum + builder.constant(w) * x)
}

/// The torque within its limit.
fn limited<'g>((torque, limit): (&Expr<'g>, &Option<f64>)) -> Expr<'g> {
    limit.map_or(*torque, |limit| torque.clamp(torque.constant(-limit), torque.constant(limit)))
}
