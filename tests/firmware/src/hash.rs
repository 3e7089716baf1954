//! A hash of bits.

/// FNV-1a in 64 bits, over the bits of numbers: two runs with the same hash gave the same numbers.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Takes in one number.
    pub fn number(&mut self, x: f32) {
        for byte in x.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }

    /// Takes in a vector.
    pub fn vector<const N: usize>(&mut self, x: &[f32; N]) {
        for &x in x {
            self.number(x);
        }
    }

    /// The hash of everything so far.
    pub fn value(self) -> u64 {
        self.0
    }
}
