//! The classical Runge–Kutta step.

use core::array::from_fn;

use super::Plant;
use crate::vector::{along, first_not_finite};
use crate::{PlantError, Real};

/// Position and velocity of all joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState<T, const N: usize> {
    /// q, rad or m.
    pub q: [T; N],
    /// q̇, rad/s or m/s.
    pub qd: [T; N],
}

/// The state `dt` seconds later, under a constant torque, N·m: the classical fourth-order Runge–Kutta step, local error
/// of order dt⁵; of order dt² in a step in which dry friction stops a joint ([`Plant::stopped`]).
///
/// # Errors
/// The plant's own, or [`PlantError::Diverged`] when the new state is not finite.
pub fn rk4_step<T: Real, P: Plant<T, N>, const N: usize>(
    plant: &P,
    state: &JointState<T, N>,
    torque: &[T; N],
    dt: T,
) -> Result<JointState<T, N>, PlantError> {
    let JointState { q, qd } = state;
    let half = dt * T::from_f64(0.5);
    let sixth = dt / T::from_f64(6.0);

    let a1 = plant.acceleration(q, qd, torque)?;
    let v2 = along(qd, half, &a1);
    let a2 = plant.acceleration(&along(q, half, qd), &v2, torque)?;
    let v3 = along(qd, half, &a2);
    let a3 = plant.acceleration(&along(q, half, &v2), &v3, torque)?;
    let v4 = along(qd, dt, &a3);
    let a4 = plant.acceleration(&along(q, dt, &v3), &v4, torque)?;

    let twice = |x: T| x + x;
    let velocity: [T; N] = from_fn(|i| qd[i] + twice(v2[i] + v3[i]) + v4[i]);
    let acceleration: [T; N] = from_fn(|i| a1[i] + twice(a2[i] + a3[i]) + a4[i]);
    let next =
        JointState { q: along(q, sixth, &velocity), qd: plant.stopped(qd, along(qd, sixth, &acceleration)) };
    if first_not_finite(&next.q).is_some() || first_not_finite(&next.qd).is_some() {
        return Err(PlantError::Diverged);
    }
    Ok(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::simulate::RigidPlant;
    use crate::test_arm::TwoLink;

    const START: JointState<f64, 2> = JointState { q: [0.3, -0.5], qd: [0.4, -0.2] };

    fn fall(steps: u32, dt: f64) -> JointState<f64, 2> {
        let plant = RigidPlant { model: TwoLink::<f64>::EXAMPLE.frictionless(), coulomb: [[0.0; 2]; 2] };
        (0..steps).fold(START, |state, _| rk4_step(&plant, &state, &[0.0; 2], dt).unwrap())
    }

    #[test]
    fn keeps_the_energy_of_a_free_arm() {
        let arm = TwoLink::<f64>::EXAMPLE.frictionless();
        let end = fall(5000, 1e-3);
        let (before, after) = (arm.energy(&START.q, &START.qd), arm.energy(&end.q, &end.qd));
        assert!((after - before).abs() < 1e-7, "{before} {after}");
        assert!((end.q[0] - START.q[0]).abs() > 0.1, "the arm must have moved");
    }

    #[test]
    fn is_of_fourth_order() {
        let reference = fall(800, 1.25e-3);
        let error = |steps: u32| (fall(steps, 1.0 / f64::from(steps)).q[0] - reference.q[0]).abs();
        let ratio = error(50) / error(100);
        assert!((12.0..22.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn reports_an_overflow() {
        let plant = RigidPlant { model: TwoLink::<f64>::EXAMPLE, coulomb: [[0.0; 2]; 2] };
        let state = JointState { q: [0.0; 2], qd: [1e200, 0.0] };
        assert_eq!(rk4_step(&plant, &state, &[0.0; 2], 1e-3), Err(PlantError::Diverged));
    }

    #[test]
    fn dry_friction_holds_a_joint_at_any_step() {
        let arm = TwoLink::<f64>::EXAMPLE.frictionless();
        let plant = RigidPlant { model: arm, coulomb: [[2.0, -2.0], [1.0, -1.0]] };
        let torque = arm.gravity(&START.q);
        // Both joints run out, and what gravity has changed by then is less than the friction.
        let rest = |dt: f64| {
            let mut state = START;
            for _ in 0..(2.0 / dt) as usize {
                state = rk4_step(&plant, &state, &torque, dt).unwrap();
            }
            assert_eq!(state.qd, [0.0; 2], "{dt}");
            state.q
        };
        let fine = rest(1e-4);
        for dt in [1e-2, 1e-3] {
            let coarse = rest(dt);
            assert!((0..2).all(|i| (coarse[i] - fine[i]).abs() < 0.5 * dt), "{coarse:?} {fine:?}");
        }
    }
}
