//! The loop that runs: the emitted step, interpreted, on the plant.

use gramforge::Generation;
use gramforge::internals::graph::Tape;
use gramforge::internals::guarantee::{Kind, Sampled};
use gramforge::spec::ScalarSpec;
use gramforge_tests::chain::Chain;
use gramforge_tests::plant::{Plant, Row, row};

use super::found::Found;

/// Longest Runge–Kutta step, s.
const LONGEST: f64 = 0.5e-3;
/// Time that a run goes on after a motion that rests at its end, s.
const AFTER: f64 = 1.0;
/// What the simulation itself may be off by, rad or m: the rounding of positions, and what Runge–Kutta steps leave out.
pub const OWN: f64 = 1e-12;

/// The desired state at a sample.
#[derive(Clone, Debug)]
pub struct Desired {
    pub q: Row,
    pub qd: Row,
    pub qdd: Row,
}

/// A controller, what is promised of it, and the arms that it may meet.
pub struct Loop {
    pub promised: Sampled,
    /// The arm as specified.
    pub arm: Plant,
    pub family: Vec<Plant>,
    pub n: usize,
    pub period: f64,
    /// Periods of a run, and those until the motion ends.
    pub periods: usize,
    pub end: usize,
    /// Time for which the error at the end is promised, s, and q_d then.
    finish: f64,
    last: Row,
    pub substeps: usize,
    pub desired: Vec<Desired>,
    /// q_d after each Runge–Kutta step, a period's steps one after the other.
    between: Vec<Row>,
    tape: Tape<f64>,
    model: Tape<f64>,
    p12: Row,
    /// By how much the step may be off at each sample, N·m or N. Empty for an exact model in f64, whose rounding the plant could not
    /// tell from its own. In f32 the step is computed in f64 here, and what it would round by is added.
    pub push: Vec<Row>,
}

/// What a run starts from, drives and is pushed by.
#[derive(Clone, Debug)]
pub struct Attack {
    pub position: Row,
    pub velocity: Row,
    pub arm: usize,
    /// By period and joint, the side on which the model is wrong.
    pub sides: Vec<[i8; gramforge_tests::plant::MOST]>,
}

impl Loop {
    /// The loop of `generation` on the arms `family`, for the motion and 1 s more if it rests at its end.
    pub fn new(generation: &Generation, specified: &Chain, family: &[Chain]) -> Self {
        Self::until(generation, specified, family, AFTER)
    }

    /// The same, with `rest` s after a motion that rests at its end.
    pub fn until(generation: &Generation, specified: &Chain, family: &[Chain], rest: f64) -> Self {
        let statement = generation.statement().expect("a statement");
        assert_eq!(statement.kind, Kind::Sampled, "{:?}", statement.reasons);
        let sampled = statement.sampled.clone().expect("what is proved");
        Self::promised(generation, specified, family, sampled, rest)
    }

    /// The same, of which nothing is promised, with the model as it is.
    pub fn without_promise(
        generation: &Generation,
        specified: &Chain,
        family: &[Chain],
        settle: f64,
    ) -> Self {
        let any = vec![f64::INFINITY; specified.dof()];
        let promised = Sampled {
            reach: any.clone(),
            settle,
            settled_error: None,
            end_error: any.clone(),
            speed_error: any.clone(),
            valid_until: None,
            torque: vec![[f64::NEG_INFINITY, f64::INFINITY]; specified.dof()],
            torque_error: Vec::new(),
            torque_time: vec![0.0; specified.dof()],
            course: Vec::new(),
        };
        Self { push: Vec::new(), ..Self::promised(generation, specified, family, promised, AFTER) }
    }

    fn promised(
        generation: &Generation,
        specified: &Chain,
        family: &[Chain],
        promised: Sampled,
        rest: f64,
    ) -> Self {
        let motion = generation.motion().expect("a motion").clone();
        let design = generation.design().expect("a controller").clone();
        let (n, period) = (generation.given().dof(), design.period);
        let end = (motion.duration() / period - 1e-9).ceil() as usize;
        let periods = end + if motion.rests() { (rest / period).ceil() as usize } else { 0 };
        // A motion that does not rest at its end is followed to the last sample within it.
        let until = promised.valid_until.unwrap_or(f64::INFINITY);
        let finish = if motion.rests() { motion.duration() } else { motion.duration().min(until) };
        let last = row(&motion.at(finish).q);
        let substeps = (period / LONGEST - 1e-9).ceil().max(1.0) as usize;
        let target = |t: f64| {
            let at = motion.at(t);
            let still = motion.rests() && t >= motion.duration();
            let rate = |x: &[f64]| if still { row(&[]) } else { row(x) };
            Desired { q: row(&at.q), qd: rate(&at.qd), qdd: rate(&at.qdd) }
        };
        let desired: Vec<Desired> = (0..=periods).map(|k| target(k as f64 * period)).collect();
        let h = period / substeps as f64;
        let between =
            (0..periods)
                .flat_map(|k| (1..=substeps).map(move |j| (k, j)))
                .map(|(k, j)| {
                    if j == substeps { desired[k + 1].q } else { target(k as f64 * period + j as f64 * h).q }
                })
                .collect();
        let p12: Vec<f64> = (0..n).map(|i| design.gains.p12[i][i]).collect();
        let precise = generation.reduced().is_exact() && generation.spec().emit.scalar == ScalarSpec::F64;
        // The bound that held at each sample, and not a later one.
        let pushed = |k: usize| {
            let time = k as f64 * period + 1e-9 * period;
            let held = promised.torque_error.iter().take_while(|(from, _)| *from <= time).last();
            held.map_or(row(&[]), |(_, torque)| row(torque))
        };
        let push = if precise { Vec::new() } else { (0..periods).map(pushed).collect() };
        Self {
            tape: Tape::new(&generation.step().expect("a step").code),
            model: Tape::new(generation.code()),
            arm: Plant::new(specified),
            family: family.iter().map(Plant::new).collect(),
            p12: row(&p12),
            promised,
            n,
            period,
            periods,
            end,
            finish,
            last,
            substeps,
            desired,
            between,
            push,
        }
    }

    /// The same for the first `seconds` alone.
    pub fn shortened(mut self, seconds: f64) -> Self {
        self.periods = self.periods.min((seconds / self.period) as usize);
        self
    }

    /// The torque that the step asks for at sample `k`.
    pub fn asked(&self, k: usize, q: &Row, qd: &Row) -> Row {
        let (n, desired) = (self.n, &self.desired[k]);
        let inputs = [&desired.q[..n], &desired.qd[..n], &desired.qdd[..n]];
        row(&self.tape.interpret_step(&q[..n], &qd[..n], inputs, &[])[..n])
    }

    /// The model's torque less that of the arm as specified, at sample `k`.
    fn model_error(&self, k: usize, q: &Row, qd: &Row) -> Row {
        let (n, desired) = (self.n, &self.desired[k]);
        let v_r: Row = std::array::from_fn(|i| desired.qd[i] - self.p12[i] * (q[i] - desired.q[i]));
        let a_r: Row = std::array::from_fn(|i| desired.qdd[i] - self.p12[i] * (qd[i] - desired.qd[i]));
        let own = self.model.interpret(&q[..n], &qd[..n], &v_r[..n], &a_r[..n]);
        let exact = self.arm.passivity_torque(q, qd, &v_r, &a_r);
        std::array::from_fn(|i| own.get(i).map_or(0.0, |own| own - exact[i]))
    }

    /// One run.
    pub fn run(&self, attack: &Attack) -> Found {
        let mut found = Found { runs: 1, ..Found::default() };
        let plant = &self.family[attack.arm];
        let first = &self.desired[0];
        let mut q: Row = std::array::from_fn(|i| first.q[i] + attack.position[i]);
        let mut qd: Row = std::array::from_fn(|i| first.qd[i] + attack.velocity[i]);
        self.look(&mut found, 0, 0.0, &first.q, &q);
        let h = self.period / self.substeps as f64;
        for k in 0..self.periods {
            let torque = self.pushed(&mut found, k, &q, &qd, attack);
            self.look_at_end(&mut found, k, plant, [q, qd], &torque);
            for j in 0..self.substeps {
                plant.step(&mut q, &mut qd, &torque, h);
                let t = k as f64 * self.period + (j + 1) as f64 * h;
                self.look(&mut found, k + 1, t, &self.between[k * self.substeps + j], &q);
            }
        }
        found
    }

    /// The torque at sample `k`, looked at before it is pushed.
    fn pushed(&self, found: &mut Found, k: usize, q: &Row, qd: &Row, attack: &Attack) -> Row {
        let mut torque = self.asked(k, q, qd);
        for i in 0..self.n {
            found.torque[0][i] = found.torque[0][i].min(torque[i]);
            found.torque[1][i] = found.torque[1][i].max(torque[i]);
            let [low, high] = self.promised.torque[i];
            if !(low <= torque[i] && torque[i] <= high) {
                found.broken.get_or_insert_with(|| {
                    format!("joint {} asks for {} at period {k}, outside {low} to {high}", i + 1, torque[i])
                });
            }
        }
        let Some(push) = self.push.get(k) else { return torque };
        let error = self.model_error(k, q, qd);
        for i in 0..self.n {
            found.model_error = found.model_error.max(error[i].abs() / push[i]);
            if error[i].is_nan() || error[i].abs() > push[i] * (1.0 + 1e-9) {
                found.broken.get_or_insert_with(|| {
                    format!("the model is wrong by {} at joint {}, period {k}", error[i], i + 1)
                });
            }
            torque[i] += f64::from(attack.sides[k][i]) * push[i] - error[i];
        }
        torque
    }

    /// Compares the errors in period `k` − 1, or at the start, with their bounds.
    fn look(&self, found: &mut Found, k: usize, t: f64, desired: &Row, q: &Row) {
        let promised = &self.promised;
        let settled = t >= promised.settle;
        for i in 0..self.n {
            let error = (q[i] - desired[i]).abs();
            found.reach[i] = found.reach[i].max(error);
            if settled {
                found.settled[i] = found.settled[i].max(error);
            }
            let mut bound = promised.reach[i];
            if promised.valid_until.is_some_and(|until| t > until * (1.0 + 1e-12)) {
                continue;
            }
            if let Some((_, course)) = promised.course.get(k) {
                bound = bound.min(course[i]);
            }
            if let (true, Some(late)) = (settled, &promised.settled_error) {
                bound = bound.min(late[i]);
            }
            if error.is_nan() || error > bound + OWN {
                found.broken.get_or_insert_with(|| {
                    format!("|q_e| of joint {} is {error} at t = {t} s, more than {bound}", i + 1)
                });
            }
        }
    }

    /// Compares the error at the end with its bound where that lies in period `k`, which starts in this state.
    fn look_at_end(&self, found: &mut Found, k: usize, plant: &Plant, state: [Row; 2], torque: &Row) {
        let part = self.finish - k as f64 * self.period;
        let hair = 1e-9 * self.period;
        if !(hair < part && part <= self.period + hair) {
            return;
        }
        let [mut q, mut qd] = state;
        for _ in 0..self.substeps {
            plant.step(&mut q, &mut qd, torque, part / self.substeps as f64);
        }
        for i in 0..self.n {
            let error = (q[i] - self.last[i]).abs();
            found.end[i] = error;
            let bound = self.promised.end_error[i];
            if error.is_nan() || error > bound + OWN {
                found.broken.get_or_insert_with(|| {
                    format!("|q_e| of joint {} is {error} at the end, more than {bound}", i + 1)
                });
            }
        }
    }
}
