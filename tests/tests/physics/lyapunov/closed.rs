//! One arm under control, and what V does.

use gramforge::Generation;
use gramforge::internals::arm::Arm;
use gramforge::internals::control::Design;
use gramforge::internals::simulate::ArmModel;
use gramforge_runtime::law::{Sample, Tracking, lyapunov};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{JointState, Plant, RigidPlant, Simulation};
use gramforge_runtime::{CoriolisTerm, Gains, Model, ReportLaw, Switching, TorqueController};
use gramforge_tests::array;
use gramforge_tests::random::Random;

fn square<const N: usize>(rows: &[Vec<f64>]) -> [[f64; N]; N] {
    let rows: Vec<[f64; N]> = rows.iter().map(|row| array(row)).collect();
    rows.try_into().expect("one row a joint")
}

pub fn report<const N: usize>(design: &Design) -> ReportLaw<f64, N> {
    let [p12, damping, pqq] =
        [&design.gains.p12, &design.gains.damping, &design.gains.pqq].map(|m| square(m));
    ReportLaw {
        gains: Gains { p12, damping, pqq },
        delta_c: square(&design.delta_c),
        coriolis_term: CoriolisTerm::Matrix(square(&design.delta_c1)),
        disturbance: array(&design.disturbance),
        switching: Switching::BoundaryLayer(array(design.boundary_layer.as_ref().expect("a layer"))),
        coulomb: [[0.0; 2]; N],
    }
}

/// An arm of the family, the first ones at its vertices, with its own viscous friction.
pub fn member(generation: &Generation, index: usize, random: &mut Random) -> (Vec<f64>, Arm) {
    let family = generation.uncertainty();
    let share = |random: &mut Random| 0.5 + 0.5 * random.signed();
    let u: Vec<f64> = match family.vertices().nth(index) {
        Some(vertex) => vertex,
        None => family.parameters.iter().map(|p| p.low + share(random) * (p.high - p.low)).collect(),
    };
    let mut arm = family.at(generation.arm(), &u);
    for (joint, width) in arm.joints.iter_mut().zip(&family.viscous) {
        joint.viscous_friction += width * random.signed();
    }
    (u, arm)
}

pub fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times<const N: usize>(m: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    m.map(|row| dot(&row, x))
}

/// One arm of `N` joints under control, and what V does.
pub struct Loop<'a, const N: usize> {
    pub plant: RigidPlant<ArmModel<'a, N>, N>,
    pub gains: Gains<f64, N>,
}

impl<'a, const N: usize> Loop<'a, N> {
    pub fn new(arm: &'a Arm, gains: Gains<f64, N>) -> Self {
        let coulomb: Vec<[f64; 2]> = arm.joints.iter().map(|joint| joint.coulomb_friction).collect();
        let coulomb = coulomb.try_into().expect("one entry a joint");
        Self { plant: RigidPlant { model: ArmModel::new(arm).unwrap(), coulomb }, gains }
    }

    /// V̇ = sᵀ(τ − D a_r − C v_r − G − B q̇ − F) + q_eᵀ Pqq q̇_e, with the plant's own everything.
    pub fn rate(&self, sample: &Sample<f64, N>, torque: &[f64; N]) -> f64 {
        let Sample { q, qd, .. } = sample;
        let Tracking { q_e, qd_e, s, v_r, a_r } = Tracking::new(&self.gains.p12, sample);
        let needed = self.plant.model.passivity_torque(q, qd, &v_r, &a_r);
        let viscous = self.plant.model.viscous_friction();
        let excess: [f64; N] = std::array::from_fn(|i| {
            let rubbed = self.plant.coulomb[i][usize::from(qd[i] < 0.0)];
            torque[i] - needed[i] - viscous[i] * qd[i] - rubbed
        });
        dot(&s, &excess) + dot(&q_e, &times(&self.gains.pqq, &qd_e))
    }

    /// zᵀMz of equation (17).
    pub fn dissipation(&self, sample: &Sample<f64, N>) -> f64 {
        let Tracking { q_e, s, .. } = Tracking::new(&self.gains.p12, sample);
        let omega = times(&self.gains.pqq, &times(&self.gains.p12, &q_e));
        dot(&s, &times(&self.gains.damping, &s)) - 2.0 * dot(&s, &times(&self.gains.pqq, &q_e))
            + dot(&q_e, &omega)
    }

    /// Runs `controller` and shows every control instant to `judge`; gives the errors at the end.
    pub fn run<C: TorqueController<N, Scalar = f64>>(
        &self,
        mut controller: C,
        reference: &impl Reference<f64, N>,
        start: f64,
        seconds: f64,
        mut judge: impl FnMut(&Sample<f64, N>, &[f64; N], &C::Learnt),
    ) -> [f64; N] {
        let period = controller.period();
        let at = reference.at(0.0);
        let state = JointState { q: at.q.map(|q| q + start), qd: at.qd };
        let mut simulation = Simulation::new(&self.plant, state, period, 1).unwrap();
        let mut last = [0.0; N];
        while simulation.time() < seconds {
            let before = *controller.learnt();
            let record = simulation.step(&mut controller, reference).unwrap();
            let command = record.command.unwrap();
            let JointState { q, qd } = record.state;
            // At rest Coulomb friction is whatever balances.
            if command.saturated == [false; N] && qd.iter().all(|v| *v != 0.0) {
                judge(&Sample { q, qd, desired: record.desired, period }, &command.torque, &before);
            }
            last = std::array::from_fn(|i| (q[i] - record.desired.q[i]).abs());
        }
        last
    }

    /// V̇ by differences along the plant's own motion under `torque`.
    pub fn differences(
        &self,
        sample: &Sample<f64, N>,
        torque: &[f64; N],
        reference: &impl Reference<f64, N>,
        t: f64,
    ) -> f64 {
        let h = 1e-5;
        let qdd = self.plant.acceleration(&sample.q, &sample.qd, torque).unwrap();
        let v = |h: f64| {
            let q = std::array::from_fn(|i| sample.q[i] + h * (sample.qd[i] + 0.5 * h * qdd[i]));
            let qd = std::array::from_fn(|i| sample.qd[i] + h * qdd[i]);
            lyapunov(
                &self.plant.model,
                &self.gains,
                &Sample { q, qd, desired: reference.at(t + h), ..*sample },
            )
        };
        (v(h) - v(-h)) / (2.0 * h)
    }
}
