//! Finds the generated modules and the memory map of the board.

use std::env;

fn main() {
    println!("cargo:rerun-if-env-changed=GRAMFORGE_MODULES");
    let modules = env::var("GRAMFORGE_MODULES").unwrap_or_else(|_| {
        panic!("GRAMFORGE_MODULES is not set: name the folder of the generated modules, as tests/tests/firmware does")
    });
    println!("cargo:rustc-env=MODULES={modules}");
    println!("cargo:rerun-if-changed={modules}");
    let folder = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let script = match env::var("CARGO_CFG_TARGET_ARCH").as_deref() {
        Ok("arm") => "cortex_m.ld",
        Ok("riscv32") => "riscv.ld",
        _ => return,
    };
    println!("cargo:rerun-if-changed={script}");
    println!("cargo:rustc-link-arg-bins=-T{folder}/{script}");
}
