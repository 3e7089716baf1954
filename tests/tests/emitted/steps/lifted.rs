//! The runtime's laws and a graph's model in numbers that know their rounding.

use gramforge::Generation;
use gramforge::internals::control::StepGraph;
use gramforge::internals::graph::{Graph, Node, Variable};
use gramforge::internals::trig::Angle;
use gramforge_runtime::law::{
    AdaptiveLaw, ConstantGainLaw, CoriolisTerm, ExactLaw, Gains, ReportLaw, Switching, TightLaw,
};
use gramforge_runtime::{AdaptiveModel, Bounds, Desired, Estimate, Model, Real, Regression};
use gramforge_tests::array;
use gramforge_tests::tracked::Tracked;

/// A law with its numbers as they stand, exact.
pub trait Lift {
    type Lifted;
    fn lifted(&self) -> Self::Lifted;
}

fn vector<const N: usize>(x: &[f64; N]) -> [Tracked; N] {
    x.map(Tracked::exact)
}

fn matrix<const N: usize, const M: usize>(x: &[[f64; M]; N]) -> [[Tracked; M]; N] {
    std::array::from_fn(|i| vector(&x[i]))
}

fn gains<const N: usize>(g: &Gains<f64, N>) -> Gains<Tracked, N> {
    Gains { p12: matrix(&g.p12), damping: matrix(&g.damping), pqq: matrix(&g.pqq) }
}

fn switching<const N: usize>(s: &Switching<f64, N>) -> Switching<Tracked, N> {
    match s {
        Switching::Sign => Switching::Sign,
        Switching::BoundaryLayer(phi) => Switching::BoundaryLayer(vector(phi)),
    }
}

impl<const N: usize> Lift for ExactLaw<f64, N> {
    type Lifted = ExactLaw<Tracked, N>;
    fn lifted(&self) -> Self::Lifted {
        ExactLaw { gains: gains(&self.gains), coulomb: matrix(&self.coulomb) }
    }
}

impl<const N: usize> Lift for TightLaw<f64, N> {
    type Lifted = TightLaw<Tracked, N>;
    fn lifted(&self) -> Self::Lifted {
        TightLaw {
            gains: gains(&self.gains),
            disturbance: vector(&self.disturbance),
            switching: switching(&self.switching),
            coulomb: matrix(&self.coulomb),
        }
    }
}

impl<const N: usize> Lift for ConstantGainLaw<f64, N> {
    type Lifted = ConstantGainLaw<Tracked, N>;
    fn lifted(&self) -> Self::Lifted {
        ConstantGainLaw {
            gains: gains(&self.gains),
            robust_gain: vector(&self.robust_gain),
            switching: switching(&self.switching),
            coulomb: matrix(&self.coulomb),
        }
    }
}

impl<const N: usize> Lift for ReportLaw<f64, N> {
    type Lifted = ReportLaw<Tracked, N>;
    fn lifted(&self) -> Self::Lifted {
        ReportLaw {
            gains: gains(&self.gains),
            delta_c: matrix(&self.delta_c),
            coriolis_term: match &self.coriolis_term {
                CoriolisTerm::Matrix(m) => CoriolisTerm::Matrix(matrix(m)),
                CoriolisTerm::Switching => CoriolisTerm::Switching,
            },
            disturbance: vector(&self.disturbance),
            switching: switching(&self.switching),
            coulomb: matrix(&self.coulomb),
        }
    }
}

impl<const N: usize, const P: usize> Lift for AdaptiveLaw<f64, N, P> {
    type Lifted = AdaptiveLaw<Tracked, N, P>;
    fn lifted(&self) -> Self::Lifted {
        AdaptiveLaw {
            robust: self.robust.lifted(),
            rate: vector(&self.rate),
            low: vector(&self.low),
            high: vector(&self.high),
            initial: vector(&self.initial),
        }
    }
}

/// What a law has learnt, as a list.
pub trait Learnt<const P: usize> {
    fn set(&mut self, theta: &[f64; P]);
    fn get(&self) -> Vec<Tracked>;
}

impl Learnt<0> for () {
    fn set(&mut self, _theta: &[f64; 0]) {}
    fn get(&self) -> Vec<Tracked> {
        Vec::new()
    }
}

impl<const P: usize> Learnt<P> for Estimate<Tracked, P> {
    fn set(&mut self, theta: &[f64; P]) {
        *self = Self::new(vector(theta));
    }
    fn get(&self) -> Vec<Tracked> {
        self.theta().to_vec()
    }
}

/// The values of all nodes, every constant rounded once: an evaluation of a graph apart from the generator's own.
fn values(
    graph: &Graph,
    q: &[f64],
    read: impl Fn(Variable) -> Tracked,
    constant: fn(f64) -> Tracked,
) -> Vec<Tracked> {
    let turned = |j: usize| (q[j] * (1.0 / f64::from(graph.parts[j]))).sin_cos_by(&graph.sines);
    let mut all: Vec<Tracked> = Vec::with_capacity(graph.nodes.len());
    for node in &graph.nodes {
        let value = match *node {
            Node::Input(variable) => read(variable),
            Node::Sin(j) => Tracked::exact(turned(j).0),
            Node::Cos(j) => Tracked::exact(turned(j).1),
            Node::Constant(bits) => constant(f64::from_bits(bits)),
            Node::Add(a, b) => all[a] + all[b],
            Node::Sub(a, b) => all[a] - all[b],
            Node::Mul(a, b) => all[a] * all[b],
            Node::MulAdd(signs, a, b, c) => {
                let (first, added) = signs.given(all[a], all[c]);
                first * all[b] + added
            }
            Node::Neg(a) => -all[a],
            Node::Abs(a) => all[a].abs(),
            Node::Clamp(a, low, high) => {
                if all[a] > all[high] {
                    all[high]
                } else if all[a] < all[low] {
                    all[low]
                } else {
                    all[a]
                }
            }
            Node::Select(a, above, below, otherwise) => {
                if all[a].value > 0.0 {
                    all[above]
                } else if all[a].value < 0.0 {
                    all[below]
                } else {
                    all[otherwise]
                }
            }
        };
        all.push(value);
    }
    all
}

/// What the emitted step gives.
pub struct TrackedStep<const N: usize, const P: usize> {
    /// The torques before they are limited.
    pub asked: [Tracked; N],
    /// What the period takes off the parameters.
    pub correction: [Tracked; P],
}

/// The emitted step.
pub fn tracked_step<const N: usize, const P: usize>(
    step: &StepGraph,
    q: &[f64; N],
    qd: &[f64; N],
    desired: &Desired<f64, N>,
    theta: &[f64; P],
) -> TrackedStep<N, P> {
    let read = |variable| {
        Tracked::exact(match variable {
            Variable::Q(j) => q[j],
            Variable::Qd(j) => qd[j],
            Variable::DesiredQ(j) => desired.q[j],
            Variable::DesiredQd(j) => desired.qd[j],
            Variable::DesiredQdd(j) => desired.qdd[j],
            Variable::Theta(k) => theta[k],
            Variable::Vr(_) | Variable::Ar(_) => panic!("a step has no such input"),
        })
    };
    let all = values(&step.code, q, read, Tracked::rounded);
    let asked = step.asked();
    TrackedStep {
        asked: std::array::from_fn(|i| all[asked[i]]),
        correction: std::array::from_fn(|k| all[step.code.outputs[N + k]]),
    }
}

/// The model of a generation: its graph, its bounds.
pub struct TrackedModel<'a, const N: usize> {
    made: &'a Generation,
    bounds: Bounds<Tracked, N>,
    viscous: [Tracked; N],
}

impl<'a, const N: usize> TrackedModel<'a, N> {
    pub fn new(made: &'a Generation) -> Self {
        let own = made.bounds();
        let rows = |rows: &[Vec<f64>]| std::array::from_fn(|i| vector::<N>(&array(&rows[i])));
        let viscous: Vec<f64> = made.arm().joints.iter().map(|joint| joint.viscous_friction).collect();
        let bounds = Bounds {
            d: rows(&own.d),
            h: std::array::from_fn(|i| rows(&own.h[i])),
            b: vector(&array(&own.b)),
            g: vector(&array(&own.g)),
        };
        Self { made, bounds, viscous: vector(&array(&viscous)) }
    }

    fn outputs(&self, graph: &Graph, inputs: [&[Tracked; N]; 4]) -> Vec<Tracked> {
        let [q, qd, v_r, a_r] = inputs;
        let read = |variable| match variable {
            Variable::Q(j) => q[j],
            Variable::Qd(j) => qd[j],
            Variable::Vr(j) => v_r[j],
            Variable::Ar(j) => a_r[j],
            _ => panic!("a model has no such input"),
        };
        let all = values(graph, &q.map(|q| q.value), read, Tracked::exact);
        graph.outputs.iter().map(|&id| all[id]).collect()
    }
}

impl<const N: usize> Model<N> for TrackedModel<'_, N> {
    type Scalar = Tracked;

    fn passivity_torque(
        &self,
        q: &[Tracked; N],
        qd: &[Tracked; N],
        v_r: &[Tracked; N],
        a_r: &[Tracked; N],
    ) -> [Tracked; N] {
        let out = self.outputs(self.made.code(), [q, qd, v_r, a_r]);
        std::array::from_fn(|i| out[i])
    }

    fn viscous_friction(&self) -> [Tracked; N] {
        self.viscous
    }

    fn bounds(&self) -> &Bounds<Tracked, N> {
        &self.bounds
    }
}

impl<const N: usize, const P: usize> AdaptiveModel<N, P> for TrackedModel<'_, N> {
    fn regression(
        &self,
        q: &[Tracked; N],
        qd: &[Tracked; N],
        v_r: &[Tracked; N],
        a_r: &[Tracked; N],
    ) -> Regression<Tracked, N, P> {
        let regressor = self.made.regressor().expect("a law that learns");
        let mut out = self.outputs(&regressor.code, [q, qd, v_r, a_r]);
        let base = if regressor.own_base {
            self.passivity_torque(q, qd, v_r, a_r)
        } else {
            let columns = out.split_off(N);
            let base = std::array::from_fn(|i| out[i]);
            out = columns;
            base
        };
        Regression { base, columns: std::array::from_fn(|k| std::array::from_fn(|i| out[k * N + i])) }
    }
}
