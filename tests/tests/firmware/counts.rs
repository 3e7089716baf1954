//! Instructions, stack, flash and symbols. Instructions are not cycles, but their number does not depend on the memory.

use crate::built::{Build, builds, step_alone};
use crate::elf::Image;

/// The most instructions of a whole step, reference included, on a Cortex-M4F at the highest optimisation; the most
/// bytes of stack there. A RISC-V core may take three tenths more of both.
const LIMITS: [(&str, u64, u64); 9] = [
    ("arm3_xi2", 450, 512),
    ("arm3_exact", 450, 512),
    ("arm3_robust", 500, 512),
    ("arm3_adaptive", 700, 512),
    ("puma560_exact", 1150, 512),
    ("puma560_one_percent", 950, 512),
    ("puma560_robust", 2100, 512),
    ("puma560_adaptive", 1400, 512),
    ("panda_exact", 1600, 768),
];

fn worst(build: &Build, module: &str) -> u64 {
    build.results.value(module, "instructions_worst")
}

/// The first build of a core, at the highest optimisation, or the second, of small code.
fn find(builds: &[Build], cortex: bool, small: bool) -> &Build {
    builds.iter().find(|build| (build.cortex, build.small) == (cortex, small)).expect("four builds")
}

#[test]
fn a_step_takes_no_more_instructions_and_stack_than_stated() {
    let Some(builds) = builds() else { return };
    for (module, instructions, stack) in LIMITS {
        for build in builds {
            let mean = build.results.value(module, "instructions_mean");
            let (worst, used) = (worst(build, module), build.results.value(module, "stack"));
            println!("{module}, {}: worst {worst}, mean {mean} instructions; stack {used} bytes", build.name);
            let most = if build.cortex { stack } else { stack * 13 / 10 };
            assert!(used <= most, "{module}, {}: {used} bytes of stack", build.name);
        }
        let cortex = worst(find(builds, true, false), module);
        assert!(cortex <= instructions, "{module}: {cortex} instructions on a Cortex-M4F");
        let riscv = worst(find(builds, false, false), module);
        assert!(10 * riscv <= 13 * instructions, "{module}: {riscv} instructions on a RISC-V core");
        for (core, fast) in [(true, cortex), (false, riscv)] {
            let small = worst(find(builds, core, true), module);
            assert!(10 * small <= 12 * fast, "{module}: {small} instructions in small code, {fast} in fast");
        }
    }
}

#[test]
fn a_pair_of_sine_and_cosine_takes_few_instructions() {
    let Some(builds) = builds() else { return };
    for build in builds {
        let worst = build.results.value("sines", "pair_worst");
        let most = if build.cortex { 60 } else { 78 };
        assert!(worst <= most, "{}: {worst} instructions", build.name);
    }
}

#[test]
fn a_controller_starts_at_once_and_is_small() {
    let Some(builds) = builds() else { return };
    for build in builds {
        for (module, instructions) in build.results.values("start") {
            assert!(instructions <= 200, "{module}, {}: {instructions} instructions", build.name);
        }
        for (module, bytes) in build.results.values("controller_bytes") {
            assert!(bytes <= 64, "{module}: {bytes}");
        }
    }
}

#[test]
fn nothing_in_an_image_panics_allocates_formats_or_computes_in_double_precision() {
    let Some(builds) = builds() else { return };
    for build in builds {
        let image = Image::read(&build.image);
        assert!(image.symbols.iter().any(|name| name == "puma560_one_percent"), "the symbols are there");
        let found = image.foul();
        assert!(found.is_empty(), "{}: {found:?}", build.name);
    }
}

#[test]
fn a_step_and_all_it_calls_fit_in_a_few_kibibytes() {
    let Some(builds) = builds() else { return };
    for build in builds {
        for (module, ..) in LIMITS {
            let flash = Image::read(&step_alone(build, module)).flash;
            println!("{module}, {}: {flash} bytes of flash", build.name);
            let most = if module == "puma560_one_percent" { 6 } else { 16 };
            assert!(flash <= 1024 * most, "{module}, {}: {flash} bytes", build.name);
        }
    }
}
