//! The runtime's sines and cosines keep within the errors that they state.
//!
//! Every f32 and a longer search in f64:
//! `cargo test --release -p gramforge-tests --test emitted -- trig:: --include-ignored --nocapture`

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use gramforge_runtime::trig::{Libm, Polynomial, Table, Trig};
use gramforge_tests::double;
use gramforge_tests::random::Random;
use rayon::prelude::*;

/// The largest error of sine or cosine of `trig` at `x`.
fn error64(trig: &impl Trig<f64>, x: f64) -> f64 {
    let (exact, (sin, cos)) = (double::sin_cos(x), trig.sin_cos(x));
    let (s, c) = (exact.0.off(sin), exact.1.off(cos));
    // max() would drop a NaN.
    if s.is_nan() || c.is_nan() { f64::INFINITY } else { s.max(c) }
}

/// The same in f32, against f64, which is exact enough here.
fn error32(trig: &impl Trig<f32>, x: f32) -> f64 {
    let ((s, c), (sin, cos)) = (Trig::<f64>::sin_cos(&Libm, f64::from(x)), trig.sin_cos(x));
    let (s, c) = ((s - f64::from(sin)).abs(), (c - f64::from(cos)).abs());
    if s.is_nan() || c.is_nan() { f64::INFINITY } else { s.max(c) }
}

/// Largest error over `points`.
fn worst(points: impl ParallelIterator<Item = f64>, error: impl Fn(f64) -> f64 + Sync) -> (f64, f64) {
    points.map(|x| (error(x), x)).reduce(|| (0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

/// `count` angles within ±`most`, half of them within ±π.
fn angles(count: usize, most: f64) -> impl ParallelIterator<Item = f64> {
    (0..count).into_par_iter().map(move |i| {
        let u = Random::new(i as u64).signed();
        u * if i.is_multiple_of(2) { most } else { PI }
    })
}

/// The neighbours of every `stride`-th multiple of π/4 up to `most`: there the argument cancels, or the remainder is
/// as large as it gets.
fn corners(stride: usize, most: f64) -> impl ParallelIterator<Item = f64> {
    let count = (most / FRAC_PI_4) as usize;
    (0..count / stride).into_par_iter().flat_map_iter(move |k| {
        let x = (k * stride) as f64 * FRAC_PI_4;
        [x.next_down().next_down(), x.next_down(), x, x.next_up(), x.next_up().next_up()]
            .into_iter()
            .flat_map(|x| [x, -x])
    })
}

/// The 9 neighbours on either side of x, then coarser ones: uphill in error.
fn climb(error: impl Fn(f64) -> f64, start: (f64, f64)) -> (f64, f64) {
    let mut best = start;
    let mut step = 1e-3 * best.1.abs().max(1e-3);
    while step > 0.25 * f64::EPSILON * best.1.abs() {
        for i in -9..=9 {
            let x = best.1 + step * f64::from(i) / 9.0;
            let there = error(x);
            if there > best.0 {
                best = (there, x);
            }
        }
        step *= 0.5;
    }
    best
}

fn search(count: usize, stride: usize) {
    let (bound, range) = (<Polynomial as Trig<f64>>::ERROR, <Polynomial as Trig<f64>>::RANGE);
    let error = |x| error64(&Polynomial, x);
    let found = [worst(angles(count, range), error), worst(corners(stride, range), error)];
    let found = found
        .map(|start| climb(error, start))
        .into_iter()
        .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let edge = worst([range, -range, range.next_down()].into_par_iter(), error);
    println!(
        "f64: {:.4e} at {:?}, at the ends of the range {:.4e}; stated {bound:e}",
        found.0, found.1, edge.0
    );
    assert!(found.0 <= bound && edge.0 <= bound, "{found:?} {edge:?}");
    assert!(found.0 > 0.7 * bound, "the bound is far too large: {found:?}");
}

#[test]
fn polynomial_in_f64() {
    search(60_000, 101);
}

#[test]
#[ignore = "a minute; see the command above"]
fn polynomial_in_f64_at_length() {
    search(20_000_000, 1);
}

/// The largest error over all f32 with bits in `bits`, of both signs; the mirrored one must be the mirror image.
fn every_f32(bits: impl ParallelIterator<Item = u32>) -> (f64, f64) {
    bits.map(|bits| {
        let x = f32::from_bits(bits);
        let ((s, c), (t, d)) = (Polynomial.sin_cos(x), Polynomial.sin_cos(-x));
        // A sine of 0 has the sign that the arithmetic gives it.
        assert!(s == -t && c == d, "{x:?} and its negative");
        (error32(&Polynomial, x), f64::from(x))
    })
    .reduce(|| (0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

fn f32s_in_range(stride: usize) {
    let (bound, range) = (<Polynomial as Trig<f32>>::ERROR, <Polynomial as Trig<f32>>::RANGE as f32);
    let last = range.to_bits() as usize;
    let (found, x) = every_f32((0..last / stride + 1).into_par_iter().map(|i| (last - i * stride) as u32));
    println!("f32: one in {stride} of {} numbers: {found:.4e} at {x:?}; stated {bound:e}", 2 * (last + 1));
    assert!(found <= bound && found > 0.85 * bound);
}

#[test]
fn polynomial_in_f32() {
    f32s_in_range(4001);
}

#[test]
#[ignore = "minutes; see the command above"]
fn polynomial_in_every_f32() {
    f32s_in_range(1);
}

#[test]
fn libm_keeps_what_it_states() {
    let found = worst(angles(60_000, 1e6), |x| error64(&Libm, x));
    println!("libm, f64: {:.4e} at {:?}", found.0, found.1);
    assert!(found.0 <= <Libm as Trig<f64>>::ERROR);
    let found = worst(angles(60_000, 1e4), |x| error32(&Libm, x as f32));
    assert!(found.0 <= <Libm as Trig<f32>>::ERROR);
}

/// The pair of node `k` of `n`, from the angle in the first turn that rounds least.
fn pair(k: usize, n: usize) -> (f64, f64) {
    let signed = if k > n / 2 { k as f64 - n as f64 } else { k as f64 };
    let (sin, cos) = double::sin_cos(TAU * signed / n as f64);
    (sin.0, cos.0)
}

fn table<const N: usize>() {
    let table = Table::<f64, N>::new(std::array::from_fn(|k| pair(k, N)));
    let single = Table::<f32, N>::new(std::array::from_fn(|k| {
        let (sin, cos) = pair(k, N);
        (sin as f32, cos as f32)
    }));
    let (bound, range) = (<Table<f64, N> as Trig<f64>>::ERROR, <Table<f64, N> as Trig<f64>>::RANGE);
    let (bound32, range32) = (<Table<f32, N> as Trig<f32>>::ERROR, <Table<f32, N> as Trig<f32>>::RANGE);
    let middles = |most: f64| {
        (0..4000).into_par_iter().flat_map_iter(move |i| {
            let step = TAU / N as f64;
            let x = ((f64::from(i) / 4000.0 * most / step).floor() + 0.5) * step;
            [x - step, x.next_down() - step, x.next_up() - step]
        })
    };
    let error = |x: f64| error64(&table, x);
    let found = worst(angles(10_000, range), error).0.max(worst(middles(range), error).0);
    let error = |x: f64| error32(&single, x as f32);
    let found32 = worst(angles(10_000, range32), error).0.max(worst(middles(range32), error).0);
    println!("{N:5} pairs: f64 {found:.3e} of {bound:.3e}, f32 {found32:.3e} of {bound32:.3e}");
    assert!(found <= bound && found32 <= bound32);
    // Not far too large; what rounding adds counts with its worst.
    let interpolation = (PI / N as f64).powi(3) / 6.0;
    assert!(found > 0.9 * interpolation && found32 > 0.9 * interpolation);
    let end = 2.0 * range;
    assert!(table.sin_cos(end).0.is_nan() && single.sin_cos(f32::INFINITY).1.is_nan());
}

#[test]
fn tables() {
    table::<8>();
    table::<32>();
    table::<256>();
    table::<1024>();
    table::<4096>();
}

#[test]
fn beyond_the_range_there_are_no_numbers() {
    for x in [2e6, -2e6, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let (sin, cos) = Polynomial.sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan(), "{x}");
    }
    for x in [6500.0, -6500.0, 1e30, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        let (sin, cos) = Polynomial.sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan(), "{x}");
    }
}

/// Bits that no machine may change.
#[test]
fn the_same_bits_everywhere() {
    let mut sum = 0_u64;
    for i in 0..10_000 {
        let (sin, cos) = Trig::<f64>::sin_cos(&Polynomial, Random::new(i).signed() * 1e3);
        sum = sum.wrapping_mul(31).wrapping_add(sin.to_bits()).wrapping_mul(31).wrapping_add(cos.to_bits());
        let (sin, cos) = Trig::<f32>::sin_cos(&Polynomial, Random::new(i).signed() as f32 * 1e3);
        sum = sum.wrapping_mul(31).wrapping_add(u64::from(sin.to_bits())).wrapping_mul(31);
        sum = sum.wrapping_add(u64::from(cos.to_bits()));
    }
    assert_eq!(sum, 0x91ae_1c80_e3c1_fe5b, "{sum:#x}");
}
