//! The quantities in which every law is written.

use super::Sample;
use crate::Real;
use crate::vector::{add, mat_vec, sub};

/// Tracking errors and reference motion of one instant, section 3 of the report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracking<T, const N: usize> {
    /// q_e = q − q_d, rad or m.
    pub q_e: [T; N],
    /// q̇_e = q̇ − q̇_d, rad/s or m/s.
    pub qd_e: [T; N],
    /// s = q̇_e + P12 q_e, rad/s or m/s.
    pub s: [T; N],
    /// v_r = q̇_d − P12 q_e = q̇ − s, rad/s or m/s.
    pub v_r: [T; N],
    /// a_r = q̈_d − P12 q̇_e, rad/s² or m/s².
    pub a_r: [T; N],
}

impl<T: Real, const N: usize> Tracking<T, N> {
    /// From a sample and P12, 1/s, by rows.
    pub fn new(p12: &[[T; N]; N], sample: &Sample<T, N>) -> Self {
        let desired = &sample.desired;
        let q_e = sub(&sample.q, &desired.q);
        let qd_e = sub(&sample.qd, &desired.qd);
        let pulled = mat_vec(p12, &q_e);
        Self {
            q_e,
            qd_e,
            s: add(&qd_e, &pulled),
            v_r: sub(&desired.qd, &pulled),
            a_r: sub(&desired.qdd, &mat_vec(p12, &qd_e)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Desired;

    #[test]
    fn follows_the_definitions() {
        let sample = Sample {
            q: [1.0, 2.0],
            qd: [0.5, -1.0],
            desired: Desired { q: [0.75, 2.5], qd: [0.25, 0.0], qdd: [3.0, 4.0] },
            period: 0.01,
        };
        let tracking = Tracking::new(&[[2.0, 1.0], [1.0, 4.0]], &sample);
        let expected = Tracking {
            q_e: [0.25, -0.5],
            qd_e: [0.25, -1.0],
            s: [0.25, -2.75],
            v_r: [0.25, 1.75],
            a_r: [3.5, 7.75],
        };
        assert_eq!(tracking, expected);
    }
}
