//! A planar arm with two revolute joints, in closed form: the model of the tests.

use crate::{Bounds, Model, Real};

/// Five base parameters of the arm, gravity along −y, and its viscous friction.
///
/// D = [a + 2b cos q2, c + b cos q2; ·, c], G = [g1 cos q1 + g2 cos(q1+q2), g2 cos(q1+q2)].
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoLink<T> {
    pub(crate) inertia: [T; 3],
    pub(crate) weight: [T; 2],
    pub(crate) friction: [T; 2],
    pub(crate) bounds: Bounds<T, 2>,
}

impl TwoLink<f64> {
    pub(crate) const EXAMPLE: Self =
        Self { inertia: [1.7, 0.4, 0.3], weight: [12.0, 4.0], friction: [0.2, 0.1], bounds: Bounds::ZERO };

    /// A wrong model of [`TwoLink::EXAMPLE`], with bounds that cover the difference everywhere and nothing more.
    pub(crate) fn perturbed() -> Self {
        let [a, b, c] = [0.15, 0.05, 0.03];
        let [g1, g2] = [1.0, 0.5];
        let [f1, f2] = [0.05, 0.02];
        let mut h = [[[0.0; 2]; 2]; 2];
        h[0] = [[0.0, b], [b, b]];
        h[1] = [[b, 0.0], [0.0, 0.0]];
        Self {
            inertia: [1.7 - a, 0.4 - b, 0.3 + c],
            weight: [12.0 - g1, 4.0 + g2],
            friction: [0.2 - f1, 0.1 + f2],
            bounds: Bounds { d: [[a + 2.0 * b, c + b], [c + b, c]], h, b: [f1, f2], g: [g1 + g2, g2] },
        }
    }

    pub(crate) fn frictionless(self) -> Self {
        Self { friction: [0.0; 2], ..self }
    }

    pub(crate) fn to_f32(self) -> TwoLink<f32> {
        TwoLink {
            inertia: self.inertia.map(|x| x as f32),
            weight: self.weight.map(|x| x as f32),
            friction: self.friction.map(|x| x as f32),
            bounds: Bounds::ZERO,
        }
    }
}

impl<T: Real> TwoLink<T> {
    pub(crate) fn closed_mass_matrix(&self, q: &[T; 2]) -> [[T; 2]; 2] {
        let ([a, b, c], cos) = (self.inertia, q[1].sin_cos().1);
        [[a + b * cos + b * cos, c + b * cos], [c + b * cos, c]]
    }

    pub(crate) fn closed_coriolis(&self, q: &[T; 2], qd: &[T; 2]) -> [[T; 2]; 2] {
        let h = -self.inertia[1] * q[1].sin_cos().0;
        [[h * qd[1], h * (qd[0] + qd[1])], [-(h * qd[0]), T::ZERO]]
    }

    pub(crate) fn closed_gravity(&self, q: &[T; 2]) -> [T; 2] {
        let outer = self.weight[1] * (q[0] + q[1]).sin_cos().1;
        [self.weight[0] * q[0].sin_cos().1 + outer, outer]
    }

    /// Kinetic and potential energy, J.
    pub(crate) fn energy(&self, q: &[T; 2], qd: &[T; 2]) -> T {
        let d = self.closed_mass_matrix(q);
        let twice_kinetic =
            d[0][0] * qd[0] * qd[0] + d[0][1] * qd[0] * qd[1] * T::from_f64(2.0) + d[1][1] * qd[1] * qd[1];
        twice_kinetic * T::from_f64(0.5)
            + self.weight[0] * q[0].sin_cos().0
            + self.weight[1] * (q[0] + q[1]).sin_cos().0
    }
}

impl<T: Real> Model<2> for TwoLink<T> {
    type Scalar = T;

    // Written out by hand rather than through the closed matrices, so that comparing the two proves something.
    fn passivity_torque(&self, q: &[T; 2], qd: &[T; 2], v_r: &[T; 2], a_r: &[T; 2]) -> [T; 2] {
        let [a, b, c] = self.inertia;
        let (s2, c2) = q[1].sin_cos();
        let (c1, c12) = (q[0].sin_cos().1, (q[0] + q[1]).sin_cos().1);
        let two = T::from_f64(2.0);
        [
            a * a_r[0] + c * a_r[1] + b * c2 * (two * a_r[0] + a_r[1])
                - b * s2 * (qd[1] * v_r[0] + qd[0] * v_r[1] + qd[1] * v_r[1])
                + self.weight[0] * c1
                + self.weight[1] * c12,
            c * (a_r[0] + a_r[1]) + b * c2 * a_r[0] + b * s2 * qd[0] * v_r[0] + self.weight[1] * c12,
        ]
    }

    fn viscous_friction(&self) -> [T; 2] {
        self.friction
    }

    fn bounds(&self) -> &Bounds<T, 2> {
        &self.bounds
    }
}
