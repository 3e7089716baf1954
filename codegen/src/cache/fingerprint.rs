//! A fingerprint of the program that runs.

use std::fs;

/// Odd numbers with bits all over: SplitMix64's increment and two of its multipliers.
const MIX: [u64; 3] = [0x9e37_79b9_7f4a_7c15, 0xbf58_476d_1ce4_e5b9, 0x94d0_49bb_1331_11eb];

/// 128 bits of the bytes of the program that runs; `None` where they cannot be read.
///
/// A new generator, other dependencies, features or optimisation make another program. Nobody forges it against himself,
/// so that speed counts more than cryptography: unoptimised, SHA-256 of a build script would take seconds.
pub(super) fn of_program() -> Option<String> {
    let bytes = fs::read(std::env::current_exe().ok()?).ok()?;
    let [a, b] = of(&bytes);
    Some(format!("{a:016x}{b:016x}"))
}

fn of(bytes: &[u8]) -> [u64; 2] {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
    let length = (bytes.len() as u64).to_le_bytes();
    let (mut a, mut b) = (MIX[0], MIX[1]);
    for word in words.iter().chain([&last, &length]) {
        let word = u64::from_le_bytes(*word);
        a = (a ^ word).wrapping_mul(MIX[1]).rotate_left(29);
        b = (b.wrapping_add(word) ^ (b >> 31)).wrapping_mul(MIX[2]);
    }
    [a ^ (b >> 29), b ^ (a >> 32)]
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn every_bit_and_the_length_count() {
        let bytes: Vec<u8> = (0..100_u32).map(|k| (k * k) as u8).collect();
        let mut all = vec![of(&bytes), of(&bytes[..99]), of(&[bytes.as_slice(), &[0]].concat())];
        for bit in 0..800 {
            let mut other = bytes.clone();
            other[bit / 8] ^= 1 << (bit % 8);
            all.push(of(&other));
        }
        for half in 0..2 {
            let mut halves: Vec<u64> = all.iter().map(|hash| hash[half]).collect();
            halves.sort_unstable();
            halves.dedup();
            assert_eq!(halves.len(), all.len());
        }
    }
}
