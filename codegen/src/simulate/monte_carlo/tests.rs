//! Runs on the three-link arm.

use std::path::Path;

use super::plan::Plan;
use super::*;
use crate::Generation;
use crate::load::{Loaded, parse};
use crate::progress::Silent;
use crate::simulate::simulate;
use crate::spec::{ControlSpec, InitialErrorSpec, LawSpec, ModelSpec, MotionSpec, Spec, VectorSpec};

/// The three-link arm with two functions and a boundary layer, along a motion of 1 s; `edit` changes the rest.
fn three_link(edit: impl FnOnce(&mut Spec)) -> Generation {
    let mut loaded: Loaded = parse(include_str!("../../../specs/arm3.json"), Path::new("arm3.json")).unwrap();
    let control = loaded.spec.control.as_mut().unwrap();
    control.boundary_layer = Some(VectorSpec::Scalar(0.1));
    control.allow_long_period = true;
    if let Some(MotionSpec::Quintic { duration, .. }) = &mut loaded.spec.motion {
        *duration = 1.0;
    }
    edit(&mut loaded.spec);
    Generation::new(loaded).unwrap()
}

fn control(spec: &mut Spec) -> &mut ControlSpec {
    spec.control.as_mut().unwrap()
}

/// The exact model and law, without any error but that which `edit` brings.
fn exact(edit: impl FnOnce(&mut Spec)) -> Generation {
    three_link(|spec| {
        spec.model = ModelSpec::Exact;
        control(spec).law = LawSpec::Exact;
        control(spec).initial_error = InitialErrorSpec::default();
        edit(spec);
    })
}

fn found(generation: &Generation, request: &MonteCarloRequest) -> MonteCarlo {
    monte_carlo(&Scenario::of(generation).unwrap(), request, &Silent).unwrap()
}

/// `runs` runs that settle in 1 s.
fn request(generation: &Generation, runs: usize) -> MonteCarloRequest<'_> {
    MonteCarloRequest::of(generation, runs, 1.0)
}

/// Pushes of this torque alone, N·m, on an exact model.
fn without_model_error(torque: f64) -> ModelErrorBound {
    ModelErrorBound { torque: vec![torque; 3], followed: Vec::new(), at_state: None, against: Against::Exact }
}

/// The same without pushes.
fn left_alone(generation: &Generation, runs: usize) -> MonteCarloRequest<'_> {
    let mut request = request(generation, runs);
    request.model_error = without_model_error(0.0);
    request
}

#[test]
fn a_run_without_error_and_push_is_the_simulation() {
    let generation = three_link(|spec| {
        control(spec).initial_error = InitialErrorSpec::default();
        spec.simulation.duration = Some(2.0);
        // Those of 0.5 ms that the runs take: with others both differ by the error of the integration.
        spec.simulation.substeps = Some(20);
    });
    let run = simulate(&Scenario::of(&generation).unwrap()).unwrap().law;
    let found = found(&generation, &left_alone(&generation, 1));
    let largest = |from: usize, until: usize, i: usize| {
        run.trace.position_error[from..=until].iter().fold(0.0_f64, |m, q_e| m.max(q_e[i].abs()))
    };
    for i in 0..3 {
        // The arm by composite bodies and by the recursion: rounding alone is between them.
        let pairs = [
            (found.reach[i], largest(0, 200, i)),
            (found.settled_error[i], largest(100, 200, i)),
            (found.end_error[i], largest(100, 100, i)),
        ];
        for (here, there) in pairs {
            assert!((here - there).abs() < 1e-12, "joint {i}: {here} {there}");
        }
        assert!(found.reach[i] > 1e-5, "the reduced model errs: {found:?}");
        let (here, there) = (found.torque_max[i], run.metrics.peak_torque[i]);
        assert!((here - there).abs() < 1e-9 * there, "joint {i}: {here} N·m, {there} N·m");
    }
}

#[test]
fn more_runs_lower_no_maximum_and_any_number_of_threads_gives_the_same() {
    let generation = three_link(|_| {});
    let few = found(&generation, &request(&generation, 20));
    let many = found(&generation, &request(&generation, 150));
    let lists = |all: &MonteCarlo| {
        let lists = [&all.reach, &all.settled_error, &all.end_error, &all.torque_max];
        lists.into_iter().chain(&all.picture.largest).flatten().copied().collect::<Vec<_>>()
    };
    assert!(lists(&few).iter().zip(lists(&many)).all(|(few, many)| *few <= many));
    assert!(lists(&few) != lists(&many), "150 runs find more than 20");
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    for threads in [1, 3] {
        assert_eq!(pool(threads).install(|| found(&generation, &request(&generation, 150))), many);
    }
}

#[test]
fn runs_are_parts_of_the_picture() {
    let generation = three_link(|_| {});
    let found = found(&generation, &request(&generation, 30));
    let picture = &found.picture;
    assert!(picture.time.is_sorted() && picture.time.len() == picture.largest.len());
    for i in 0..3 {
        let largest = picture.largest.iter().fold(0.0_f64, |most, part| most.max(part[i]));
        assert_eq!(largest, found.reach[i]);
        for run in &picture.runs[i] {
            assert_eq!(run.len(), picture.time.len());
            let inside = |(run, all): (&Vec<f64>, &Vec<f64>)| run[i].abs() <= all[i];
            assert!(run.iter().zip(&picture.largest).all(inside));
        }
        let [of_all, settled] = &picture.runs[i];
        assert!(of_all.iter().any(|part| part[i].abs() == found.reach[i]), "the run that reached furthest");
        assert!(settled.iter().any(|part| part[i].abs() == found.settled_error[i]));
    }
}

#[test]
fn a_push_makes_the_models_error_its_bound_and_no_more() {
    let generation = three_link(|_| {});
    let scenario = Scenario::of(&generation).unwrap();
    let request = request(&generation, 1);
    let runs = Runs::<f64, 3>::new(&scenario, &request).unwrap();
    assert!(runs.bound.iter().all(|bound| *bound > 0.1), "{:?}", runs.bound);
    let at_state = request.model_error.at_state.as_ref();
    let push = |bound, at_state, sides: &[i8; 3], time: f64, [q_e, qd_e]: [[f64; 3]; 2]| {
        let desired = runs.rig.reference.at(time);
        let q: [f64; 3] = std::array::from_fn(|i| desired.q[i] + q_e[i]);
        let qd: [f64; 3] = std::array::from_fn(|i| desired.qd[i] + qd_e[i]);
        let p12 = &runs.rig.gains.p12;
        let push = Push { bound, followed: &[], at_state, exact: Some(&runs.arm), code: &runs.emitted, p12 };
        let (torque, beyond) = push.torque(0, &q, &qd, &desired, sides);
        // P12 = 4 on the diagonal.
        let v_r: [f64; 3] = std::array::from_fn(|i| desired.qd[i] - 4.0 * q_e[i]);
        let a_r: [f64; 3] = std::array::from_fn(|i| desired.qdd[i] - 4.0 * qd_e[i]);
        let arm = generation.given();
        let at = crate::dynamics::positions(arm, &q);
        let exact = crate::dynamics::passivity_torque(arm, arm.gravity, &at, &qd, &v_r, &a_r);
        let emitted = generation.code().interpret(&q, &qd, &v_r, &a_r);
        let whole: [f64; 3] = std::array::from_fn(|i| emitted[i] - exact[i] + torque[i]);
        let [speed, reference_speed, reference_acceleration] =
            [qd, v_r, a_r].map(|x| x.iter().map(|x| x.abs()).collect());
        let rates = Rates { speed, reference_speed, reference_acceleration };
        (torque, beyond, whole, generation.bounds().torque(&rates))
    };
    let mut lower = 0;
    for (number, sides) in [[1, -1, 1], [-1, -1, 1], [1, 1, -1]].iter().enumerate() {
        let turn = 0.1 * number as f64;
        let errors = [[0.15 - turn, turn - 0.1, 0.05], [-0.3, 0.2, turn]];
        let time = 0.2 + turn;
        let (torque, beyond, whole, _) = push(runs.bound, None, sides, time, errors);
        assert!(!beyond);
        for i in 0..3 {
            assert!((whole[i] - f64::from(sides[i]) * runs.bound[i]).abs() < 1e-12, "{whole:?}");
            let model = whole[i] - torque[i];
            assert!(model != 0.0 || i == 0, "the reduced model errs");
        }
        // At the rates of the instant the entries allow less.
        let (_, beyond, whole, entries) = push(runs.bound, at_state, sides, time, errors);
        assert!(!beyond);
        for i in 0..3 {
            let bound = (entries[i] + at_state.unwrap().rounding[i]).min(runs.bound[i]);
            lower += usize::from(entries[i] < runs.bound[i]);
            assert!((whole[i] - f64::from(sides[i]) * bound).abs() < 1e-12, "{whole:?}, {entries:?}");
        }
        // What is wrong by more than its bound is left as it is.
        let (torque, beyond, whole, _) = push([1e-9; 3], None, sides, time, errors);
        let wrong = (0..3).filter(|&i| whole[i].abs() > 1.1e-9).collect::<Vec<_>>();
        assert!(beyond && !wrong.is_empty() && wrong.iter().all(|&i| torque[i] == 0.0), "{whole:?}");
    }
    assert!(lower > 0, "the bound for any instant is that of the largest rates");
}

#[test]
fn a_payload_at_its_limit_is_another_arm() {
    let uncertain = |spec: &mut Spec| {
        let ranges = r#"{ "links": [{ "joint": "joint3", "mass": [2.8, 4.2] }], "viscous_friction": [[0.0, 2.0], null, null] }"#;
        control(spec).uncertainty = Some(serde_json::from_str(ranges).unwrap());
    };
    let (plain, family) = (exact(|_| {}), exact(uncertain));
    let own = left_alone(&family, 40);
    assert_eq!(own.family.ranges().len(), 2);
    let [low, high] = [0, 1].map(|end| {
        let vertex: Vec<f64> = own.family.ranges().iter().map(|range| range[end]).collect();
        let arm = own.family.at(&vertex);
        (crate::dynamics::mass_matrix(&arm, &[0.3, -0.4, 0.8])[0][0], arm.joints[0].viscous_friction)
    });
    assert!(low.0 < high.0 && (low.1, high.1) == (0.0, 2.0), "{low:?} {high:?}");
    let (heavy, known) = (found(&family, &own), found(&plain, &left_alone(&plain, 40)));
    for i in 0..3 {
        assert!(heavy.end_error[i] > 20.0 * known.end_error[i], "{heavy:?} {known:?}");
    }
}

/// What the frozen loop says of its attacks comes true on the arm, as far as an arm along a motion is linear.
#[test]
fn attacks_reach_what_the_frozen_loop_says() {
    let generation = exact(|spec| {
        control(spec).initial_error =
            InitialErrorSpec { position: VectorSpec::Scalar(0.002), velocity: VectorSpec::Scalar(0.01) };
        spec.simulation.duration = Some(2.0);
    });
    let scenario = Scenario::of(&generation).unwrap();
    let mut request = request(&generation, 1);
    request.model_error = without_model_error(0.2);
    let runs = Runs::<f64, 3>::new(&scenario, &request).unwrap();
    let mut push = Push {
        bound: [0.2; 3],
        followed: &[],
        at_state: None,
        exact: None,
        code: &runs.emitted,
        p12: &runs.rig.gains.p12,
    };
    let after = |plan: &Plan<3>, step: usize| {
        let instants = Instants { end: step, ..runs.instants };
        let Controlled { model, law, .. } = runs.controlled.clone();
        run(&runs.rig, &runs.arm, (model, law), plan, &push, &instants).unwrap().end
    };
    for (joint, step) in (0..3).flat_map(|joint| [10, 40, 120].map(|step| (joint, step))) {
        let row = runs.planner.frozen.sensitivity(joint, 0, step);
        let errors: f64 = row.initial[0].iter().map(|x| 0.002 * x.abs()).sum::<f64>()
            + row.initial[1].iter().map(|x| 0.01 * x.abs()).sum::<f64>();
        let pushes: f64 = row.torque.iter().flatten().map(|x| 0.2 * x.abs()).sum();
        let said = errors + pushes;
        // The held torque has an error of its own, which helps one side as much as it hinders the other.
        let sides = [1.0, -1.0].map(|side| {
            let targets = [step, runs.instants.steps];
            after(&runs.planner.attack(joint, side, &targets, true), step)[joint]
        });
        let seen = 0.5 * (sides[0] + sides[1]);
        assert!((seen / said - 1.0).abs() < 0.02, "joint {joint}, step {step}: {seen}, said {said}");
    }
    // No more than what the guarantee was made for at that step.
    let followed = [(0, [0.05; 3]), (10, [0.1, 0.3, 0.1])];
    push.followed = &followed;
    let desired = runs.rig.reference.at(0.0);
    let at = |step: usize| push.torque(step, &desired.q, &desired.qd, &desired, &[1; 3]).0;
    assert_eq!((at(0), at(9), at(10), at(500)), ([0.05; 3], [0.05; 3], [0.1, 0.2, 0.1], [0.1, 0.2, 0.1]));
}

#[test]
fn a_loop_that_diverges_is_counted() {
    let generation = exact(|spec| {
        control(spec).period = Some(0.05);
        control(spec).initial_error.position = VectorSpec::Scalar(0.05);
        if let Some(MotionSpec::Quintic { from, to, .. }) = &mut spec.motion {
            (from[2], to[2]) = (-0.2, -0.1);
        }
    });
    let found = found(&generation, &left_alone(&generation, 4));
    assert_eq!((found.runs, found.lost), (4, 4));
    let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
    for errors in [&found.reach, &found.settled_error, &found.end_error] {
        assert!(largest(errors) > 0.5 && largest(errors).is_finite(), "{found:?}");
    }
}
