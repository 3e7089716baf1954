//! A generated module that takes the sines of the platform.
//!
//! `.ci/run` generates the module from `arm3_std.json` and gives its path as `ARM3_STD`.

/// The module; a warning in it is an error.
#[deny(warnings)]
#[rustfmt::skip]
pub mod arm3_std {
    include!(env!("ARM3_STD"));
}

#[cfg(test)]
mod tests {
    use gramforge_generated::arm3_xi2::Arm3Xi2;
    use gramforge_runtime::Model;
    use gramforge_runtime::reference::Reference;

    use crate::arm3_std::{self, Arm3Std};

    /// The same arm and model with the sines of `libm`: the two sines differ by rounding alone.
    #[test]
    fn the_torque_is_that_of_the_module_with_libm() {
        for k in 0..1000 {
            let x = |joint: u32| 3.0 * f64::from((k * 7919 + joint * 104_729) % 2003) / 1001.5 - 3.0;
            let vector = |from: u32| [x(from), x(from + 1), x(from + 2)];
            let (q, qd, v_r, a_r) = (vector(0), vector(3), vector(6), vector(9));
            let (own, other) = (
                Arm3Std.passivity_torque(&q, &qd, &v_r, &a_r),
                Arm3Xi2.passivity_torque(&q, &qd, &v_r, &a_r),
            );
            for (own, other) in own.iter().zip(&other) {
                assert!((own - other).abs() <= 1e-11, "{own} and {other} N·m at {q:?}");
            }
        }
        let start = arm3_std::REFERENCE.at(0.0);
        assert!(arm3_std::controller().step(&start.q, &start.qd, &start).is_ok());
    }
}
