//! Where compiler and emulator for bare cores are, as `tests/firmware/setup` has put them.

use std::env;
use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Once;

/// The toolchain's folder; `None` where there is none, which is said once.
///
/// Whoever sets `GRAMFORGE_BARE_METAL` wants the tests to run: a missing toolchain is then a failure.
pub fn prefix() -> Option<PathBuf> {
    static SAID: Once = Once::new();
    let asked = env::var_os("GRAMFORGE_BARE_METAL");
    let home = env::var_os("HOME").map(|home| PathBuf::from(home).join(".cache/gramforge-bare-metal"));
    let prefix = asked.clone().map(PathBuf::from).or(home)?;
    // An old one has no compiler for C.
    if ["complete", "bin/arm-none-eabi-gcc"].iter().all(|file| prefix.join(file).exists()) {
        return Some(prefix);
    }
    assert!(
        asked.is_none(),
        "GRAMFORGE_BARE_METAL names {}, where no toolchain is, or an old one: run tests/firmware/setup",
        prefix.display()
    );
    // Past the capture of the test harness, which shows nothing of a test that passes.
    SAID.call_once(|| {
        let _ = writeln!(
            stderr(),
            "skipped: no toolchain for bare cores in {}, or an old one; tests/firmware/setup makes it",
            prefix.display()
        );
    });
    None
}

/// The folder of the program, those of the examples among its parts.
pub fn firmware() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("firmware")
}

/// The folder of everything that these tests make.
pub fn scratch() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware")
}

/// Cargo in a program's folder, free of what the outer one was told.
pub fn cargo(folder: &Path, modules: &Path) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .current_dir(folder)
        .env("GRAMFORGE_MODULES", modules)
        .env("CARGO_TARGET_DIR", scratch().join("target"));
    for name in [
        "RUSTC",
        "RUSTFLAGS",
        "CARGO_ENCODED_RUSTFLAGS",
        "CARGO_BUILD_TARGET",
        "RUSTC_WRAPPER",
        "RUSTC_WORKSPACE_WRAPPER",
    ] {
        cargo.env_remove(name);
    }
    cargo
}

/// What a command prints; it must succeed.
pub fn output(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{out}\n{err}", output.status);
    out.into_owned()
}

/// QEMU with an image on a Cortex-M4F or else on a RISC-V core. One instruction is 64 ns of virtual time, which does not
/// wait for real time.
pub fn qemu(prefix: &Path, cortex: bool, image: &Path) -> Command {
    let mut qemu =
        Command::new(prefix.join(if cortex { "bin/qemu-system-arm" } else { "bin/qemu-system-riscv32" }));
    if cortex {
        qemu.args(["-M", "mps2-an386", "-serial", "none", "-semihosting-config", "enable=on,target=native"]);
    } else {
        qemu.args(["-M", "virt", "-bios", "none", "-serial", "stdio"]);
    }
    qemu.args(["-nographic", "-monitor", "none", "-icount", "shift=6,sleep=off,align=off", "-kernel"])
        .arg(image);
    qemu
}
