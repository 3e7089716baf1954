//! A few of the worst runs of some cases, and of laws and initial errors that the named cases have not.

use gramforge_tests::plant::MOST;
use serde_json::json;

use super::arms::{Case, FAST, PLAIN};
use super::attack::{at_rest, attacked, attacks};
use super::attacked::{no_run_leaves, nor_stays_below, printed};
use super::looped::Loop;

#[test]
fn three_links() {
    no_run_leaves(&PLAIN, |_| (), &at_rest(0.01), 24);
}

#[test]
fn six_joints_fast() {
    let case = Case { name: "ur5 fast", arm: "ur5", ..FAST };
    no_run_leaves(&case, |_| (), &at_rest(case.initial), 12);
}

#[test]
fn six_joints_without_rotors() {
    let case = Case { name: "puma560 bare", arm: "puma560", armature: false, ..PLAIN };
    no_run_leaves(&case, |_| (), &at_rest(case.initial), 12);
}

#[test]
fn a_reduced_model() {
    let case = Case { name: "threedof report", law: "report", tolerance: 0.01, ..PLAIN };
    no_run_leaves(&case, |_| (), &at_rest(case.initial), 24);
}

#[test]
fn an_uncertain_payload() {
    let case = Case { name: "threedof payload", payload: 0.2, ..PLAIN };
    no_run_leaves(&case, |_| (), &at_rest(case.initial), 24);
}

/// Without an initial error the bound is what the loop does to first order in the period and to second in the load.
#[test]
fn no_initial_error() {
    let start = Case { initial: 0.0, ..PLAIN };
    let loaded = Case { name: "threedof payload from no error", payload: 0.2, ..start };
    nor_stays_below(&loaded, |_| (), &at_rest(0.0), 24, [1.05; 2]);
    let bare = Case { name: "puma560 bare from no error", arm: "puma560", armature: false, ..start };
    nor_stays_below(&bare, |_| (), &at_rest(0.0), 12, [1.05; 2]);
}

/// What holds for ever holds for long, while the model is wrong on the worst side or a load stays.
#[test]
fn ten_seconds_at_rest() {
    let report = Case { name: "threedof report at rest", law: "report", tolerance: 0.01, ..PLAIN };
    let loaded = Case { name: "threedof payload at rest", payload: 0.2, ..PLAIN };
    for case in [report, loaded] {
        let generation = case.made(|_| ()).unwrap();
        assert_eq!(generation.statement().unwrap().sampled.as_ref().unwrap().valid_until, None);
        let own = Loop::until(&generation, &case.chain(), &case.family(), 10.0);
        let found = attacked(&own, &attacks(&own, &at_rest(case.initial), 24));
        printed(&case, &own, &found);
        assert_eq!(found.broken, None, "{}", case.name);
    }
}

#[test]
fn both_robust_gains() {
    let case = Case { name: "threedof tight", law: "tight", tolerance: 0.01, ..PLAIN };
    for gain in ["state", "constant"] {
        let edit = |spec: &mut serde_json::Value| spec["control"]["robust_gain"] = json!(gain);
        no_run_leaves(&case, edit, &at_rest(case.initial), 16);
    }
}

#[test]
fn an_error_of_speed() {
    let most = [at_rest(0.01)[0], at_rest(0.05)[0]];
    no_run_leaves(&PLAIN, |spec| spec["control"]["initial_error"]["velocity"] = json!(0.05), &most, 24);
}

#[test]
fn numbers_of_32_bits() {
    no_run_leaves(&PLAIN, |spec| spec["emit"] = json!({ "scalar": "f32" }), &at_rest(0.01), 24);
}

#[test]
fn friction() {
    let (viscous, coulomb) = (0.5, 0.4);
    let case = Case { name: "threedof friction", tube: 0.1, ..PLAIN };
    let generation = case
        .made(|spec| {
            for i in 1..=3 {
                let joint = &mut spec["arm"]["joints"][format!("j{i}")];
                joint["viscous_friction"] = json!(viscous);
                joint["coulomb_friction"] = json!(coulomb);
            }
        })
        .unwrap();
    let mut own = Loop::new(&generation, &case.chain(), &case.family());
    for plant in &mut own.family {
        plant.viscous = [viscous; MOST];
        plant.coulomb = [coulomb; MOST];
    }
    let found = attacked(&own, &attacks(&own, &at_rest(case.initial), 24));
    printed(&case, &own, &found);
    assert_eq!(found.broken, None);
}

/// Where nothing but the period drives the errors, what viscous friction does within it is seen.
#[test]
fn viscous_friction_from_no_error() {
    let (most, viscous) = (1.05, 20.0);
    let case = Case { name: "threedof viscous from no error", initial: 0.0, ..FAST };
    let generation = case
        .made(|spec| {
            for i in 1..=3 {
                spec["arm"]["joints"][format!("j{i}")]["viscous_friction"] = json!(viscous);
            }
        })
        .unwrap();
    let mut own = Loop::new(&generation, &case.chain(), &case.family());
    own.family.iter_mut().for_each(|plant| plant.viscous = [viscous; MOST]);
    let found = attacked(&own, &attacks(&own, &at_rest(case.initial), 12));
    let [reach, ..] = printed(&case, &own, &found);
    assert_eq!(found.broken, None);
    assert!(reach < most, "{reach}");
}

#[test]
fn the_sign_function() {
    let case = Case { name: "threedof sign", law: "tight", tolerance: 0.01, ..PLAIN };
    let edit = |spec: &mut serde_json::Value| {
        spec["control"].as_object_mut().unwrap().remove("boundary_layer");
    };
    no_run_leaves(&case, edit, &at_rest(case.initial), 24);
}
