//! Generated modules in single precision on a Cortex-M4F and a RISC-V core, in QEMU: the bits are the host's, the counts
//! are within their limits, no input makes them panic.
//!
//! `tests/firmware` is the program; `tests/firmware/setup` makes the toolchain. Without that these tests do nothing.

mod built;
mod c_library;
mod counts;
mod elf;
mod examples;
mod results;
mod toolchain;

use std::collections::BTreeMap;

use built::{Build, builds, host};

/// What only the bare cores print.
const COUNTS: [&str; 5] = ["instructions_worst", "instructions_mean", "stack", "start", "pair_worst"];

#[test]
fn every_number_is_the_hosts_bit_for_bit() {
    let Some(builds) = builds() else { return };
    let host = host();
    // The torques of 1000 states of each module, and of each step of the loops of 5 s.
    assert_eq!(host.values("torques").len(), 9);
    assert_eq!(host.values("loop_torques").len(), 2);
    for Build { name, results, .. } in builds {
        let same: BTreeMap<_, _> =
            results.0.iter().filter(|((_, key), _)| !COUNTS.contains(&key.as_str())).collect();
        assert_eq!(same, host.0.iter().collect(), "{name} and the host");
    }
}

#[test]
fn no_input_leads_to_anything_but_a_documented_fault_or_a_torque_within_the_limits() {
    let Some(builds) = builds() else { return };
    for results in builds.iter().map(|build| &build.results).chain([host()]) {
        for key in ["steps_with_fault", "not_finite_and_wrong", "outside_and_wrong", "far_and_wrong"] {
            for (module, wrong) in results.values(key) {
                assert_eq!(wrong, 0, "{module}: {key}");
            }
        }
        for (module, saturated) in results.values("far_and_saturated") {
            // The arm of three joints has no torque limits.
            assert_eq!(saturated > 0, !module.starts_with("arm3"), "{module}: {saturated}");
        }
    }
}

#[test]
fn the_loop_outlasts_short_failures_and_stops_at_long_ones() {
    let Some(builds) = builds() else { return };
    for results in builds.iter().map(|build| &build.results).chain([host()]) {
        let outcome = |key: &str, module: &str| {
            assert_eq!(results.value(module, &format!("{key}_astray")), 0, "{key}, {module}");
            ["steps", "missed", "faults", "stopped", "fed"]
                .map(|what| results.value(module, &format!("{key}_{what}")))
        };
        for module in ["arm3_robust", "puma560_one_percent"] {
            assert_eq!(outcome("loop", module), [5000, 0, 0, 0, 5000]);
            let end = f32::from_bits(results.value(module, "loop_end_off") as u32);
            assert!(end < 1e-3, "{module} ends {end} rad off");
            // The last step is taken, but the watchdog is not fed any more.
            assert_eq!(outcome("missed_6", module), [101, 6, 0, 1, 100]);
            assert_eq!(outcome("blind_3", module), [500, 0, 3, 0, 500]);
        }
        assert_eq!(outcome("blind_4", "arm3_robust"), [104, 0, 4, 1, 103]);
        assert_eq!(outcome("missed_5", "arm3_robust"), [495, 5, 0, 0, 495]);
    }
}
