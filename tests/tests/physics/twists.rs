//! Compiled modules of arms whose angles lie beside right angles, against an oracle outside the generator.

mod arms;

use std::path::{Path, PathBuf};

use arms::{ACCELERATION, Case, RANGE, SPEED, case, welded};
use gramforge::Effort;
use gramforge::Generation;
use gramforge::internals::torque::Form;
use gramforge::load::load;
use gramforge_tests::oracle::passivity_torque;
use gramforge_tests::random::Random;
use gramforge_tests::scratch::{Call, compile};
use rayon::prelude::*;
use serde_json::{Value, json};

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];
/// States a module.
const STATES: usize = 24;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A module to be compiled, and what it must compute.
struct Made {
    case: Case,
    generation: Generation,
    name: String,
}

fn made(folder: &Path, case: Case, model: &str, edit: impl Fn(&mut Value)) -> Made {
    let mut spec = case.spec.clone();
    let name = format!("{}_{model}", spec["name"].as_str().unwrap());
    spec["name"] = json!(name);
    edit(&mut spec);
    if let Some(urdf) = &case.urdf {
        std::fs::write(folder.join(format!("{name}.urdf")), urdf).unwrap();
        spec["arm"]["urdf"] = json!(format!("{name}.urdf"));
    }
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).unwrap();
    let effort = Effort::default().boxes(2000).starts(2);
    let generation = load(&path)
        .and_then(|loaded| Generation::with_effort(loaded, &effort))
        .unwrap_or_else(|error| panic!("{error}"));
    Made { case, generation, name }
}

/// q, q̇, v_r and a_r within the limits; corners of the rates among them.
fn states(seed: u64, n: usize) -> Vec<[Vec<f64>; 4]> {
    let mut random = Random::new(seed);
    (0..STATES)
        .map(|k| {
            let q = random.vector(n, RANGE);
            let mut rate = |most: f64| {
                let x = random.vector(n, most);
                if k % 2 == 0 { x } else { x.iter().map(|x| most.copysign(*x)).collect() }
            };
            [q, rate(SPEED), rate(SPEED), rate(ACCELERATION)]
        })
        .collect()
}

/// By joint, the largest error of the compiled code and the largest torque.
fn errors(folder: &Path, all: &[Made]) -> Vec<(Vec<f64>, Vec<f64>)> {
    let modules: Vec<_> = all
        .par_iter()
        .map(|made| (made.name.clone(), made.case.links.len(), made.generation.module().unwrap()))
        .collect();
    let program = compile(folder, &modules);
    let each: Vec<_> =
        all.iter().enumerate().map(|(i, made)| (i, states(i as u64, made.case.links.len()))).collect();
    let calls: Vec<Call> =
        each.iter().flat_map(|(i, states)| states.iter().map(move |state| (*i, state.concat()))).collect();
    let answers = program.torques(&calls);
    assert_eq!(answers.len(), calls.len());
    each.par_iter()
        .map(|(i, states)| {
            let n = all[*i].case.links.len();
            let (mut worst, mut most) = (vec![0.0_f64; n], vec![0.0_f64; n]);
            for ([q, qd, v_r, a_r], answer) in states.iter().zip(&answers[i * STATES..]) {
                let right = passivity_torque(&all[*i].case.links, GRAVITY, q, qd, v_r, a_r);
                assert_eq!(answer.len(), n);
                for (j, right) in right.iter().enumerate() {
                    let off = right.off(answer[j]);
                    worst[j] = worst[j].max(if off.is_nan() { f64::INFINITY } else { off });
                    most[j] = most[j].max(right.0.abs());
                }
            }
            (worst, most)
        })
        .collect()
}

/// Number of joints of arm `index`: mostly few, up to seven.
fn joints(index: u64) -> usize {
    [1, 2, 3, 4, 2, 3, 4, 3, 5, 4, 2, 6, 3, 4, 5, 3, 2, 4, 3, 7][index as usize % 20]
}

fn exponent(index: u64) -> i32 {
    -2 - (index / 4 % 11) as i32
}

/// Exact modules of 200 arms: within 1e-13 of each joint's largest torque for up to four joints, 1e-12 beyond, and within
/// what they say of themselves.
#[test]
fn exact_modules_keep_every_twist() {
    let folder = folder("twists_exact");
    let mut all: Vec<Made> = (0..200_u64)
        .into_par_iter()
        .map(|index| made(&folder, case(index, joints(index), exponent(index)), "exact", |_| ()))
        .collect();
    // The same in the other form: as many functions as there are.
    let expanded: Vec<Made> = (0..200_u64)
        .into_par_iter()
        .filter(|index| {
            joints(*index) <= 2 && all[*index as usize].generation.lagrangian().functions.len() < 400
        })
        .map(|index| {
            let count = all[index as usize].generation.lagrangian().functions.len();
            let case = case(index, joints(index), exponent(index));
            made(&folder, case, "expanded", |spec| {
                spec["model"] = json!({ "shared": { "functions": count } })
            })
        })
        .collect();
    all.extend(expanded);
    let found = errors(&folder, &all);
    println!("{:>9} {:>7} {:>12} {:>12}", "twist", "modules", "1-4 joints", "5-7 joints");
    for exponent in (-12..=-2).rev() {
        let (mut worst, mut count) = ([0.0_f64; 2], 0);
        for (made, (off, most)) in all.iter().zip(&found).filter(|(made, _)| made.case.exponent == exponent) {
            count += 1;
            let group = usize::from(made.case.links.len() > 4);
            for (off, most) in off.iter().zip(most).filter(|(off, _)| **off > 0.0) {
                worst[group] = worst[group].max(off / most);
            }
        }
        println!("{:>9} {count:>7} {:>12.1e} {:>12.1e}", format!("1e{exponent}"), worst[0], worst[1]);
    }
    let forms = |form| all.iter().filter(|made| made.generation.form() == form).count();
    println!("{} recursive, {} expanded", forms(Form::Recursive), forms(Form::Expanded));
    assert!(forms(Form::Recursive) >= 100 && forms(Form::Expanded) >= 40);
    for (made, (off, most)) in all.iter().zip(&found) {
        let allowed = if made.case.links.len() <= 4 { 1e-13 } else { 1e-12 };
        let claimed = &made.generation.torque().expect("limits of every joint").error;
        for ((off, most), claimed) in off.iter().zip(most).zip(claimed) {
            let (name, source) = (&made.name, made.case.source);
            assert!(*off <= allowed * most, "{name} ({source}): {off:e} of {most:e}");
            assert!(off <= claimed, "{name} ({source}): {off:e}, and it says {claimed:e}");
        }
    }
}

/// Reduced modules, and exact ones of arms whose angles were rounded: within what they say.
#[test]
fn reduced_and_rounded_modules_keep_what_they_say() {
    let folder = folder("twists_reduced");
    let few = |index: u64| case(index, [1, 2, 3, 3, 4][index as usize % 5], exponent(index));
    let mut all: Vec<Made> = (0..40_u64)
        .into_par_iter()
        .map(|index| {
            made(&folder, few(index), "rounded", |spec| {
                spec["arm"]["round_angles"] = json!(2.0 * 10.0_f64.powi(exponent(index)))
            })
        })
        .collect();
    // Each too small to be seen, all of them together not.
    all.push(made(&folder, welded(9.9e-12), "welded", |spec| spec["arm"]["round_angles"] = Value::Null));
    assert!(all.last().is_some_and(|made| made.generation.arm() != made.generation.given()));
    let tolerances = (0..30_u64).into_par_iter().map(|index| {
        let torque = [0.001, 0.01, 0.05, 0.2][index as usize / 4 % 4];
        made(&folder, few(index), "tolerance", |spec| {
            spec["model"] = json!({ "tolerance": { "torque": torque } })
        })
    });
    all.extend(tolerances.collect::<Vec<_>>());
    let shared = (0..20_u64).into_par_iter().map(|index| {
        made(&folder, few(index), "shared", |spec| spec["model"] = json!({ "separate": { "functions": 1 } }))
    });
    all.extend(shared.collect::<Vec<_>>());
    let found = errors(&folder, &all);
    let mut attained = [0.0_f64; 2];
    for (made, (off, _)) in all.iter().zip(&found) {
        let claimed = &made.generation.torque().expect("limits of every joint").error;
        let rounded = made.generation.arm() != made.generation.given();
        for (off, claimed) in off.iter().zip(claimed) {
            assert!(off <= claimed, "{}: {off:e}, and it says {claimed:e}", made.name);
            let kind = usize::from(rounded);
            attained[kind] = attained[kind].max(off / claimed);
        }
    }
    let count = |is: &dyn Fn(&Generation) -> bool| all.iter().filter(|made| is(&made.generation)).count();
    let rounded = count(&|g| g.arm() != g.given());
    let sparse = count(&|g| g.form() == Form::Sparse);
    let simpler = count(&|g| g.reduced().simplified_arm().is_some());
    let expanded = count(&|g| g.form() == Form::Expanded && !g.reduced().is_exact());
    println!(
        "{rounded} rounded, {sparse} sparse, {simpler} simpler arms, {expanded} expanded; largest part of what is said: reduced {:.3}, rounded {:.3}",
        attained[0], attained[1]
    );
    assert!(rounded >= 20 && sparse >= 5 && simpler >= 1 && expanded >= 10);
    assert!(attained[0] > 0.5 && attained[1] > 0.05, "{attained:?}");
}

/// What is said to be saved by a larger `arm.round_angles` is saved by it.
#[test]
fn advice_on_angles_tells_what_it_saves() {
    let folder = folder("twists_advice");
    let mut told = 0;
    for index in [1_u64, 2, 4, 8, 9, 12] {
        let few = || case(index, 2, -7);
        let made = |name: &str, angle: f64| {
            made(&folder, few(), name, |spec| spec["arm"]["round_angles"] = json!(angle)).generation
        };
        let before = made("before", 0.0);
        let now = before.exact_code().operations().arithmetic();
        let Some(advice) = before.warnings().iter().find(|text| text.contains("arm.round_angles")) else {
            continue;
        };
        let after = |mark: &str| {
            let (_, rest) = advice.split_once(mark).expect("the words of the advice");
            rest.split_whitespace().next().expect("a number")
        };
        let level: f64 = after("write ").parse().expect("an angle");
        let saved: usize = after("which saves ").parse().expect("a number of operations");
        assert_eq!(made("after", level).exact_code().operations().arithmetic(), now - saved, "{advice}");
        told += 1;
    }
    assert!(told >= 3, "{told}");
}
