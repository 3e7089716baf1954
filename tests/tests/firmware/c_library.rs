//! The modules through their C interface: what C gets on a Cortex-M4F is what Rust gets on the host, bit for bit.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use gramforge::Generation;

use crate::COUNTS;
use crate::built::{CORTEX, MADE, builds, host, write};
use crate::elf::Image;
use crate::results::Results;
use crate::toolchain::{cargo, firmware, output, prefix, qemu, scratch};

/// The modules that `tests/firmware/c` calls.
pub const MODULES: [&str; 4] = ["arm3_xi2", "arm3_adaptive", "puma560_one_percent", "panda_exact"];

/// The program in C with the libraries of all modules, at one level of optimisation.
struct Program {
    /// The level, of Rust and of C.
    level: &'static str,
    image: PathBuf,
    results: Results,
}

/// The program at both levels; `None` without the toolchain.
fn programs() -> Option<&'static [Program]> {
    static PROGRAMS: LazyLock<Option<Vec<Program>>> = LazyLock::new(|| {
        let prefix = prefix()?;
        Some(["3", "s"].map(|level| program(&prefix, level)).into())
    });
    PROGRAMS.as_deref()
}

/// The folder of the headers and of the crates that give the libraries. Not that of the modules: cargo writes into it.
fn folder() -> PathBuf {
    scratch().join("c")
}

/// Writes what belongs to the C interface of a module, where it has one.
pub fn write_files(name: &str, generation: &Generation, module: &str) {
    let files = generation.c_files().unwrap_or_else(|error| panic!("{name}: {error}"));
    if files.is_empty() {
        return;
    }
    let source = folder().join(format!("{name}_c/src"));
    std::fs::create_dir_all(&source).unwrap_or_else(|error| panic!("{}: {error}", source.display()));
    write(&folder().join(format!("{name}.rs")), module);
    for file in files {
        write(&folder().join(file.path), &file.text);
    }
}

/// Builds the library of a module with the feature `panic_handler`, as the guide says.
fn library(prefix: &Path, name: &str, level: &str) -> PathBuf {
    let shim = folder().join(format!("{name}_c"));
    let workspace = firmware().join("../..");
    std::fs::copy(workspace.join("Cargo.lock"), shim.join("Cargo.lock")).expect("the lock file");
    let target = folder().join("target").join(level);
    let runtime = workspace.join("runtime");
    let mut cargo = cargo(&shim, &MADE);
    cargo
        .env("RUSTC", prefix.join("bin/rustc"))
        .env("RUSTFLAGS", "-Ctarget-cpu=cortex-m4")
        .env("CARGO_TARGET_DIR", &target)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level)
        .args(["build", "-q", "--offline", "--release", "--target", CORTEX, "--config"])
        .arg(format!("patch.crates-io.gramforge-runtime.path={runtime:?}"));
    output(&mut cargo);
    target.join(CORTEX).join(format!("release/lib{name}_c.a"))
}

fn program(prefix: &Path, level: &'static str) -> Program {
    LazyLock::force(&MADE);
    let libraries = MODULES.map(|name| library(prefix, name, level));
    let (source, image) = (firmware().join("c"), folder().join(format!("program-{level}.elf")));
    let mut compiler = Command::new(prefix.join("bin/arm-none-eabi-gcc"));
    compiler
        .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-ffreestanding", "-nostdlib"])
        .args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"])
        // A fused product would give other states than Rust's.
        .args(["-ffp-contract=off", &format!("-O{level}"), "-Wl,--gc-sections,-z,noexecstack"])
        .arg("-T")
        .arg(firmware().join("cortex_m.ld"))
        .arg("-I")
        .arg(folder())
        .args(["main.c", "board.c"].map(|file| source.join(file)))
        .args(&libraries)
        .arg("-o")
        .arg(&image);
    output(&mut compiler);
    let results = Results::parse(&output(&mut qemu(prefix, true, &image)));
    Program { level, image, results }
}

#[test]
fn c_on_the_core_gets_the_bits_that_rust_gets_on_the_host() {
    let Some(programs) = programs() else { return };
    let host = host();
    for Program { level, results, .. } in programs {
        for key in ["torques", "not_finite_commands", "not_finite_and_wrong", "steps_with_fault"] {
            assert_eq!(results.values(key).len(), MODULES.len(), "{key}, level {level}");
        }
        for ((module, key), &value) in &results.0 {
            if !COUNTS.contains(&key.as_str()) {
                assert_eq!(value, host.value(module, key), "{module}, {key}, level {level}");
            }
        }
        for key in ["not_finite_and_wrong", "steps_with_fault"] {
            assert!(results.values(key).values().all(|&count| count == 0), "{key}, level {level}");
        }
    }
}

#[test]
fn nothing_in_a_program_in_c_panics_allocates_formats_or_computes_in_double_precision() {
    let Some(programs) = programs() else { return };
    for Program { level, image, .. } in programs {
        let image = Image::read(image);
        for module in MODULES {
            let step = format!("{module}_step");
            assert!(image.symbols.contains(&step), "the symbols are there");
        }
        let found = image.foul();
        assert!(found.is_empty(), "level {level}: {found:?}");
    }
}
