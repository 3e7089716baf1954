//! The same random numbers on every machine.

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// `n` numbers, each uniform in [−most, most).
    pub fn vector(&mut self, n: usize, most: f64) -> Vec<f64> {
        (0..n).map(|_| most * self.signed()).collect()
    }

    /// `N` numbers, each uniform in [−most, most).
    pub fn array<const N: usize>(&mut self, most: f64) -> [f64; N] {
        std::array::from_fn(|_| most * self.signed())
    }
}
