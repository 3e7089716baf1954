//! How (34) outweighs the Coriolis torque of s itself.

/// The two variants of the report; δC v_r = δC q̇ − δC s, and the bracket of (34) covers only δC q̇.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoriolisTerm<T, const N: usize> {
    /// −ΔC1 s, with ΔC1 by rows, N·m·s/rad: symmetric, and ΔC1 + sym(δC) positive semidefinite for every |δC| ≤ ΔC,
    /// which k·I is for every k ≥ λ_max(sym ΔC).
    Matrix([[T; N]; N]),
    /// −diag(sgn s) ΔC|s|, added to the bracket.
    Switching,
}
