//! The C interface: compiled by cargo, gcc and g++, it gives the bits of the module.

mod build;
mod calls;
mod guide;

use std::fmt::Write as _;
use std::sync::LazyLock;

use gramforge::Config;
use gramforge_generated::arm3_adaptive;
use gramforge_runtime::{StepController, TickReference};
use gramforge_tests::random::Random;

use build::{Language, Library, generate, with_c_api};
use calls::{Answering, compare};

#[allow(dead_code, reason = "a test does not use the whole module")]
#[rustfmt::skip]
mod step_exact {
    include!(concat!(env!("OUT_DIR"), "/step_exact.rs"));
}

#[allow(dead_code, reason = "a test does not use the whole module")]
#[rustfmt::skip]
mod single_adaptive {
    include!(concat!(env!("OUT_DIR"), "/single_adaptive.rs"));
}

/// The modules that the programs use, built once.
static LIBRARY: LazyLock<Library> =
    LazyLock::new(|| Library::new(&["arm3_adaptive", "step_exact", "single_adaptive"].map(with_c_api)));

#[test]
fn torques_have_the_bits_of_the_module_in_c_and_in_cpp() {
    let compiled = |language| LIBRARY.compile("torques.c", language);
    let programs: Vec<_> = Language::installed().into_iter().map(compiled).collect();
    let mut adaptive = Answering::new('a', StepController::<arm3_adaptive::Arm3Adaptive, 3, 1>::new());
    let mut exact = Answering::new('e', StepController::<step_exact::StepExact, 3>::new());
    let script = calls::script(&mut adaptive, &arm3_adaptive::REFERENCE, &mut exact, &step_exact::REFERENCE);
    for program in &programs {
        compare(&script, &program.answers(&script.input));
    }
}

#[test]
fn a_module_in_f32_has_the_bits_of_its_module_in_rust() {
    let mut controller = single_adaptive::controller();
    let mut random = Random::new(23);
    let (mut input, mut wanted) = (String::new(), Vec::new());
    let bits = |x: &[f32]| x.iter().map(|x| format!(" {:x}", x.to_bits())).collect::<String>();
    // The motion takes 5000 periods.
    for tick in (0..6000).step_by(7).chain([4999, 5000, 5001, u32::MAX]) {
        let [e, ed] = [0.3, 1.0].map(|most| random.array::<3>(most).map(|x| x as f32));
        let desired = single_adaptive::REFERENCE.at(tick);
        let q: [f32; 3] = std::array::from_fn(|i| e[i] + desired.q[i]);
        let qd: [f32; 3] = std::array::from_fn(|i| ed[i] + desired.qd[i]);
        let torque = controller.step(&q, &qd, &desired).expect("no fault").torque;
        writeln!(input, "{tick}{}{}", bits(&e), bits(&ed)).expect("text");
        let motion = [desired.q, desired.qd, desired.qdd].concat();
        wanted.push(format!("0{} 0{}{}", bits(&motion), bits(&torque), bits(controller.learnt())));
    }
    assert_ne!(controller.learnt(), single_adaptive::controller().learnt(), "it learns");
    for language in Language::installed() {
        assert_eq!(LIBRARY.compile("single.c", language).answers(&input), wanted, "{language:?}");
    }
}

#[test]
fn no_pointer_and_no_memory_does_harm() {
    for language in Language::installed() {
        let said = LIBRARY.compile("misuse.c", language).answers("");
        assert_eq!(said, ["good"], "{language:?}");
    }
}

#[test]
fn the_module_is_the_same_with_a_c_interface() {
    let committed = include_str!("../../../generated/src/arm3_adaptive.rs");
    let made = std::fs::read_to_string(LIBRARY.file("arm3_adaptive.rs")).expect("a module");
    let body = |text: &str| text.split_once("below this line").map(|(_, body)| body.to_string());
    assert_eq!(body(&made), body(committed));
}

#[test]
fn the_check_looks_at_every_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let (specs, out) = (folder.path().join("specs"), folder.path().join("out"));
    let made = generate(&[with_c_api("arm3_xi2")], &specs, &out);
    let files: Vec<_> = made[0].c_files.iter().map(|file| file.path.clone()).collect();
    let names = ["arm3_xi2.h", "arm3_xi2_c/Cargo.toml", "arm3_xi2_c/src/lib.rs"];
    assert_eq!(files, names.map(|name| out.join(name)));
    assert!(made[0].written && made[0].c_files.iter().all(|file| file.written));
    let config = Config::new().out_dir(&out).spec(specs.join("arm3_xi2.json"));
    config.check().expect("all is current");
    let again = config.generate().expect("generated");
    assert!(!again[0].written && again[0].c_files.iter().all(|file| !file.written));
    for file in &files {
        let good = std::fs::read_to_string(file).expect("a file");
        std::fs::write(file, good.replacen('a', "b", 1)).expect("written");
        let stale = config.check().expect_err("a file differs").to_string();
        assert_eq!(stale.matches(" differs ").count(), 1, "{stale}");
        assert!(stale.starts_with(&file.display().to_string()), "{stale}");
        let mended = config.generate().expect("generated");
        let written: Vec<_> = mended[0].c_files.iter().filter(|file| file.written).collect();
        assert!(!mended[0].written && written.len() == 1 && written[0].path == *file);
        assert_eq!(std::fs::read_to_string(file).expect("a file"), good);
    }
    // All or nothing: a folder where the header should be.
    std::fs::remove_dir_all(&out).expect("removed");
    std::fs::create_dir_all(&files[0]).expect("a folder");
    assert!(config.generate().is_err() && !out.join("arm3_xi2.rs").exists());
}
