//! What a generated module implements.

use crate::Real;

/// A dynamic model D̂(q) q̈ + Ĉ(q, q̇) q̇ + Ĝ(q) + B̂ q̇ = τ of an arm with `N` joints, with bounds on what it leaves out.
///
/// Ĉ is the Christoffel form of equation (1); positions in rad (m for prismatic joints), torques in N·m (N).
pub trait Model<const N: usize> {
    /// Number type.
    type Scalar: Real;

    /// The passivity torque D̂(q) a_r + Ĉ(q, q̇) v_r + Ĝ(q), without friction.
    fn passivity_torque(
        &self,
        q: &[Self::Scalar; N],
        qd: &[Self::Scalar; N],
        v_r: &[Self::Scalar; N],
        a_r: &[Self::Scalar; N],
    ) -> [Self::Scalar; N];

    /// Diagonal of B̂, viscous friction, N·m·s/rad.
    fn viscous_friction(&self) -> [Self::Scalar; N];

    /// Bounds on |D − D̂|, |h − ĥ|, |B − B̂|, |G − Ĝ| inside the domain the module states.
    fn bounds(&self) -> &Bounds<Self::Scalar, N>;
}

/// Element-by-element bounds on what a model leaves out, equations (26)–(32).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<T, const N: usize> {
    /// ΔD, kg·m².
    pub d: [[T; N]; N],
    /// Δh_ijk, kg·m².
    pub h: [[[T; N]; N]; N],
    /// ΔB of the diagonal viscous friction, N·m·s/rad.
    pub b: [T; N],
    /// ΔG, N·m.
    pub g: [T; N],
}
