//! The inequalities behind the guarantees, along simulated runs of arms drawn from the families that they are given for.
//!
//! Two hundred arms, and a PUMA 560 with a payload:
//! `cargo test --release -p gramforge-tests --test physics -- lyapunov:: --include-ignored --nocapture`

mod closed;

use closed::{Loop, dot, member, report};
use gramforge::Generation;
use gramforge::internals::control::Design;
use gramforge::internals::domain::Domain;
use gramforge::internals::simulate::GraphModel;
use gramforge_generated::arm3_adaptive_guaranteed as adaptive;
use gramforge_generated::puma560_xi6;
use gramforge_runtime::law::{Sample, Tracking};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::{AdaptiveModel, Controller, OnFault, ReportLaw, Settings, Switching, TightLaw};
use gramforge_tests::random::Random;
use gramforge_tests::{edited, generation};
use serde_json::json;

/// Whether a state is one for which the bounds are given.
fn inside<const N: usize>(generation: &Generation, sample: &Sample<f64, N>) -> bool {
    let Domain::Tube(_, tube) = generation.domain() else { return false };
    let speed = &generation.design().unwrap().envelope.speed;
    (0..N).all(|i| (sample.q[i] - sample.desired.q[i]).abs() <= tube[i] && sample.qd[i].abs() <= speed[i])
}

/// The error stays within the published envelope and, at the `end`, within the final error.
fn within<const N: usize>(design: &Design, error: &[f64; N], end: bool) {
    let published = if end { &design.guarantee.final_error } else { &design.envelope.position_error };
    assert!(error.iter().zip(published).all(|(e, p)| *e <= *p), "{error:?} beyond {published:?}");
}

/// What one judged instant may do: V̇ ≤ allowed. Counts instants, and the largest V̇ less what is allowed.
struct Tally {
    instants: usize,
    closest: f64,
}

impl Tally {
    fn add(&mut self, rate: f64, allowed: f64, scale: f64) {
        assert!(rate <= allowed + 1e-9 * scale.max(1.0), "V̇ = {rate}, allowed {allowed}");
        self.instants += 1;
        self.closest = self.closest.max(rate - allowed);
    }
}

/// Laws (34) and tight on `plants` arms of the family of `generation`.
fn robust<const N: usize>(
    generation: &Generation,
    reference: &impl Reference<f64, N>,
    start: f64,
    plants: usize,
    seconds: f64,
) {
    let (arm, code, bounds, design) =
        (generation.arm(), generation.code(), generation.bounds(), generation.design());
    let design = design.unwrap();
    let law: ReportLaw<f64, N> = report(design);
    let ReportLaw { gains, disturbance, switching, coulomb, .. } = law;
    let tight = TightLaw { gains, disturbance, switching, coulomb };
    let Switching::BoundaryLayer(phi) = switching else { panic!("a layer") };
    let model = GraphModel::<N>::new(code, bounds, arm).unwrap();
    let settings = Settings { period: design.period, torque_limit: [None; N], on_fault: OnFault::Hold };
    let mut random = Random::new(17);
    for name in ["report", "tight"] {
        let mut tally = Tally { instants: 0, closest: f64::MIN };
        for index in 0..plants {
            let (_, plant) = member(generation, index, &mut random);
            let closed = Loop::new(&plant, gains);
            let judge = |sample: &Sample<f64, N>, torque: &[f64; N], _: &()| {
                if inside(generation, sample) {
                    let rho = if name == "report" {
                        law.robust_gain(&model, sample)
                    } else {
                        tight.robust_gain(&model, sample)
                    };
                    let rate = closed.rate(sample, torque);
                    tally.add(
                        rate,
                        0.25 * dot(&rho, &phi) - closed.dissipation(sample),
                        dot(torque, torque).sqrt(),
                    );
                }
                if design.guarantee.holds {
                    within(
                        design,
                        &std::array::from_fn::<_, N, _>(|i| (sample.q[i] - sample.desired.q[i]).abs()),
                        false,
                    );
                }
            };
            let end = match name {
                "report" => closed.run(
                    Controller::new(model, law, settings).unwrap(),
                    reference,
                    start,
                    seconds,
                    judge,
                ),
                _ => closed.run(
                    Controller::new(model, tight, settings).unwrap(),
                    reference,
                    start,
                    seconds,
                    judge,
                ),
            };
            if design.guarantee.holds {
                within(design, &end, true);
            }
        }
        println!(
            "{}, {name}: {} instants of {plants} arms, V̇ below what is allowed by {:.2e} W at least",
            arm.joints.len(),
            tally.instants,
            -tally.closest
        );
        assert!(tally.instants > plants * 100);
    }
}

fn arm3(law: &str) -> Generation {
    let generation = edited("arm3_adaptive_guaranteed", |v| {
        v["control"]["law"] = json!(law);
        v["control"]["robust_gain"] = json!("state");
    });
    generation.unwrap_or_else(|message| panic!("{message}"))
}

/// Law (46) by its generated module.
fn learning(plants: usize, seconds: f64) {
    let generation = generation("arm3_adaptive_guaranteed");
    let design = generation.design().unwrap();
    assert!(design.guarantee.holds);
    let law = adaptive::LAW;
    let Switching::BoundaryLayer(phi) = law.robust.switching else { panic!("a layer") };
    let model = adaptive::Arm3AdaptiveGuaranteed;
    let mut random = Random::new(23);
    let mut tally = Tally { instants: 0, closest: f64::MIN };
    for index in 0..plants {
        let (u, plant) = member(&generation, index, &mut random);
        let closed = Loop::new(&plant, law.robust.gains);
        let judge = |sample: &Sample<f64, 3>, torque: &[f64; 3], theta: &[f64; 1]| {
            let Tracking { s, v_r, a_r, .. } = Tracking::new(&closed.gains.p12, sample);
            let [column] = model.regression(&sample.q, &sample.qd, &v_r, &a_r).columns;
            let error = theta[0] - u[0];
            let lesson: [f64; 3] = std::array::from_fn(|i| if s[i].abs() > phi[i] { s[i] } else { 0.0 });
            // V̇1: θ_eᵀ Pθθ θ̂̇ = −θ_e Yᵀ s outside the layer; projection only lowers it.
            let rate = closed.rate(sample, torque) - error * dot(&column, &lesson);
            let rho = law.robust.robust_gain(&model, sample);
            let cost = |i: usize| {
                let y = (column[i] * error).abs();
                if y > rho[i] { phi[i] * y } else { 0.25 * phi[i] * (rho[i] + y).powi(2) / rho[i] }
            };
            let allowed = (0..3).map(cost).sum::<f64>() - closed.dissipation(sample);
            assert!(inside(&generation, sample));
            tally.add(rate, allowed, dot(torque, torque).sqrt());
            within(
                design,
                &std::array::from_fn::<_, 3, _>(|i| (sample.q[i] - sample.desired.q[i]).abs()),
                false,
            );
        };
        let end = closed.run(adaptive::controller(), &adaptive::REFERENCE, 0.02, seconds, judge);
        within(design, &end, true);
    }
    println!(
        "adaptive: {} instants of {plants} arms, V̇1 below what is allowed by {:.2e} W at least",
        tally.instants, -tally.closest
    );
}

#[test]
fn v_falls_as_the_proofs_say_on_arms_of_the_family() {
    for law in ["report", "tight"] {
        assert!(arm3(law).design().unwrap().guarantee.holds, "{law}");
    }
    robust(&arm3("report"), &adaptive::REFERENCE, 0.02, 4, 1.0);
    learning(4, 1.0);
}

#[test]
fn the_rate_of_v_is_its_derivative() {
    let generation = generation("arm3_adaptive_guaranteed");
    let plant = generation.uncertainty().at(generation.arm(), &[0.1]);
    let closed = Loop::new(&plant, adaptive::LAW.robust.gains);
    let mut random = Random::new(4);
    for k in 0..20 {
        let t = 0.2 + 0.2 * f64::from(k);
        let desired = adaptive::REFERENCE.at(t);
        let [e, ed] = [random.array::<3>(0.3), random.array::<3>(1.0)];
        let sample = Sample {
            q: std::array::from_fn(|i| desired.q[i] + e[i]),
            qd: std::array::from_fn(|i| desired.qd[i] + ed[i]),
            desired,
            period: 1e-3,
        };
        let torque = random.array(40.0);
        let (rate, seen) =
            (closed.rate(&sample, &torque), closed.differences(&sample, &torque, &adaptive::REFERENCE, t));
        assert!((rate - seen).abs() < 1e-6 * (1.0 + rate.abs()), "{rate} {seen}");
    }
}

#[test]
#[ignore = "minutes in release mode"]
fn v_falls_on_two_hundred_arms() {
    robust(&arm3("report"), &adaptive::REFERENCE, 0.02, 200, 1.5);
    learning(200, 1.5);
}

#[test]
#[ignore = "a minute in release mode"]
fn v_falls_on_pumas_with_payloads() {
    let puma = edited("puma560_xi6", |v| {
        v["arm"]["payload"] = json!({ "mass": 1.0, "com": [0.0, 0.0, 0.1] });
        v["control"]["uncertainty"] = json!({ "payload": { "mass": [0.5, 1.5] }, "viscous_friction": [[5.0, 6.5], null, null, null, null, null] });
        v["control"]["allow_long_period"] = json!(true);
        v["control"]["robust_gain"] = json!("state");
    });
    robust(&puma.unwrap_or_else(|message| panic!("{message}")), &puma560_xi6::REFERENCE, 0.02, 200, 0.5);
}
