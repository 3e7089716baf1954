//! No number in a guarantee is a maximum over samples: motions and errors that samples miss.

use std::path::Path;

use gramforge::Generation;
use gramforge::internals::simulate::{Run, Scenario, simulate};
use gramforge::load::parse;
use serde_json::{Value, json};

const ARM3: &str = include_str!("../../../generated/specs/arm3_xi2.json");
const PUMA: &str = include_str!("../../../generated/specs/puma560_xi12.json");

fn generate(text: &str, edit: impl Fn(&mut Value)) -> Result<Generation, String> {
    let mut value: Value = serde_json::from_str(text).unwrap();
    edit(&mut value);
    let loaded = parse(&value.to_string(), Path::new("arm.json")).map_err(|e| e.to_string())?;
    Generation::new(loaded).map_err(|e| e.to_string())
}

fn run(generation: &Generation) -> Run {
    simulate(&Scenario::of(generation).unwrap()).unwrap().law
}

/// An exact law on the three-link arm with drives, and all joints at `hertz` for `duration` s.
fn rhythm(v: &mut Value, hertz: f64, duration: f64) {
    for (link, armature) in v["arm"]["dh"]["links"].as_array_mut().unwrap().iter_mut().zip([0.8, 0.8, 0.3]) {
        link["armature"] = json!(armature);
    }
    let term = json!([{ "amplitude": 0.01, "frequency": 2.0 * std::f64::consts::PI * hertz, "phase": 0.0 }]);
    v["motion"] = json!({ "sinusoids": {
        "offset": [0.0, 0.3, -1.2], "terms": [term, term, term], "duration": duration
    } });
    v["measure"] = json!({ "tube": { "position_error": 0.1 } });
    v["model"] = json!("exact");
    v["control"] = json!({
        "law": "exact", "period": 0.001, "W": 10.0, "Pqq": 10.0, "Omega": 40.0,
        "initial_error": { "position": 0.002 }
    });
    v["simulation"] = json!({ "duration": 6.0, "substeps": 2 });
}

/// At 2 Hz, 200 s hold a whole number of periods in each of 400, 500, 1000 or 2000 equal steps.
#[test]
fn a_rhythm_that_samples_miss_still_lags() {
    // At 5 Hz the lag may take the errors out of the tube, as far as the level of V can say.
    for (hertz, duration, holds) in [(2.0, 200.0, true), (2.0, 5.0, true), (5.0, 200.0, false)] {
        let generation = generate(ARM3, |v| rhythm(v, hertz, duration)).unwrap();
        let guarantee = &generation.design().unwrap().guarantee;
        let run = run(&generation);
        let late = run.trace.time.len() / 2;
        let error =
            |i: usize| run.trace.position_error[late..].iter().fold(0.0_f64, |m, e| m.max(e[i].abs()));
        let seen: Vec<f64> = (0..3).map(error).collect();
        println!(
            "{hertz} Hz, {duration} s: {seen:.6?} seen, {:.6?} published, guaranteed: {}",
            guarantee.final_error, guarantee.holds
        );
        assert!(seen.iter().any(|e| *e > 5e-5), "the held torque lags: {seen:?}");
        assert!(seen.iter().zip(&guarantee.final_error).all(|(e, p)| e <= p));
        assert_eq!(guarantee.holds, holds, "{:?}", guarantee.reasons);
        assert!(
            holds || guarantee.reasons.iter().all(|r| r.contains("the tube holds")),
            "{:?}",
            guarantee.reasons
        );
    }
}

/// The same motion repeated says the same about its lag.
#[test]
fn a_longer_rhythm_lags_no_less() {
    let last = |duration: f64| {
        let generation = generate(ARM3, |v| rhythm(v, 2.0, duration)).unwrap();
        generation.design().unwrap().guarantee.final_error.clone()
    };
    let (short, long) = (last(1.0), last(200.0));
    println!("{short:.6?} {long:.6?}");
    assert!(short.iter().zip(&long).all(|(s, l)| *l >= 0.97 * s && *l <= 1.25 * s));
}

/// Given gains, and joint 1 with a torque limit.
fn limited(limit: f64, error: f64) -> Generation {
    generate(ARM3, |v| {
        v["model"] = json!("exact");
        v["control"] = json!({
            "law": "exact", "period": 0.001, "W": 40.0, "Pqq": 10.0, "Omega": 40.0,
            "initial_error": { "position": error }
        });
        v["arm"]["dh"]["links"][0]["limits"] = json!({ "torque": limit });
        v["simulation"] = json!({ "duration": 0.1, "substeps": 2 });
    })
    .unwrap()
}

#[test]
fn a_torque_limit_that_the_first_step_goes_beyond_voids_the_guarantee() {
    // The motion takes next to nothing of the upright joint 1, the start asks K P12 e − Pqq e = 42.5 · 4 · 0.03 − 0.3.
    let weak = limited(4.0, 0.03);
    let guarantee = &weak.design().unwrap().guarantee;
    assert!(!guarantee.holds);
    let reason = "the initial errors may ask ";
    assert!(
        guarantee.reasons.iter().any(|r| r.starts_with(reason) && r.ends_with("limit is 4 N·m")),
        "{:?}",
        guarantee.reasons
    );
    assert!(run(&weak).metrics.saturated_steps > 0);
    let strong = limited(8.0, 0.03);
    let guarantee = &strong.design().unwrap().guarantee;
    assert!(guarantee.holds, "{:?}", guarantee.reasons);
    assert_eq!(run(&strong).metrics.saturated_steps, 0);
    // With less error the weak drive will do.
    assert!(limited(4.0, 0.01).design().unwrap().guarantee.holds);
}

#[test]
fn gains_on_request_spare_the_drives_or_say_why_not() {
    let ask = |limit: f64| {
        generate(ARM3, |v| {
            v["model"] = json!("exact");
            v["measure"] = json!({ "tube": { "position_error": 0.1 } });
            v["control"] = json!({
                "law": "exact", "design": { "convergence_time": 0.6 }, "initial_error": { "position": 0.03 }
            });
            v["arm"]["dh"]["links"][0]["limits"] = json!({ "torque": limit });
            v["simulation"] = json!({ "duration": 0.3, "substeps": 2 });
        })
    };
    let free = ask(1000.0).unwrap();
    let torque = run(&free).metrics.peak_torque[0];
    println!("joint 1 takes {torque:.2} N·m where it may");
    let message = ask(0.05 * torque).unwrap_err();
    println!("{message}");
    assert!(
        gramforge_tests::unplaced(&message)
            .starts_with("arm.json: control.design: cannot be met: with the best gains found,")
    );
    assert!(message.contains("may ask for") && message.contains("more than its limit"), "{message}");
}

#[test]
fn the_rates_of_the_torque_error_are_stated_and_those_that_the_law_meets() {
    let generation = generate(PUMA, |_| {}).unwrap();
    let (torque, met) = (generation.torque().unwrap(), generation.met().unwrap());
    let design = generation.design().unwrap();
    let motion = generation.motion().unwrap();
    for k in 0..=1000 {
        let target = motion.at(motion.duration() * f64::from(k) / 1000.0);
        for i in 0..6 {
            assert!(target.qd[i].abs() <= torque.rates.speed[i]);
            assert!(target.qdd[i].abs() <= torque.rates.reference_acceleration[i]);
        }
    }
    // q̇ = q̇_d + q̇_e, v_r = q̇_d − P12 q_e, a_r = q̈_d − P12 q̇_e.
    let p12 = &design.gains.p12;
    let envelope = &design.envelope;
    for i in 0..6 {
        let pulled = |x: &[f64]| -> f64 { p12[i].iter().zip(x).map(|(p, x)| p.abs() * x).sum() };
        let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b, "{a} {b}");
        near(met.rates.speed[i], torque.rates.speed[i] + envelope.velocity_error[i]);
        near(met.rates.reference_speed[i], torque.rates.speed[i] + pulled(&envelope.position_error));
        let most = torque.rates.reference_acceleration[i] + pulled(&envelope.velocity_error);
        near(met.rates.reference_acceleration[i], most);
    }
    let growth: Vec<f64> = torque
        .error
        .iter()
        .zip(&met.error)
        .filter(|(own, _)| **own > 0.0)
        .map(|(own, met)| met / own)
        .collect();
    println!("{growth:.2?} times the error at the motion's own rates");
    assert!(growth.iter().all(|g| *g >= 1.0) && growth.iter().any(|g| *g > 3.0));
    let text = generation.module().unwrap();
    assert!(text.contains("It holds for speeds up to (") && text.contains("Torque error that the law meets"));
    let alone = generate(PUMA, |v| drop(v.as_object_mut().unwrap().remove("control"))).unwrap();
    assert!(alone.met().is_none() && alone.module().unwrap().contains("not available without a controller"));
}

/// A switching gain is made of the bounds, so these are as sharp as those of a shared model.
#[test]
fn the_bounds_of_a_switching_law_are_sharp_whatever_the_model() {
    const PUMA3: &str = include_str!("../../data/puma3_tolerance.json");
    let generation = generate(PUMA3, |v| {
        v["control"] = json!({
            "law": "tight", "period": 0.001, "W": 40.0, "Pqq": 4.0, "Omega": 40.0, "boundary_layer": 0.05,
            "initial_error": { "position": 0.01 }, "allow_long_period": true
        });
    })
    .unwrap();
    assert!(!generation.reduced().is_exact());
    let ratio = gramforge::internals::bounds::worst_ratio(generation.lagrangian(), generation.certificates());
    println!("bound over largest value found: {ratio:.4}");
    assert!((1.0..=1.0101).contains(&ratio));
}
