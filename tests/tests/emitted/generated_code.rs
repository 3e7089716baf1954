//! Generated modules, the committed ones and those that the build script makes: the bits of the graph, the constants of
//! the generation, the torques of the reference values.

use gramforge::{Config, Generation};
use gramforge_generated::{
    arm3_exact, arm3_xi1, arm3_xi2, arm3_xi3, puma560_exact, puma560_xi6, puma560_xi12,
};
use gramforge_runtime::reference::Reference;
use gramforge_runtime::{Bounds, Model};
use gramforge_tests::random::Random;
use gramforge_tests::truth::Truth;
use gramforge_tests::{array, difference, generation, largest, spec};

included!(ur5 stanford arm3_sinusoids arm3_waypoints arm3_csv arm3_polynomial arm3_table);
included!(puma3_separate puma3_union puma3_tolerance stanford_tolerance);

/// A module as `agrees` takes it: its name, its model, and its constants.
macro_rules! module {
    ($name:ident, $model:ident) => {
        agrees(
            stringify!($name),
            &$name::$model,
            &$name::REFERENCE,
            &Constants {
                bounds: &$name::BOUNDS,
                viscous: &$name::VISCOUS_FRICTION,
                counts: [$name::FUNCTIONS, $name::MULTIPLICATIONS, $name::ADDITIONS, $name::TRIG_PAIRS],
                psi: &$name::PSI,
            },
        )
    };
}

/// Constants of a module.
struct Constants<'a, const N: usize> {
    bounds: &'a Bounds<f64, N>,
    viscous: &'a [f64; N],
    /// Functions, multiplications, additions, sine-cosine pairs.
    counts: [usize; 4],
    psi: &'a [&'a str],
}

fn agrees<const N: usize>(
    name: &str,
    model: &impl Model<N, Scalar = f64>,
    reference: &impl Reference<f64, N>,
    module: &Constants<N>,
) {
    let made = generation(name);
    constants(&made, module);
    let mut random = Random::new(20);
    for _ in 0..1000 {
        let (q, qd) = (random.array::<N>(3.2), random.array(5.0));
        let (v_r, a_r) = (random.array(5.0), random.array(20.0));
        let compiled = model.passivity_torque(&q, &qd, &v_r, &a_r);
        let interpreted: [f64; N] = array(&made.code().interpret(&q, &qd, &v_r, &a_r));
        assert_eq!(compiled.map(f64::to_bits), interpreted.map(f64::to_bits), "{name} at {q:?}");
    }
    let motion = made.motion().expect("every specification here has a motion");
    assert_eq!(reference.duration(), motion.duration());
    reference.check().unwrap();
    for k in 0..1000 {
        let t = motion.duration() * f64::from(k) / 1000.0;
        let (now, target) = (reference.at(t), motion.at(t));
        let target: [[f64; N]; 3] = [array(&target.q), array(&target.qd), array(&target.qdd)];
        let bits = |x: [[f64; N]; 3]| x.map(|row| row.map(f64::to_bits));
        assert_eq!(bits([now.q, now.qd, now.qdd]), bits(target), "{name} at {t} s");
    }
    println!("{name}: same bits as its graph at 1000 states and as its motion at 1000 instants");
}

fn constants<const N: usize>(made: &Generation, module: &Constants<N>) {
    let Constants { bounds, viscous, counts, psi } = *module;
    let operations = made.code().operations();
    let names: Vec<String> = match made.reduced().sparse() {
        Some(model) => model.functions.iter().map(|psi| psi.formula(made.lagrangian())).collect(),
        None => made.reduced().selected.iter().map(|&l| made.lagrangian().functions[l].to_string()).collect(),
    };
    assert_eq!(psi, names);
    assert_eq!(counts, [names.len(), operations.mul, operations.add, operations.trig_pairs]);
    assert_eq!(bounds.d.concat(), made.bounds().d.concat());
    assert_eq!(bounds.h.concat().concat(), made.bounds().h.concat().concat());
    assert_eq!(bounds.g, made.bounds().g[..]);
    assert_eq!(bounds.b, [0.0; N]);
    let friction: Vec<f64> = made.arm().joints.iter().map(|joint| joint.viscous_friction).collect();
    assert_eq!(viscous, &friction[..]);
}

#[test]
fn committed_modules_agree_with_their_generation() {
    module!(arm3_exact, Arm3Exact);
    module!(arm3_xi1, Arm3Xi1);
    module!(arm3_xi2, Arm3Xi2);
    module!(arm3_xi3, Arm3Xi3);
    module!(puma560_exact, Puma560Exact);
    module!(puma560_xi6, Puma560Xi6);
    module!(puma560_xi12, Puma560Xi12);
}

#[test]
fn modules_of_a_build_script_agree_with_their_generation() {
    module!(ur5, Ur5);
    module!(stanford, Stanford);
    module!(arm3_sinusoids, Arm3Sinusoids);
    module!(arm3_waypoints, Arm3Waypoints);
    module!(arm3_csv, Arm3Csv);
    module!(arm3_polynomial, Arm3Polynomial);
    module!(arm3_table, Arm3Table);
    module!(puma3_separate, Puma3Separate);
    module!(puma3_union, Puma3Union);
    module!(puma3_tolerance, Puma3Tolerance);
    module!(stanford_tolerance, StanfordTolerance);
    let made = generation("puma3_tolerance");
    assert!(
        made.reduced().sparse().is_some_and(|model| model.absolute.is_some()),
        "a sparse model in absolute angles"
    );
    assert!(
        generation("stanford_tolerance").reduced().simplified_arm().is_some(),
        "the recursion of a simpler arm"
    );
    assert_eq!(generation("puma3_union").form().name(), "sparse");
    // A controller is made at compile time.
    const _: () = {
        let _ = (ur5::controller(), stanford::controller(), arm3_csv::controller());
    };
}

#[test]
fn committed_modules_are_current() {
    let folder = std::path::Path::new("../generated");
    let mut specs: Vec<_> = std::fs::read_dir(folder.join("specs"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "json"))
        .collect();
    specs.sort();
    assert!(specs.len() >= 7, "{specs:?}");
    let config = specs.iter().fold(Config::new(), |config, spec| config.spec(spec));
    if let Err(error) = config.out_dir(folder.join("src")).check() {
        panic!("{error}");
    }
}

#[test]
fn a_stale_module_names_the_command_that_renews_it() {
    let stale = Config::new().spec(spec("arm3_csv")).out_dir("../generated/src").check();
    let message = stale.unwrap_err().to_string();
    println!("{message}");
    assert!(
        message.contains("gramforge generate") && message.contains("arm3_csv.json --out ../generated/src")
    );
}

/// Largest error of the module's torque, as a fraction of the largest reference torque.
fn error<const N: usize>(model: &impl Model<N, Scalar = f64>, arm: &str) -> f64 {
    let truth = Truth::of(arm);
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for state in &truth.samples {
        let (q, qd, qdd) = (array(&state.q), array(&state.qd), array(&state.qdd));
        let torque = model.passivity_torque(&q, &qd, &qd, &qdd);
        worst = worst.max(difference(&torque, state.torque()));
        most = most.max(largest(state.torque()));
    }
    println!("{arm}: torque of the exact module off by {:.1e}", worst / most);
    worst / most
}

#[test]
fn exact_modules_give_the_reference_torques() {
    assert!(error(&arm3_exact::Arm3Exact, "threedof") < 1e-9);
    assert!(error(&arm3_csv::Arm3Csv, "threedof") < 1e-9);
    assert!(error(&puma560_exact::Puma560Exact, "puma560") < 1e-9);
}
