//! The motion by the number of the control period, for f32 code, and how far that code is from the motion.

mod single;

use gramforge_runtime::reference::{cubic, quintic_shape};

use super::{Motion, Spline};
use crate::numerics::interval::Interval;
use crate::numerics::rounded::{Format, Rounded};
use single::Single;

/// f32 counts to this number.
const COUNTED: f64 = 16_777_216.0;
/// Parts of a motion, or of a piece of it, over each of which rounding is bounded.
const PARTS: u32 = 64;
/// A period that starts this part of a period before a knot starts at the knot.
const SAME: f64 = 1e-9;
/// 2⁶⁴, by which a turn is divided.
const TURN: f64 = 18_446_744_073_709_551_616.0;

/// A motion by the number of the period: what the runtime's `TickReference`s hold, in f64.
#[derive(Clone, Debug, PartialEq)]
pub enum Ticks {
    /// `QuinticTicks`.
    Quintic { from: Vec<f64>, to: Vec<f64>, end: u32, step: f64, rate: f64 },
    /// `SplineTicks`.
    Spline { pieces: Vec<Piece>, end: u32, to: Vec<f64>, period: f64 },
    /// `SinusoidTicks`.
    Sinusoids { offset: Vec<f64>, terms: Vec<Vec<Term>> },
}

/// `SplineTick`.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    pub tick: u32,
    pub late: f64,
    pub coefficients: Vec<[f64; 4]>,
    /// Periods that start in it.
    count: u32,
}

/// `SinusoidTick`.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    pub amplitude: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub phase: u64,
    pub turn: u64,
    /// Bound on what the integers are off by, rad.
    angle_error: f64,
}

/// How far q_d, q̇_d and q̈_d in f32 are from the motion at most, by joint: rad, rad/s and rad/s², or m, m/s and m/s².
pub type ReferenceError = [Vec<f64>; 3];

impl Ticks {
    /// The motion in periods of `period`, s; `None` where it has more periods than f32 can count.
    pub fn new(motion: &Motion, period: f64) -> Option<Self> {
        let first = |time: f64| {
            let ticks = libm::ceil(time / period - SAME).max(0.0);
            (ticks < COUNTED).then_some(ticks as u32)
        };
        Some(match motion {
            Motion::Quintic { from, to, duration } => Self::Quintic {
                from: from.clone(),
                to: to.clone(),
                end: first(*duration)?,
                step: period / duration,
                rate: 1.0 / duration,
            },
            Motion::Spline(spline) => {
                let end = first(spline.duration())?;
                let to = motion.at(spline.duration()).q;
                Self::Spline { pieces: pieces(spline, period, end, first)?, end, to, period }
            }
            Motion::Sinusoids { offset, terms, .. } => {
                let term = |s: &gramforge_runtime::reference::Sinusoid<f64>| term(s, period);
                let terms = terms.iter().map(|terms| terms.iter().map(term).collect()).collect();
                Self::Sinusoids { offset: offset.clone(), terms }
            }
        })
    }

    /// A bound over all periods on how far the f32 code is from the motion.
    pub fn error(&self) -> ReferenceError {
        match self {
            Self::Quintic { from, to, end, step, rate } => {
                let mut error = at_rest(to);
                for part in 0..PARTS {
                    let ticks = part_of(f64::from(*end), part);
                    let x = Single::exact(ticks) * Single::quotient(*step);
                    let (position, velocity, acceleration) = quintic_shape(x, Single::quotient(*rate));
                    for (i, (from, to)) in from.iter().zip(to).enumerate() {
                        let (from, span) =
                            (Single::literal(*from), Single::literal(*to) - Single::literal(*from));
                        raise(&mut error, i, (from + span * position, span * velocity, span * acceleration));
                    }
                }
                error
            }
            Self::Spline { pieces, to, period, .. } => {
                let mut error = at_rest(to);
                for piece in pieces {
                    for part in 0..PARTS {
                        let since = Single::exact(part_of(f64::from(piece.count), part));
                        let dt = Single::quotient(piece.late) + since * Single::quotient(*period);
                        for (i, coefficients) in piece.coefficients.iter().enumerate() {
                            raise(&mut error, i, cubic(&coefficients.map(Single::literal), dt));
                        }
                    }
                }
                error
            }
            Self::Sinusoids { offset, terms } => {
                let mut error = at_rest(offset);
                for (i, (offset, terms)) in offset.iter().zip(terms).enumerate() {
                    let zero = Single::literal(0.0);
                    let sum =
                        terms.iter().fold((Single::literal(*offset), zero, zero), |(q, qd, qdd), term| {
                            let sine = term.sine();
                            let [a, b, c] =
                                [term.amplitude, term.speed, term.acceleration].map(Single::quotient);
                            (q + a * sine, qd + b * sine, qdd - c * sine)
                        });
                    raise(&mut error, i, sum);
                }
                error
            }
        }
    }
}

impl Term {
    /// Any sine or cosine of the angle.
    fn sine(&self) -> Single {
        use gramforge_runtime::trig::{Polynomial, Trig};
        let unit = Format::SINGLE.unit;
        // The integer becomes a number, and that an angle: three roundings of up to π.
        let angle = 3.1 * unit * std::f64::consts::PI + self.angle_error;
        let error = <Polynomial as Trig<f32>>::ERROR + angle;
        Single(Rounded::within(Interval { low: -1.0, high: 1.0 }, error, Format::SINGLE))
    }
}

fn pieces(spline: &Spline, period: f64, end: u32, first: impl Fn(f64) -> Option<u32>) -> Option<Vec<Piece>> {
    let mut out: Vec<Piece> = Vec::new();
    for (start, coefficients) in spline.times.iter().zip(&spline.pieces) {
        let tick = first(*start)?;
        let late = (f64::from(tick) * period - start).max(0.0);
        let piece = Piece { tick, late, coefficients: coefficients.clone(), count: 0 };
        match out.last_mut() {
            // No period starts in the piece before.
            Some(last) if last.tick == tick => *last = piece,
            _ => out.push(piece),
        }
    }
    let ends: Vec<u32> = out.iter().skip(1).map(|piece| piece.tick).chain([end]).collect();
    for (piece, end) in out.iter_mut().zip(ends) {
        piece.count = end.saturating_sub(piece.tick);
    }
    Some(out)
}

fn term(s: &gramforge_runtime::reference::Sinusoid<f64>, period: f64) -> Term {
    // A part of a turn in units of 2⁻⁶⁴, which wrap around.
    let units = |angle: f64| {
        let turns = angle / std::f64::consts::TAU;
        ((turns - libm::floor(turns)) * TURN) as u64
    };
    let (speed, turn) = (s.amplitude * s.frequency, s.frequency * period);
    // Both angles are rounded a few times in f64, the turn as often as there are periods; the code drops half the bits.
    let most = turn.abs() * 4_294_967_296.0 + s.phase.abs() + 1.0;
    Term {
        amplitude: s.amplitude,
        speed,
        acceleration: speed * s.frequency,
        phase: units(s.phase),
        turn: units(turn),
        angle_error: 8.0 * f64::EPSILON * most + 2.0 * std::f64::consts::TAU / 4_294_967_296.0,
    }
}

/// Part `part` of the numbers from 0 to `count`.
fn part_of(count: f64, part: u32) -> Interval {
    let at = |part: u32| count * f64::from(part) / f64::from(PARTS);
    Interval { low: at(part), high: at(part + 1) }
}

/// What a literal position is off by.
fn at_rest(q: &[f64]) -> ReferenceError {
    let n = q.len();
    [q.iter().map(|&q| Single::literal(q).0.error).collect(), vec![0.0; n], vec![0.0; n]]
}

fn raise(error: &mut ReferenceError, joint: usize, (q, qd, qdd): (Single, Single, Single)) {
    for (error, number) in error.iter_mut().zip([q, qd, qdd]) {
        error[joint] = error[joint].max(number.0.error);
    }
}
