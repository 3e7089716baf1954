//! Arms some of whose joints follow others, against an outside oracle: D, C, G and τ of the coordinates.

mod chains;

use gramforge::internals::torque::{expanded, plain, recursive};
use gramforge::internals::{dynamics, reduction};
use gramforge_runtime::Model;
use gramforge_tests::chain::{Chain, Link};
use gramforge_tests::random::Random;
use serde_json::{Value, json};

use chains::{chain, checked, errors, generation, link, terms};

#[test]
fn twenty_random_chains_have_the_oracles_dynamics() {
    println!("largest error over 10 states, as a part of the largest value");
    for seed in 0..20 {
        let chain = chain(seed);
        let n = chain.dof();
        let made = generation(&chain, &json!({}))
            .unwrap_or_else(|error| panic!("{seed}: {error}\n{}", chain.urdf()));
        assert_eq!(made.arm().dof(), n);
        let exact = reduction::exact(made.lagrangian());
        let graphs = [
            ("emitted", made.code().clone()),
            ("recursive", recursive(made.arm())),
            ("plain", plain(made.arm())),
            ("expanded", expanded(made.arm(), made.lagrangian(), &exact)),
        ];
        let mut all: Vec<(&str, [f64; 4])> = Vec::new();
        all.push((
            "dynamics",
            errors(&chain, seed, |q, qd, qdd| {
                [
                    dynamics::mass_matrix(made.arm(), q).concat(),
                    dynamics::coriolis(made.arm(), q, qd).concat(),
                    dynamics::gravity(made.arm(), q),
                    dynamics::inverse_dynamics(made.arm(), q, qd, qdd),
                ]
            }),
        ));
        for (name, graph) in &graphs {
            let torque = |q: &[f64], qd: &[f64], v: &[f64], a: &[f64]| graph.interpret(q, qd, v, a);
            all.push((name, errors(&chain, seed, |q, qd, qdd| terms(torque, n, [q, qd, qdd]))));
        }
        for (name, errors) in all {
            let shown = errors.map(|error| format!("{error:8.1e}")).join(" ");
            println!("{seed:2} {name:9} {shown}");
            assert!(
                errors.iter().all(|error| *error <= 1e-12),
                "{seed}, {name}: {errors:?}\n{}",
                chain.urdf()
            );
        }
    }
}

#[test]
fn energy_is_that_of_the_coordinates() {
    for seed in 0..20 {
        let chain = chain(seed);
        let arm = checked(&chain).built.arm;
        let mut random = Random::new(seed);
        let (q, qd) = (random.vector(chain.dof(), 1.0), random.vector(chain.dof(), 2.0));
        // ∂V/∂q is G, by a central difference.
        let step = 1e-5;
        for (j, g) in chain.gravity_torque(&q).iter().enumerate() {
            let at = |by: f64| {
                let mut q = q.clone();
                q[j] += by;
                dynamics::energy(&arm, &q, &qd).1
            };
            let slope = (at(step) - at(-step)) / (2.0 * step);
            assert!((slope - g).abs() < 1e-6 * (1.0 + g.abs()), "{seed}, joint {j}: {slope} and {g}");
        }
        let d = chain.mass_matrix(&q);
        let kinetic: f64 = (0..qd.len())
            .flat_map(|i| (0..qd.len()).map(move |j| (i, j)))
            .map(|(i, j)| 0.5 * qd[i] * d[i][j] * qd[j])
            .sum();
        let own = dynamics::energy(&arm, &q, &qd).0;
        assert!((own - kinetic).abs() <= 1e-12 * kinetic, "{seed}: {own} and {kinetic}");
    }
}

/// A chain of three joints, the last of which follows the first.
fn short(seed: u64, multiplier: f64, sliding: bool) -> Chain {
    let mut random = Random::new(seed);
    let mut links: Vec<Link> = [(0, 1.0, 0.0), (1, 1.0, 0.0), (0, multiplier, 0.2)]
        .into_iter()
        .map(|follows| link(&mut random, sliding && follows.0 == 0, follows))
        .collect();
    links[1].armature = 0.0;
    Chain { links, gravity: [0.3, -0.2, -9.81] }
}

/// Reduced models of arms with followers: no error beyond the bound anywhere in the domain.
#[test]
fn bounds_hold_where_joints_follow_others() {
    let mut simplified = 0;
    let tube = |width: f64| json!({ "tube": { "position_error": width } });
    let shared = json!({ "shared": { "functions": 3 } });
    let separate = json!({ "separate": { "functions": 3 } });
    let tolerance = json!({ "tolerance": { "torque": 0.05 } });
    for (seed, multiplier, sliding, measure, model) in [
        (0, -0.5, false, tube(0.1), &shared),
        (1, 0.25, false, json!("workspace"), &shared),
        (2, -1.0, false, tube(0.3), &tolerance),
        (3, 1.5, false, json!("workspace"), &separate),
        (4, -2.0, true, tube(0.2), &shared),
        (5, 0.5, true, json!("workspace"), &shared),
    ] {
        let chain = short(seed, multiplier, sliding);
        let n = chain.dof();
        let limits: Value = (1..=3)
            .map(|i| (format!("j{i}"), json!({ "limits": { "acceleration": 8.0 } })))
            .collect::<serde_json::Map<_, _>>()
            .into();
        let arm = json!({ "urdf": "arm.urdf", "gravity": chain.gravity, "joints": limits });
        let made = generation(&chain, &json!({ "model": model, "measure": measure, "arm": arm }))
            .unwrap_or_else(|error| panic!("{seed}: {error}"));
        simplified += made.reduced().simplified.iter().filter(|s| **s).count();
        let mut random = Random::new(seed + 100);
        let sides = made.arm().joint_box();
        for _ in 0..3000 {
            let q: Vec<f64> = match (measure["tube"]["position_error"].as_f64(), made.motion()) {
                (Some(width), Some(motion)) => {
                    let at = motion.at(motion.duration() * 0.5 * (1.0 + random.signed())).q;
                    at.iter().map(|q| q + width * random.signed()).collect()
                }
                _ => sides
                    .iter()
                    .map(|[low, high]| low + (high - low) * 0.5 * (1.0 + random.signed()))
                    .collect(),
            };
            let ours = made.lagrangian().at_with(&made.reduced().combinations, &q);
            let (d, g) = (chain.mass_matrix(&q), chain.gravity_torque(&q));
            for i in 0..n {
                let slack = |x: f64| 1e-12 * (1.0 + x.abs());
                let error = (ours.gravity[i] - g[i]).abs();
                assert!(error <= made.bounds().g[i] + slack(g[i]), "{seed} g{i} at {q:?}");
                for j in 0..n {
                    let error = (ours.mass_matrix[i][j] - d[i][j]).abs();
                    assert!(error <= made.bounds().d[i][j] + slack(d[i][j]), "{seed} d{i}{j} at {q:?}");
                }
            }
        }
    }
    assert!(simplified > 10, "{simplified} coefficients were simplified");
}

/// The module that the build script has made of `data/follower.json`.
#[deny(warnings)]
#[allow(dead_code, reason = "a test does not use the whole module")]
#[rustfmt::skip]
mod follower {
    include!(concat!(env!("OUT_DIR"), "/follower.rs"));
}

#[test]
fn the_compiled_module_has_the_oracles_dynamics() {
    let at = |prismatic, xyz, axis, mass, com, inertia, follows| Link {
        prismatic,
        xyz,
        rpy: [0.2, 0.0, 0.0],
        axis,
        mass,
        com,
        com_rpy: [0.0; 3],
        inertia,
        armature: 0.0,
        follows,
    };
    let y = [0.0, 1.0, 0.0];
    let chain = Chain {
        links: vec![
            at(
                false,
                [0.3, 0.0, 0.0],
                y,
                1.0,
                [0.1, 0.02, 0.03],
                [0.1, 0.1, 0.1, 0.0, 0.0, 0.0],
                (0, 1.0, 0.0),
            ),
            at(
                false,
                [0.3, 0.0, 0.0],
                y,
                0.7,
                [0.1, 0.02, 0.03],
                [0.05, 0.06, 0.04, 0.0, 0.0, 0.0],
                (1, 1.0, 0.0),
            ),
            at(
                false,
                [0.3, 0.0, 0.0],
                y,
                0.4,
                [0.1, 0.02, 0.03],
                [0.01, 0.02, 0.01, 0.0, 0.0, 0.0],
                (1, -0.5, 0.1),
            ),
        ],
        gravity: [0.0, 0.0, -9.81],
    };
    let path = gramforge_tests::spec("follower").with_file_name("follower.urdf");
    assert_eq!(std::fs::read_to_string(path).expect("a file"), chain.urdf(), "the file is the oracle's");
    let array = |x: &[f64]| -> [f64; 2] { x.try_into().expect("two") };
    let torque = |q: &[f64], qd: &[f64], v: &[f64], a: &[f64]| {
        follower::Follower.passivity_torque(&array(q), &array(qd), &array(v), &array(a)).to_vec()
    };
    let errors = errors(&chain, 7, |q, qd, qdd| terms(torque, 2, [q, qd, qdd]));
    assert!(errors.iter().all(|error| *error <= 1e-13), "{errors:?}");
}

#[test]
fn what_cannot_follow_is_refused() {
    let mut third = chain(0);
    third.links.last_mut().expect("a link").follows.1 = 0.333;
    let message = generation(&third, &json!({})).expect_err("a third");
    assert!(message.contains("has the multiplier 0.333; write a whole number of quarters"), "{message}");
    let mut fast = chain(0);
    fast.links.last_mut().expect("a link").follows.1 = 1000.0;
    let message = generation(&fast, &json!({})).expect_err("too fast");
    assert!(message.contains("write smaller multipliers"), "{message}");
    let uncertain = json!({ "control": { "law": "report", "period": 0.001, "W": 10.0, "Pqq": 4.0, "Omega": 16.0,
        "uncertainty": { "payload": { "mass": [0.0, 1.0] } } } });
    let message = generation(&chain(0), &uncertain).expect_err("uncertain");
    assert!(message.contains("an arm whose joints follow others"), "{message}");
}
