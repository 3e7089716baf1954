//! Modules with fused operations, compiled for a processor that has them: the bits of their graph, a rounding that no state
//! exceeds, and one clear refusal elsewhere.

use std::fmt::Write as _;
use std::process::Output;

use gramforge::Generation;
use gramforge::internals::emit::type_name;
use gramforge::internals::graph::Variable;
use gramforge::internals::trig::Angle;
use gramforge_tests::random::Random;
use gramforge_tests::scratch::{called, cargo};
use gramforge_tests::{edited, scratch};
use serde_json::json;

use super::double::thirty_digits;

/// A crate with these modules, and how it is compiled.
struct Program<'a> {
    modules: &'a [Generation],
    folder: tempfile::TempDir,
}

impl<'a> Program<'a> {
    fn new(modules: &'a [Generation], features: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut main = String::from(MAIN);
        let mut arms = String::new();
        for (index, made) in modules.iter().enumerate() {
            let (name, n) = (&made.spec().name, made.arm().dof());
            let p = made.step().map_or(0, |step| step.parameters);
            writeln!(main, "#[deny(warnings)]\nmod {name} {{ include!(\"{name}.rs\"); }}").expect("text");
            let model = format!("{name}::{}", type_name(name));
            writeln!(arms, "        (\"step\", {index}) => step::<{model}, {n}, {p}>(&x),").expect("text");
            writeln!(arms, "        (\"torque\", {index}) => torque::<{n}>(&{model}, &x),").expect("text");
            let published = format!("{name}::ROUNDING.map(Real::to_f64).to_vec()");
            writeln!(arms, "        (\"rounding\", {index}) => {published},").expect("text");
            if p > 0 {
                let call = format!("learnt::<{n}, {p}>(&{model}, &x)");
                writeln!(arms, "        (\"learnt\", {index}) => {call},").expect("text");
            }
        }
        write!(main, "fn called(kind: &str, index: usize, x: Vec<f64>) -> Vec<f64> {{\n    match (kind, index) {{\n{arms}        _ => Vec::new(),\n    }}\n}}\n")
            .expect("text");
        scratch::package(folder.path(), features, &main);
        for made in modules {
            let file = folder.path().join("src").join(format!("{}.rs", made.spec().name));
            std::fs::write(file, made.module().expect("a module")).expect("a module");
        }
        Self { modules, folder }
    }

    fn built(&self, flags: &str) -> Output {
        let arguments = ["build", "--offline", "--quiet"];
        cargo(self.folder.path(), &arguments).env("RUSTFLAGS", flags).output().expect("cargo starts")
    }

    /// What the program answers to calls of a function of a module.
    fn answers(&self, calls: &[(&str, usize, Vec<f64>)]) -> Vec<Vec<f64>> {
        called(
            &self.folder.path().join("target/debug/scratch"),
            calls.iter().map(|(kind, index, x)| (format!("{kind} {index}"), x.as_slice())),
        )
    }
}

/// The flags with which a processor of this kind has the operation.
fn flags() -> &'static str {
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) { "-C target-feature=+fma" } else { "" }
}

/// Whether this processor has it.
fn can_run() -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let can = std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let can = cfg!(target_arch = "aarch64");
    can
}

fn made(name: &str, scalar: &str) -> Generation {
    let made = edited(name, |spec| spec["emit"] = json!({ "scalar": scalar, "fma": true }));
    made.unwrap_or_else(|message| panic!("{message}"))
}

/// A state inside those for which the rounding is published: q, q̇, q_d, q̇_d, q̈_d and θ̂, one after the other.
fn state(made: &Generation, random: &mut Random, corner: bool) -> Vec<f64> {
    let (n, motion) = (made.arm().dof(), made.motion().expect("a motion"));
    let states = &made.rounding().expect("a controller").states;
    let adaptation = made.design().and_then(|design| design.adaptation.as_ref());
    let learnt = adaptation.map_or(0, |adaptation| adaptation.low.len());
    let mut x = random.vector(1 + 2 * n + learnt, 1.0);
    if corner {
        x[1..].iter_mut().for_each(|x| *x = x.signum());
    }
    let target = motion.at(0.5 * (x[0] + 1.0) * motion.duration());
    // A hair inside, so that rounding does not leave the states.
    let near = |from: usize, centre: &[f64], most: &[f64]| -> Vec<f64> {
        (0..n).map(|i| centre[i] + 0.999_999 * x[from + i] * most[i]).collect()
    };
    let q = near(1, &target.q, &states.position_error);
    let qd = near(1 + n, &target.qd, &states.velocity_error);
    let theta = adaptation.into_iter().flat_map(|adaptation| {
        let x = x[1 + 2 * n..].iter().zip(adaptation.low.iter().zip(&adaptation.high));
        x.map(|(x, (low, high))| low + 0.5 * (1.0 + 0.999_999 * x) * (high - low))
    });
    let all = q.into_iter().chain(qd).chain(target.q).chain(target.qd).chain(target.qdd).chain(theta);
    let single = made.spec().emit.scalar == gramforge::spec::ScalarSpec::F32;
    all.map(|x| if single { f64::from(x as f32) } else { x }).collect()
}

/// The graphs in the number type of the module: what the program must answer, to the bit.
fn interpreted<T: Angle>(made: &Generation, kind: &str, x: &[f64]) -> Vec<f64> {
    let (n, x): (usize, Vec<T>) = (made.arm().dof(), x.iter().copied().map(T::from_f64).collect());
    let part = |k: usize| &x[k * n..(k + 1) * n];
    let out = match kind {
        "step" => {
            let step = made.step().expect("a controller");
            let mut code = step.code.clone();
            let outputs = code.outputs.split_off(0);
            code.outputs = step.asked().into_iter().chain(outputs).collect();
            code.interpret_step(part(0), part(1), [part(2), part(3), part(4)], &x[5 * n..])
        }
        "torque" => made.code().interpret(part(0), part(1), part(2), part(3)),
        _ => {
            let regressor = made.regressor().expect("a law that learns");
            let mut out = match regressor.own_base {
                true => made.code().interpret(part(0), part(1), part(2), part(3)),
                false => Vec::new(),
            };
            out.extend(regressor.code.interpret(part(0), part(1), part(2), part(3)));
            out
        }
    };
    out.into_iter().map(T::to_f64).collect()
}

fn same_bits(program: &Program) {
    let mut random = Random::new(81);
    let mut calls = Vec::new();
    for (index, made) in program.modules.iter().enumerate() {
        for _ in 0..1000 {
            let x = state(made, &mut random, false);
            calls.push(("step", index, x.clone()));
            calls.push(("torque", index, x[..4 * made.arm().dof()].to_vec()));
            if made.regressor().is_some() {
                calls.push(("learnt", index, x[..4 * made.arm().dof()].to_vec()));
            }
        }
    }
    for ((kind, index, x), answer) in calls.iter().zip(program.answers(&calls)) {
        let made = &program.modules[*index];
        let graph = match made.spec().emit.scalar {
            gramforge::spec::ScalarSpec::F64 => interpreted::<f64>(made, kind, x),
            gramforge::spec::ScalarSpec::F32 => interpreted::<f32>(made, kind, x),
        };
        let bits = |x: &[f64]| -> Vec<u64> { x.iter().map(|x| x.to_bits()).collect() };
        assert!(graph.len() >= made.arm().dof());
        assert_eq!(bits(&answer[..graph.len()]), bits(&graph), "{} {kind} at {x:?}", made.spec().name);
    }
}

fn attacked(program: &Program, index: usize) {
    let made = &program.modules[index];
    let (name, n) = (&made.spec().name, made.arm().dof());
    let (step, rounding) = (made.step().expect("a controller"), made.rounding().expect("a controller"));
    let p12 = &made.design().expect("a controller").gains.p12;
    let mut code = step.code.clone();
    code.outputs = step.asked();
    let mut random = Random::new(82);
    let mut calls = vec![("rounding", index, Vec::new())];
    calls.extend((0..2000).map(|k| ("step", index, state(made, &mut random, k % 2 == 0))));
    let mut answers = program.answers(&calls).into_iter();
    let published = answers.next().expect("the constant");
    assert!(published.iter().zip(&rounding.torque).all(|(constant, bound)| constant >= bound));
    let mut worst = vec![0.0_f64; n];
    for ((_, _, x), computed) in calls[1..].iter().zip(answers) {
        let part = |k: usize, j: usize| x[k * n + j];
        let s =
            |i: usize| (0..n).fold(part(1, i) - part(3, i), |s, j| s + p12[i][j] * (part(0, j) - part(2, j)));
        if (0..n).any(|i| s(i).abs() <= rounding.sign) {
            continue;
        }
        let exact = thirty_digits(&code, &x[..n], |variable| match variable {
            Variable::Q(j) => part(0, j),
            Variable::Qd(j) => part(1, j),
            Variable::DesiredQ(j) => part(2, j),
            Variable::DesiredQd(j) => part(3, j),
            Variable::DesiredQdd(j) => part(4, j),
            Variable::Theta(k) => x[5 * n + k],
            Variable::Vr(_) | Variable::Ar(_) => 0.0,
        });
        for i in 0..n {
            let off = exact[i].off(computed[i]);
            assert!(off <= published[i], "{name}, joint {}: {off:e} above {:e}", i + 1, published[i]);
            worst[i] = worst[i].max(off / published[i]);
        }
    }
    println!("{name}: the fused step rounds by at most {worst:.3?} of what is published");
    assert!(worst.iter().all(|part| *part > 0.005), "{name}: {worst:?}");
}

#[test]
fn fused_modules_have_the_bits_of_their_graph_and_round_by_no_more_than_published() {
    if !can_run() {
        println!("skipped: this processor has no fused multiply-add");
        return;
    }
    let double = ["arm3_xi2", "step_switching", "arm3_adaptive", "puma560_exact", "single_panda"];
    let single = ["single_puma", "single_adaptive"];
    let double = double.map(|name| made(name, "f64"));
    let single = single.map(|name| made(name, "f32"));
    let modules: Vec<Generation> = double.into_iter().chain(single).collect();
    for made in &modules {
        for code in [made.code(), &made.step().expect("a controller").code] {
            assert!(code.operations().fused > 0, "{}", made.spec().name);
        }
    }
    let program = Program::new(&modules, &["std"]);
    let built = program.built(flags());
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    same_bits(&program);
    (0..modules.len()).for_each(|index| attacked(&program, index));
}

#[test]
fn a_fused_module_says_what_it_lacks() {
    let modules = [made("arm3_exact", "f64")];
    let refused = |features: &[&str], flags: &str| {
        let built = Program::new(&modules, features).built(flags);
        assert!(!built.status.success());
        String::from_utf8_lossy(&built.stderr).into_owned()
    };
    let message = refused(&[], flags());
    assert!(message.contains("step::mul_add"), "{message}");
    assert!(message.contains("feature `std`") || message.contains("`std` feature"), "{message}");
    assert_eq!(message.matches("\nerror").count() + 1, 2, "one error and the summary: {message}");
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
        let message = refused(&["std"], "");
        assert!(message.contains("-C target-feature=+fma"), "{message}");
        assert!(message.contains("library call") && message.contains("emit.fma"), "{message}");
        assert_eq!(message.matches("\nerror").count() + 1, 2, "one error and the summary: {message}");
    }
}

#[test]
fn no_c_library_is_fused() {
    let refused = edited("arm3_exact", |spec| spec["emit"] = json!({ "fma": true, "c_api": true }));
    let message = refused.expect_err("two choices that do not go together");
    assert!(message.contains("emit.fma") && message.contains("do not link into one program"), "{message}");
}

/// What is not fused is what it was; what is fused has fewer operations of the same model.
#[test]
fn the_choice_changes_no_model() {
    for name in ["arm3_xi2", "puma3_tolerance"] {
        let [plain, fused] = [false, true].map(|fma| {
            let made = edited(name, |spec| spec["emit"] = json!({ "fma": fma }));
            made.unwrap_or_else(|message| panic!("{message}"))
        });
        assert_eq!(plain.reduced(), fused.reduced(), "{name}");
        assert_eq!(plain.bounds(), fused.bounds(), "{name}");
        assert_eq!(plain.code().operations().fused, 0);
        assert!(fused.code().operations().cost() < plain.code().operations().cost(), "{name}");
        assert!(!plain.module().expect("a module").contains("mul_add"), "{name}");
    }
}

const MAIN: &str = r#"use core::array::from_fn;

use gramforge_runtime::{AdaptiveModel, ControlStep, Desired, Model, Real};

#[allow(dead_code)]
fn numbers<T: Real, const N: usize>(x: &[f64], from: usize) -> [T; N] {
    from_fn(|i| T::from_f64(x[from + i]))
}

fn step<M: ControlStep<N, P>, const N: usize, const P: usize>(x: &[f64]) -> Vec<f64> {
    let part = |k: usize| -> [M::Scalar; N] { numbers(x, k * N) };
    let desired = Desired { q: part(2), qd: part(3), qdd: part(4) };
    let out = M::step(&part(0), &part(1), &desired, &numbers::<_, P>(x, 5 * N));
    let all = out.asked.into_iter().chain(out.limited).chain(out.correction).chain([out.unread]);
    all.map(Real::to_f64).collect()
}

fn torque<const N: usize>(model: &impl Model<N>, x: &[f64]) -> Vec<f64> {
    let out = model.passivity_torque(&numbers(x, 0), &numbers(x, N), &numbers(x, 2 * N), &numbers(x, 3 * N));
    out.map(Real::to_f64).to_vec()
}

#[allow(dead_code)]
fn learnt<const N: usize, const P: usize>(model: &impl AdaptiveModel<N, P>, x: &[f64]) -> Vec<f64> {
    let out = model.regression(&numbers(x, 0), &numbers(x, N), &numbers(x, 2 * N), &numbers(x, 3 * N));
    out.base.into_iter().chain(out.columns.into_iter().flatten()).map(Real::to_f64).collect()
}

fn main() {
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut words = line.split_whitespace();
        let (kind, index) = (words.next().unwrap(), words.next().unwrap().parse().unwrap());
        let x = words.map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap())).collect();
        let bits: Vec<String> = called(kind, index, x).iter().map(|t| format!("{:x}", t.to_bits())).collect();
        println!("{}", bits.join(" "));
    }
}
"#;
