//! Random states, the same on every machine.

use gramforge_runtime::Desired;

/// A generator of random numbers: the linear congruential one of Knuth's MMIX.
#[derive(Clone, Copy, Debug)]
pub struct Random(u64);

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 24 random bits: as many as f32 holds.
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as u32
    }

    /// Within [−1, 1], exact in f32.
    pub fn symmetric(&mut self) -> f32 {
        (self.bits() as f32 - 8_388_608.0) * (1.0 / 8_388_608.0)
    }

    /// Below `limit`.
    pub fn below(&mut self, limit: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(limit)) >> 24) as u32
    }

    /// A measured position and velocity: off the desired one by up to `position`, rad or m, and 1 rad/s or m/s.
    pub fn about<const N: usize>(
        &mut self,
        desired: &Desired<f32, N>,
        position: f32,
    ) -> ([f32; N], [f32; N]) {
        let (mut q, mut qd) = (desired.q, desired.qd);
        for (q, qd) in q.iter_mut().zip(&mut qd) {
            *q += self.symmetric() * position;
            *qd += self.symmetric();
        }
        (q, qd)
    }
}
