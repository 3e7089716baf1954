//! The nearest multiple of a step, and what the angle is beyond it.

/// Argument reduction in two parts after Cody and Waite.
pub(super) trait Reduction: Sized {
    /// Integers up to this one may be taken.
    const MOST: u32;

    /// For the step h = `quarters`·π/2 with `quarters` a power of two, the integer k nearest to x/h in two's
    /// complement, and x − k h; `None` where |k| would exceed [`MOST`](Self::MOST), and for NaN.
    fn reduce(self, quarters: Self) -> Option<(usize, Self)>;
}

macro_rules! reduction {
    ($t:ident, most $most:literal, integer $integer:literal, quarter $first:literal + $second:literal) => {
        impl Reduction for $t {
            const MOST: u32 = $most;

            #[inline(always)]
            fn reduce(self, quarters: Self) -> Option<(usize, Self)> {
                // Adding 1.5·2⁵² (1.5·2²³) rounds to an integer, and leaves it in the lowest bits.
                let shifted = self * (core::$t::consts::FRAC_2_PI / quarters) + $integer;
                let bits = shifted.to_bits();
                let most = $most;
                if bits.wrapping_sub(<$t>::to_bits($integer) - most) > 2 * most {
                    return None;
                }
                let k = shifted - $integer;
                let rest = (self - k * ($first * quarters)) - k * ($second * quarters);
                Some((bits as usize, rest))
            }
        }
    };
}

// The first part of π/2 has 33 bits in f64 and 12 in f32 (3217/2048), so that its products with every k are exact.
reduction! { f64, most 0x10_0000, integer 6755399441055744.0, quarter 1.5707963267341256 + 6.077100506506192e-11 }
reduction! { f32, most 0x1000, integer 12582912.0, quarter 1.5708008 + -4.454455e-6 }
