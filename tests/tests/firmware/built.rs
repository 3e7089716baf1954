//! The program, built and run: on the host once, on each core at each level of optimisation.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use gramforge_tests::edited;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::c_library;
use crate::results::Results;
use crate::toolchain::{cargo, firmware, output, prefix, qemu, scratch};

/// The program on one core, at one level of optimisation.
#[derive(Debug)]
pub struct Build {
    /// For messages.
    pub name: String,
    /// Whether the core is the Cortex-M4F.
    pub cortex: bool,
    /// Whether small code was asked for.
    pub small: bool,
    /// The image that was run.
    pub image: PathBuf,
    /// What it printed.
    pub results: Results,
}

/// Modules of the program, and the specifications that they come from: renamed, in f32, and changed as `MADE` says.
const MODULES: [(&str, &str); 9] = [
    ("arm3_xi2", "arm3_xi2"),
    ("arm3_exact", "arm3_exact"),
    ("arm3_robust", "arm3_robust"),
    ("arm3_adaptive", "arm3_adaptive"),
    ("puma560_exact", "puma560_exact"),
    ("puma560_one_percent", "puma560_one_percent"),
    ("puma560_robust", "puma560_xi6"),
    ("puma560_adaptive", "puma560_exact"),
    ("panda_exact", "panda"),
];

/// The Cortex-M4F.
pub const CORTEX: &str = "thumbv7em-none-eabihf";
const RISCV: &str = "riscv32imafc-unknown-none-elf";

/// All builds; `None` without the toolchain.
pub fn builds() -> Option<&'static [Build]> {
    static BUILDS: LazyLock<Option<Vec<Build>>> = LazyLock::new(|| {
        let prefix = prefix()?;
        let each = [(CORTEX, "release"), (CORTEX, "size"), (RISCV, "release"), (RISCV, "size")];
        // One after the other: they share a folder.
        Some(each.map(|(target, profile)| build(&prefix, target, profile)).into())
    });
    BUILDS.as_deref()
}

/// What the program prints on the host.
pub fn host() -> &'static Results {
    static HOST: LazyLock<Results> = LazyLock::new(|| {
        Results::parse(&output(cargo(&firmware(), &MADE).args(["run", "-q", "--locked", "--release"])))
    });
    &HOST
}

/// Links the whole step of one module of a build alone; the image of that step and of all that it calls.
pub fn step_alone(build: &Build, module: &str) -> PathBuf {
    let Some(prefix) = prefix() else { panic!("there is a build but no toolchain") };
    let image = scratch().join(format!("{module}-{}.elf", build.name.replace(' ', "-")));
    let linker = prefix.join("usr/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld");
    let library = build.image.with_file_name("libfirmware.a");
    output(
        Command::new(linker)
            .args(["-flavor", "gnu", "--gc-sections", "-e", module, "-o"])
            .args([&image, &library]),
    );
    image
}

/// The folder of the modules.
pub static MADE: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = scratch().join("modules");
    std::fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    MODULES.par_iter().for_each(|(name, from)| {
        let made = edited(from, |spec: &mut Value| {
            spec["name"] = json!(name);
            spec["emit"] = json!({ "scalar": "f32", "c_api": c_library::MODULES.contains(name) });
            match *name {
                "panda_exact" => spec["model"] = json!("exact"),
                "puma560_adaptive" => {
                    spec["control"]["law"] = json!("adaptive");
                    // A tool of up to 1 kg.
                    let tool = json!({ "joint": "joint6", "mass": [0.09, 1.09] });
                    spec["control"]["uncertainty"] = json!({ "links": [tool] });
                }
                _ => {}
            }
        });
        let generation = made.unwrap_or_else(|error| panic!("{name}: {error}"));
        let text = generation.module().unwrap_or_else(|error| panic!("{name}: {error}"));
        write(&folder.join(format!("{name}.rs")), &text);
        c_library::write_files(name, &generation, &text);
    });
    folder
});

/// Writes a file, unless it is there as it should be: then nothing has to be built again.
pub fn write(path: &Path, text: &str) {
    if std::fs::read_to_string(path).is_ok_and(|there| there == text) {
        return;
    }
    std::fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

fn build(prefix: &Path, target: &str, profile: &str) -> Build {
    let rustc = prefix.join("bin/rustc");
    output(cargo(&firmware(), &MADE).env("RUSTC", rustc).args([
        "build",
        "-q",
        "--locked",
        "--target",
        target,
        "--profile",
        profile,
    ]));
    let image = scratch().join("target").join(target).join(profile).join("firmware");
    let cortex = target == CORTEX;
    let results = Results::parse(&output(&mut qemu(prefix, cortex, &image)));
    Build { name: format!("{target} {profile}"), cortex, small: profile == "size", image, results }
}
