//! How the generated code takes sines and cosines, and the same in the generator: equal bits, known error.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::fmt;
use std::sync::Arc;

use gramforge_runtime::Real;
use gramforge_runtime::trig::{self as runtime, Libm, Polynomial, Table};

use crate::spec::{EmitSpec, ScalarSpec, TrigSpec};

/// The least error that a table is made for: that of its largest size, rounded up.
pub const FINEST: f64 = 1e-10;
/// The largest: beyond it the smallest table is better than what was asked for by far.
pub const COARSEST: f64 = 0.1;

/// Errors up to this one count as rounding: 4 ulp of a number near 1.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Which implementation of `gramforge_runtime::trig` the code calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `Libm`, by way of `Real`.
    Libm,
    /// `Polynomial`.
    Polynomial,
    /// `Table` with that many pairs.
    Table(usize),
    /// `Std`.
    Std,
}

type Pair<T> = Arc<dyn Fn(T) -> (T, T) + Send + Sync>;

/// One way to take sines and cosines, chosen.
///
/// Holds: [`Trig::sin_cos`] gives the bits of the code that is generated for [`Trig::kind`].
#[derive(Clone)]
pub struct Trig {
    /// Which way.
    pub kind: Kind,
    /// Neither sine nor cosine in f64 is off by more; for `Std` supposed, as for every platform.
    pub error: f64,
    /// The same in f32.
    pub single_error: f64,
    /// Largest |angle|, rad, for which that holds in the number type that the code is written in.
    pub range: f64,
    /// The table's (sin, cos) of 2πk/N in f64; empty without a table.
    pub pairs: Vec<(f64, f64)>,
    single_range: f64,
    double: Pair<f64>,
    single: Pair<f32>,
}

/// A number type in which generated code can be interpreted.
pub trait Angle: Real {
    /// (sin, cos) of `self` in rad.
    fn sin_cos_by(self, sines: &Trig) -> (Self, Self);
    /// `self` · `by` + `added`, rounded once.
    fn mul_add(self, by: Self, added: Self) -> Self;
}

impl Angle for f64 {
    fn sin_cos_by(self, sines: &Trig) -> (Self, Self) {
        (sines.double)(self)
    }

    fn mul_add(self, by: f64, added: f64) -> f64 {
        f64::mul_add(self, by, added)
    }
}

impl Angle for f32 {
    fn sin_cos_by(self, sines: &Trig) -> (Self, Self) {
        (sines.single)(self)
    }

    fn mul_add(self, by: f32, added: f32) -> f32 {
        f32::mul_add(self, by, added)
    }
}

impl Trig {
    /// What `spec` asks for.
    pub fn new(spec: &EmitSpec) -> Self {
        let sines = Self::by(&spec.sines());
        match spec.scalar {
            ScalarSpec::F64 => sines,
            ScalarSpec::F32 => Self { range: sines.single_range, ..sines },
        }
    }

    /// Those of f64 code.
    fn by(spec: &TrigSpec) -> Self {
        match spec {
            TrigSpec::Libm => Self::of(Kind::Libm, Libm, Libm),
            TrigSpec::Polynomial => Self::of(Kind::Polynomial, Polynomial, Polynomial),
            TrigSpec::Std => {
                let mut sines = Self::of(Kind::Std, Libm, Libm);
                sines.double = Arc::new(f64::sin_cos);
                sines.single = Arc::new(f32::sin_cos);
                sines
            }
            TrigSpec::Table { error } => Self::table(*error),
        }
    }

    /// The smallest table with at most that error; the largest there is where none has.
    fn table(error: f64) -> Self {
        macro_rules! smallest {
            ($($n:literal)*) => {
                $(if <Table<f64, $n> as runtime::Trig<f64>>::ERROR <= error {
                    return Self::tabulated::<$n>();
                })*
            };
        }
        smallest!(8 16 32 64 128 256 512 1024 2048);
        Self::tabulated::<4096>()
    }

    fn tabulated<const N: usize>() -> Self {
        let pairs: [(f64, f64); N] = std::array::from_fn(|k| node(k, N));
        let single = pairs.map(|(sin, cos)| (sin as f32, cos as f32));
        let sines = Self::of(Kind::Table(N), Table::new(pairs), Table::new(single));
        Self { pairs: pairs.to_vec(), ..sines }
    }

    fn of<D, S>(kind: Kind, double: D, single: S) -> Self
    where
        D: runtime::Trig<f64> + Send + Sync + 'static,
        S: runtime::Trig<f32> + Send + Sync + 'static,
    {
        Self {
            kind,
            error: D::ERROR,
            single_error: S::ERROR,
            range: D::RANGE,
            single_range: S::RANGE,
            pairs: Vec::new(),
            double: Arc::new(move |x| double.sin_cos(x)),
            single: Arc::new(move |x| single.sin_cos(x)),
        }
    }

    /// A way of one's own to take sines, with an error that is taken on trust; for experiments, as no code can be
    /// generated for it but that of `kind`.
    pub fn own(kind: Kind, error: f64, pair: impl Fn(f64) -> (f64, f64) + Send + Sync + 'static) -> Self {
        let mut sines = Self::of(kind, Libm, Libm);
        sines.error = error;
        sines.double = Arc::new(pair);
        sines
    }

    /// (sin x, cos x), x in rad, with the bits of the generated code.
    pub fn sin_cos<T: Angle>(&self, x: T) -> (T, T) {
        x.sin_cos_by(self)
    }

    /// The part of the error that is not counted among the roundings of an evaluation: these allow for 1 ulp.
    pub fn beyond_ulp(&self) -> f64 {
        match self.kind {
            Kind::Libm | Kind::Std => 0.0,
            Kind::Polynomial | Kind::Table(_) => self.error,
        }
    }

    /// True where the error is no more than rounding, so that code without simplified coefficients counts as exact.
    pub fn rounds(&self) -> bool {
        self.error <= ROUNDING
    }
}

impl Default for Trig {
    fn default() -> Self {
        Self::by(&TrigSpec::Libm)
    }
}

impl fmt::Debug for Trig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sines").field("kind", &self.kind).field("error", &self.error).finish_non_exhaustive()
    }
}

/// The same kind takes the same sines.
impl PartialEq for Trig {
    fn eq(&self, other: &Self) -> bool {
        (self.kind, self.error) == (other.kind, other.error)
    }
}

/// (sin 2πk/n, cos 2πk/n), n a multiple of 8, within 2u: from an angle of at most π/4, so that symmetric entries are
/// equal and the quarters of the turn exact.
fn node(k: usize, n: usize) -> (f64, f64) {
    let (quadrant, within) = (k / (n / 4), k % (n / 4));
    let mirrored = within > n / 8;
    let step = if mirrored { n / 4 - within } else { within };
    // Rounded angles are not symmetric about an eighth of a turn; 1/√2 is.
    let (s, c) = match 8 * step == n {
        true => (FRAC_1_SQRT_2, FRAC_1_SQRT_2),
        false => libm::sincos(2.0 * PI * step as f64 / n as f64),
    };
    let (s, c) = if mirrored { (c, s) } else { (s, c) };
    // + 0.0: no entry is −0.
    let (sin, cos) = match quadrant % 4 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    };
    (sin + 0.0, cos + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_sufficient_table_is_taken() {
        for (error, size) in [(0.1, 8), (2e-3, 16), (1e-3, 32), (1e-6, 256), (FINEST, 4096)] {
            let sines = Trig::by(&TrigSpec::Table { error });
            assert_eq!(sines.kind, Kind::Table(size));
            assert!(sines.error <= error && sines.pairs.len() == size);
        }
    }

    #[test]
    fn table_entries_are_symmetric_and_near() {
        for n in [8, 64, 4096] {
            for k in 0..n {
                let (s, c) = node(k, n);
                let angle = 2.0 * PI * k as f64 / n as f64;
                assert!((s - angle.sin()).abs() < 2e-15 && (c - angle.cos()).abs() < 2e-15);
                let (t, d) = node((n - k) % n, n);
                assert_eq!((s, c), (-t, d));
            }
            assert_eq!([node(0, n), node(n / 4, n)], [(0.0, 1.0), (1.0, 0.0)]);
        }
    }
}
