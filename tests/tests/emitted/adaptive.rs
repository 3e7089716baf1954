//! The adaptive law: its generated modules, what it learns, and the report's two claims about robust and adaptive control.

use gramforge::Generation;
use gramforge::internals::arm::Arm;
use gramforge::internals::simulate::{ArmModel, Run, Scenario, simulate_on};
use gramforge_generated::{arm3_adaptive, arm3_adaptive_guaranteed, arm3_robust};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::simulate::{JointState, RigidPlant, Simulation};
use gramforge_runtime::{AdaptiveLaw, AdaptiveModel, TorqueController};
use gramforge_tests::random::Random;
use gramforge_tests::{difference, edited, generation, largest};
use serde_json::json;

fn run_on(generation: &Generation, plant: &Arm) -> Run {
    let scenario = Scenario::of(generation);
    scenario.and_then(|scenario| simulate_on(&scenario, plant)).unwrap_or_else(|error| panic!("{error}")).law
}

/// The arm with `more` kg at the end of link 3.
fn loaded(generation: &Generation, more: f64) -> Arm {
    generation.uncertainty().at(generation.arm(), &[more])
}

fn same_regression<M: AdaptiveModel<3, 1, Scalar = f64>>(
    name: &str,
    model: M,
    law: &AdaptiveLaw<f64, 3, 1>,
    nominal: f64,
) {
    let made = generation(name);
    let regressor = made.regressor().unwrap();
    let mut random = Random::new(31);
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let (q, qd) = (random.array::<3>(3.2), random.array(5.0));
        let (v_r, a_r) = (random.array(5.0), random.array(20.0));
        let compiled = model.regression(&q, &qd, &v_r, &a_r);
        let interpreted = regressor.code.interpret(&q, &qd, &v_r, &a_r);
        let outputs: Vec<f64> = compiled.base.into_iter().chain(compiled.columns.concat()).collect();
        let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&outputs), bits(&interpreted), "{name} at {q:?}");
        let own = model.passivity_torque(&q, &qd, &v_r, &a_r);
        worst = worst.max(difference(&compiled.torque(&[nominal]), &own) / largest(&own));
    }
    println!("{name}: same bits as its graph at 1000 states; base + Yθ is its torque to {worst:.1e}");
    assert!(worst < 1e-12, "{worst:e}");
    let adaptation = made.design().unwrap().adaptation.as_ref().unwrap();
    assert_eq!(
        [law.low, law.high, law.initial, law.rate].concat(),
        [&adaptation.low[..], &adaptation.high, &adaptation.initial, &adaptation.rate].concat()
    );
    let operations = regressor.code.operations();
    let text = made.module().unwrap();
    let count = format!(
        "base + Yθ in {} multiplications, {} additions, {} sine-cosine pairs",
        operations.mul, operations.add, operations.trig_pairs
    );
    assert!(text.contains(&count), "{name} does not state {count}");
}

#[test]
fn generated_regressions_are_their_graphs_and_give_the_models_torque() {
    let [nominal] = arm3_adaptive::NOMINAL_PARAMETERS;
    same_regression("arm3_adaptive", arm3_adaptive::Arm3Adaptive, &arm3_adaptive::LAW, nominal);
    let [nominal] = arm3_adaptive_guaranteed::NOMINAL_PARAMETERS;
    let model = arm3_adaptive_guaranteed::Arm3AdaptiveGuaranteed;
    same_regression("arm3_adaptive_guaranteed", model, &arm3_adaptive_guaranteed::LAW, nominal);
    assert_eq!(arm3_adaptive::PARAMETER_NAMES, ["links[0].mass"]);
    const { assert!(arm3_adaptive_guaranteed::GUARANTEE.holds()) };
}

#[test]
fn modules_name_what_is_uncertain() {
    let text = |name: &str| generation(name).module().unwrap();
    let line = "- `links[0].mass`, joint 3: 2.8 to 4.2, 3.5 as specified";
    for (name, words) in
        [("arm3_adaptive", "has learnt them"), ("arm3_robust", "hold for all of their values")]
    {
        let text = text(name);
        assert!(text.contains(line) && text.contains(words), "{name}");
    }
    assert!(
        text("arm3_robust").contains(
            "are those of the arm as specified. Their bounds hold what the uncertain numbers change."
        )
    );
    assert!(text("arm3_adaptive").contains("are exact: their bounds are zero"));
    assert!(!text("arm3_xi2").contains("ncertain"));
    // The bounds of a model that does not follow the load hold for it, those of one that does are smaller.
    let (robust, adaptive) = (arm3_robust::BOUNDS, arm3_adaptive::BOUNDS);
    assert!(
        robust.g.iter().zip(adaptive.g).all(|(r, a)| *r >= a) && robust.g[1] > 1.5 * adaptive.g[1],
        "{:?} {:?}",
        robust.g,
        adaptive.g
    );
}

/// Torques and what is learnt, instant by instant, of a generated controller on `plant`.
fn through_module<const P: usize>(
    mut controller: impl TorqueController<3, Scalar = f64, Learnt = [f64; P]>,
    reference: &impl Reference<f64, 3>,
    start: f64,
    plant: &Arm,
    instants: usize,
) -> Vec<f64> {
    let at = reference.at(0.0);
    let state = JointState { q: at.q.map(|q| q + start), qd: at.qd };
    let plant = RigidPlant { model: ArmModel::<3>::new(plant).unwrap(), coulomb: [[0.0; 2]; 3] };
    let mut simulation = Simulation::new(plant, state, controller.period(), 10).unwrap();
    let mut out = Vec::new();
    for _ in 0..instants {
        out.extend(*controller.learnt());
        out.extend(simulation.step(&mut controller, reference).unwrap().command.unwrap().torque);
    }
    out
}

#[test]
fn a_run_through_the_module_is_the_simulated_one() {
    for name in ["arm3_adaptive", "arm3_adaptive_guaranteed"] {
        let short = |v: &mut serde_json::Value| v["simulation"] = json!({ "duration": 0.5 });
        let generation = edited(name, short).unwrap_or_else(|message| panic!("{message}"));
        let start = if name == "arm3_adaptive" { 0.2 } else { 0.02 };
        let heavy = loaded(&generation, 0.1);
        let trace = run_on(&generation, &heavy).trace;
        let simulated: Vec<f64> = trace
            .parameters
            .iter()
            .zip(&trace.torque)
            .flat_map(|(theta, torque)| theta.iter().chain(torque))
            .copied()
            .collect();
        let instants = trace.time.len();
        let own = if name == "arm3_adaptive" {
            through_module(arm3_adaptive::controller(), &arm3_adaptive::REFERENCE, start, &heavy, instants)
        } else {
            through_module(
                arm3_adaptive_guaranteed::controller(),
                &arm3_adaptive_guaranteed::REFERENCE,
                start,
                &heavy,
                instants,
            )
        };
        assert!(
            simulated.len() == own.len()
                && simulated.iter().zip(&own).all(|(a, b)| a.to_bits() == b.to_bits()),
            "{name}"
        );
        assert!(trace.parameters.last() != trace.parameters.first(), "{name} learnt nothing");
    }
}

/// The report's example, 20 % too heavy, under `law`.
fn report_example(law: &str, layer: Option<f64>, duration: f64) -> Run {
    let generation = edited("arm3_adaptive", |v| {
        v["control"]["law"] = json!(law);
        v["control"]["period"] = json!(0.002);
        v["control"]["allow_long_period"] = json!(true);
        v["simulation"] = json!({ "duration": duration, "substeps": 1 });
        let control = v["control"].as_object_mut().unwrap();
        if law == "report" {
            control.insert("robust_gain".to_string(), json!("state"));
        }
        match layer {
            Some(phi) => control.insert("boundary_layer".to_string(), json!(phi)),
            None => control.remove("boundary_layer"),
        };
    });
    let generation = generation.unwrap_or_else(|message| panic!("{message}"));
    run_on(&generation, &loaded(&generation, 0.7))
}

#[test]
fn robust_control_converges_faster_and_adaptive_control_switches_less() {
    let (robust, adaptive) = (report_example("report", None, 5.0), report_example("adaptive", None, 5.0));
    for (name, run) in [("robust", &robust), ("adaptive", &adaptive)] {
        let m = &run.metrics;
        println!(
            "{name}: within 0.01 rad from {:?} s, rms {:.5}, final {:.5?}, variation {:.0?} N·m",
            m.convergence_time, m.rms_error_total, m.final_error, m.torque_total_variation
        );
    }
    assert!(
        robust.metrics.convergence_time.unwrap() <= adaptive.metrics.convergence_time.unwrap_or(f64::MAX)
    );
    for i in 0..3 {
        let [r, a] = [&robust, &adaptive].map(|run| run.metrics.torque_total_variation[i]);
        assert!(a < r, "joint {}: {a} {r}", i + 1);
    }
}

/// Once every |s_i| is inside the layer nothing is learnt: θ̂ stands still to the bit, whatever the ripple.
#[test]
fn nothing_drifts_in_a_minute() {
    let run = report_example("adaptive", Some(0.1), 60.0);
    let trace = &run.trace;
    assert_eq!(run.metrics.diverged_at, None);
    let theta: Vec<f64> = trace.parameters.iter().map(|p| p[0]).collect();
    assert!(theta.iter().all(|t| (-0.7 - 1e-12..=0.7 + 1e-12).contains(t)));
    let half = theta.len() / 2;
    let at_30 = theta[half];
    let moved = theta[half..].iter().fold(0.0_f64, |most, t| most.max((t - at_30).abs()));
    let early = largest(trace.position_error[..500].concat().iter());
    let late = largest(trace.position_error[half..].concat().iter());
    println!(
        "θ̂ goes from {} to {at_30:.4} kg of 0.7 and then by {moved:e}; error from {early:.3} to {late:.5} rad",
        theta[0]
    );
    assert_eq!(moved, 0.0);
    assert!(at_30 > 0.0 && late < 0.05 && late < 0.3 * early);
}

/// Without a layer the error goes on teaching, and the load is found.
#[test]
fn the_load_is_learnt_where_the_motion_shows_it() {
    let run = report_example("adaptive", None, 10.0);
    let theta = run.trace.parameters.last().unwrap()[0];
    println!("learnt {theta:.4} kg of 0.7; final error {:.5?}", run.metrics.final_error);
    assert!(theta > 0.0);
    assert!(run.metrics.final_error.iter().all(|e| *e < 0.01));
}
