//! The loops in the frameworks RTIC and Embassy.

use crate::built::{CORTEX, MADE};
use crate::toolchain::{cargo, firmware, output, prefix, qemu, scratch};

/// Each example ends without an error only after 500 ticks of the timer with a finite torque each.
#[test]
fn the_loops_in_rtic_and_in_embassy_build_and_tick() {
    let Some(prefix) = prefix() else { return };
    for name in ["rtic", "embassy"] {
        let mut cargo = cargo(&firmware().join(name), &MADE);
        // A folder of its own: cargo would wait for the program's.
        cargo.env("RUSTC", prefix.join("bin/rustc")).env("CARGO_TARGET_DIR", scratch().join("examples"));
        output(cargo.args(["build", "-q", "--locked", "--release", "--target", CORTEX]));
        let image = scratch().join("examples").join(CORTEX).join("release").join(format!("gramforge-{name}"));
        output(&mut qemu(&prefix, true, &image));
    }
}
