//! The domain of a certificate as a box, and states in it.

use gramforge::Generation;
use gramforge::internals::domain::Domain;

/// Position errors and time, or positions.
pub struct Space<'a> {
    generation: &'a Generation,
    /// Smallest and largest value of each variable.
    pub sides: Vec<[f64; 2]>,
}

impl<'a> Space<'a> {
    /// The domain for which `generation` was made.
    pub fn new(generation: &'a Generation) -> Self {
        let mut sides: Vec<[f64; 2]> = match generation.domain() {
            Domain::Workspace(limits) => limits.clone(),
            Domain::Tube(_, errors) => errors.iter().map(|e| [-e, *e]).collect(),
            Domain::Path(_) => vec![[0.0; 2]; generation.arm().dof()],
        };
        if let (Some(motion), false) =
            (&generation.motion(), matches!(generation.domain(), Domain::Workspace(_)))
        {
            sides.push([0.0, motion.duration()]);
        }
        Self { generation, sides }
    }

    /// The position at the variables `x`.
    pub fn position(&self, x: &[f64]) -> Vec<f64> {
        match (&self.generation.motion(), x.get(self.generation.arm().dof())) {
            (Some(motion), Some(&t)) => motion.at(t).q.iter().zip(x).map(|(q, e)| q + e).collect(),
            _ => x.to_vec(),
        }
    }

    /// Random point number `index`; every third one in a corner of the box of positions.
    pub fn point(&self, index: usize) -> Vec<f64> {
        let n = self.generation.arm().dof();
        let at = |(i, [low, high]): (usize, &[f64; 2])| {
            let u = uniform(index * 16 + i);
            low + (high - low) * if index.is_multiple_of(3) && i < n { u.round() } else { u }
        };
        self.sides.iter().enumerate().map(at).collect()
    }

    /// Whether the position `q` of instant `time` lies in the domain. A joint on which a coefficient does not depend
    /// may stand anywhere, also at 0.
    pub fn contains(&self, q: &[f64], time: Option<f64>) -> bool {
        let centre = match (&self.generation.motion(), time) {
            (Some(motion), Some(t)) => motion.at(t).q,
            _ => vec![0.0; q.len()],
        };
        let inside = |((q, c), [low, high]): ((&f64, &f64), &[f64; 2])| {
            *q == 0.0 || (low - 1e-12..=high + 1e-12).contains(&(q - c))
        };
        q.iter().zip(&centre).zip(&self.sides).all(inside)
    }
}

/// Number `index` of a random sequence in [0, 1): SplitMix64 (Steele, Lea and Flood 2014).
fn uniform(index: usize) -> f64 {
    let mut z = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 53) as f64
}
