//! Tolerances near the size of rounding, of rotations and of numbers.

use std::path::Path;

use gramforge::Generation;

/// Two links whose first twist is 0.005 rad off a right angle, over the whole of their limits.
fn nearly_square(round_angles: f64, torque: f64) -> Result<Generation, String> {
    let link = |alpha: f64| {
        serde_json::json!({
            "joint": "revolute", "alpha": alpha, "a": 0.3, "d": 0, "mass": 1, "com": [0, 0, 0],
            "inertia": { "xx": 0.01, "yy": 0.01, "zz": 0.01 },
            "limits": { "position": [-1, 1], "velocity": 1, "acceleration": 1 }
        })
    };
    let links = [link(1.5758), link(0.0)];
    let spec = serde_json::json!({
        "name": "nearly_square",
        "arm": { "round_angles": round_angles, "dh": { "convention": "standard", "links": links } },
        "measure": "workspace", "model": { "tolerance": { "torque": torque } }
    });
    let loaded = gramforge::load::parse(&spec.to_string(), Path::new("arm.json")).unwrap();
    Generation::new(loaded).map_err(|error| error.to_string())
}

#[test]
fn a_tolerance_that_rounded_rotations_exceed_is_refused() {
    let message = nearly_square(0.01, 0.001).expect_err("12.99 % for 0.1 %");
    assert_eq!(
        gramforge_tests::unplaced(&message),
        "arm.json: arm.round_angles: is 0.01, and rounding rotations by up to this costs 12.99 % of the peak torque of joint1, \
         but `model` allows 0.1 %; write a smaller value, such as 1e-9, or a `model.tolerance.torque` above 0.1299"
    );
    // Both ways out that the message names are open.
    for (round_angles, torque) in [(1e-9, 0.001), (0.01, 0.13)] {
        let generation = nearly_square(round_angles, torque).unwrap_or_else(|message| panic!("{message}"));
        assert!(generation.torque().unwrap().fraction() <= torque);
        assert!(!generation.warnings().iter().any(|text| text.contains("less than rounding")));
    }
}

#[test]
fn a_tolerance_that_rounding_in_f64_exceeds_is_warned_of() {
    let generation = nearly_square(0.0, 1e-13).unwrap_or_else(|message| panic!("{message}"));
    let certified = generation.torque().unwrap().fraction();
    assert!(certified > 1e-13 && certified < 1e-10, "{certified}");
    let said = "model: a torque error of 1.000e-13 of the peak torque is less than rounding in f64 leaves";
    assert!(generation.warnings().iter().any(|text| text.contains(said)), "{:?}", generation.warnings());
}

#[test]
fn there_is_no_share_of_a_torque_that_is_rounding() {
    // An upright axis about which the arm does not move; two sinusoids that cancel to the last digits.
    let link = serde_json::json!({
        "joint": "revolute", "alpha": std::f64::consts::FRAC_PI_2, "a": 0, "d": 0.5, "mass": 5.5, "com": [0, -0.1, 0],
        "inertia": { "xx": 0.2, "yy": 0.01, "zz": 0.2 }
    });
    let wave = |phase: f64| serde_json::json!({ "amplitude": 0.0194, "frequency": 9.1177, "phase": phase });
    let half = std::f64::consts::FRAC_PI_2;
    let spec = serde_json::json!({
        "name": "still", "arm": { "dh": { "convention": "standard", "links": [link] } },
        "motion": { "sinusoids": { "offset": [0], "terms": [[wave(half), wave(-half)]], "duration": 20.0 } },
        "measure": { "tube": { "position_error": 0.05 } }, "model": { "tolerance": { "torque": 0.05 } }
    });
    let loaded = gramforge::load::parse(&spec.to_string(), Path::new("arm.json")).unwrap();
    let generation = Generation::new(loaded).unwrap();
    let torque = generation.torque().unwrap();
    assert!(torque.peak[0] < 1e-12 && torque.error[0] > torque.peak[0], "{torque:?}");
    assert!(torque.fraction().is_infinite());
    let module = generation.module().unwrap();
    assert!(module.contains("a percentage is not available") && !module.contains("more than 100000"));
}
