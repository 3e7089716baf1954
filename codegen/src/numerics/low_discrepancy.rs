//! Points that fill a box evenly.

/// A sequence that fills the unit cube evenly: multiples of the powers of the root of x^(n+1) = x + 1
/// (Roberts 2018), modulo 1.
pub struct LowDiscrepancy {
    step: Vec<f64>,
}

impl LowDiscrepancy {
    /// The sequence in `n` dimensions.
    pub fn new(n: usize) -> Self {
        let mut root = 2.0_f64;
        for _ in 0..64 {
            let mut power = 1.0;
            for _ in 0..n {
                power *= root;
            }
            // Newton on x·x^n − x − 1.
            root -= (power * root - root - 1.0) / ((n as f64 + 1.0) * power - 1.0);
        }
        let mut step = Vec::with_capacity(n);
        let mut power = 1.0;
        for _ in 0..n {
            power /= root;
            step.push(power);
        }
        Self { step }
    }

    /// Point number `index`, each coordinate in [0, 1).
    pub fn point(&self, index: usize) -> Vec<f64> {
        self.step.iter().map(|step| (0.5 + step * (index as f64 + 1.0)).fract()).collect()
    }
}

/// Corner number `index` of the unit cube in `n` dimensions: bit i says which end of side i.
pub fn corner(index: usize, n: usize) -> Vec<f64> {
    (0..n).map(|i| (index >> i & 1) as f64).collect()
}

/// The point of the box `[low, high]…` that `unit`, with coordinates from 0 to 1, stands for.
pub fn in_box(limits: &[[f64; 2]], unit: &[f64]) -> Vec<f64> {
    limits.iter().zip(unit).map(|([low, high], u)| low + (high - low) * u).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_eighth_of_the_cube_gets_its_share() {
        let spread = LowDiscrepancy::new(3);
        let mut counts = [0; 8];
        for index in 0..800 {
            let point = spread.point(index);
            assert!(point.iter().all(|x| (0.0..1.0).contains(x)));
            counts[(0..3).map(|i| usize::from(point[i] >= 0.5) << i).sum::<usize>()] += 1;
        }
        assert!(counts.iter().all(|count| (90..=110).contains(count)), "{counts:?}");
    }

    #[test]
    fn corners_are_the_ends_of_the_sides() {
        let limits = [[-1.0, 2.0], [3.0, 5.0]];
        let corners: Vec<_> = (0..4).map(|index| in_box(&limits, &corner(index, 2))).collect();
        assert_eq!(corners, [[-1.0, 3.0], [2.0, 3.0], [-1.0, 5.0], [2.0, 5.0]]);
    }
}
