//! The loop made linear about its motion and frozen period by period: it says which runs are worth while, no more.

use gramforge_tests::plant::{MOST, Row, row};
use nalgebra::{DMatrix, DVector};

use super::looped::Loop;

/// Half the distance of a difference of the law, inside every boundary layer; and that of the arm.
const NEAR: f64 = 1e-6;
/// Periods that share one linear map are together no longer than this, s.
const PIECE: f64 = 4e-3;

/// The linear maps of a loop.
pub struct Frozen {
    pieces: Vec<Piece>,
    length: usize,
}

struct Piece {
    /// (q_e, q̇_e) over one period.
    map: DMatrix<f64>,
    /// What a torque that is held for the period adds.
    push: DMatrix<f64>,
    /// The law's torque for (q_e, q̇_e), and what acceleration comes of it.
    torque: DMatrix<f64>,
    acceleration: DMatrix<f64>,
}

/// What an aim depends on: the errors at the start and the torques of each period.
pub struct Sensitivity {
    pub start: DVector<f64>,
    pub pushes: Vec<Row>,
}

/// What an attack moves as far as it can at one sample.
#[derive(Clone, Copy, Debug)]
pub enum Aim {
    Position(usize),
    Torque(usize),
}

impl Frozen {
    pub fn new(own: &Loop) -> Self {
        let length = (PIECE / own.period).floor().max(1.0) as usize;
        let pieces = (0..own.periods).step_by(length).map(|k| Piece::new(own, k)).collect();
        Self { pieces, length }
    }

    /// Whether the loop would be stable with this period in every piece, frozen.
    pub fn stable(&self, period: f64) -> bool {
        let radius = |piece: &Piece| {
            let map = map(&piece.acceleration, period);
            map.complex_eigenvalues().iter().map(|x| x.re.hypot(x.im)).fold(0.0, f64::max)
        };
        self.pieces.iter().all(|piece| radius(piece) < 1.0)
    }

    /// What `aim` at sample `until` depends on, from sample `from` on.
    pub fn sensitivity(&self, aim: Aim, from: usize, until: usize) -> Sensitivity {
        let piece = |k: usize| &self.pieces[(k / self.length).min(self.pieces.len() - 1)];
        let n = self.pieces[0].push.ncols();
        let mut row_of: DVector<f64> = match aim {
            Aim::Position(i) => DVector::from_fn(2 * n, |k, _| if k == i { 1.0 } else { 0.0 }),
            Aim::Torque(i) => piece(until).torque.row(i).transpose(),
        };
        let mut pushes = Vec::new();
        for k in (from..until).rev() {
            pushes.push(row(piece(k).push.tr_mul(&row_of).as_slice()));
            row_of = piece(k).map.tr_mul(&row_of);
        }
        pushes.reverse();
        Sensitivity { start: row_of, pushes }
    }
}

impl Piece {
    fn new(own: &Loop, k: usize) -> Self {
        let (n, t, desired) = (own.n, own.period, &own.desired[k]);
        let held = own.asked(k, &desired.q, &desired.qd);
        let moved = |j: usize, by: f64| {
            let (mut q, mut qd) = (desired.q, desired.qd);
            if j < n {
                q[j] += by;
            } else {
                qd[j - n] += by;
            }
            (q, qd)
        };
        let slope = |of: &dyn Fn(&Row, &Row) -> Row| {
            DMatrix::from_columns(
                &(0..2 * n)
                    .map(|j| {
                        let [more, less] = [NEAR, -NEAR].map(|by| {
                            let (q, qd) = moved(j, by);
                            of(&q, &qd)
                        });
                        DVector::from_fn(n, |i, _| (more[i] - less[i]) / (2.0 * NEAR))
                    })
                    .collect::<Vec<_>>(),
            )
        };
        let torque = slope(&|q, qd| own.asked(k, q, qd));
        let free = slope(&|q, qd| own.arm.acceleration(q, qd, &held));
        let rest = own.arm.acceleration(&desired.q, &desired.qd, &held);
        let mobility = DMatrix::from_fn(n, n, |i, j| {
            let mut more: [f64; MOST] = held;
            more[j] += 1.0;
            own.arm.acceleration(&desired.q, &desired.qd, &more)[i] - rest[i]
        });
        let acceleration = free + &mobility * &torque;
        Self { map: map(&acceleration, t), push: held_for(&mobility, t), torque, acceleration }
    }
}

/// What an acceleration that is held for `t` s adds to (q_e, q̇_e).
fn held_for(a: &DMatrix<f64>, t: f64) -> DMatrix<f64> {
    let n = a.nrows();
    let mut out = DMatrix::zeros(2 * n, a.ncols());
    out.rows_mut(0, n).copy_from(&(a * (0.5 * t * t)));
    out.rows_mut(n, n).copy_from(&(a * t));
    out
}

/// (q_e, q̇_e) over a period of `t` s.
fn map(acceleration: &DMatrix<f64>, t: f64) -> DMatrix<f64> {
    let n = acceleration.nrows();
    let mut map = DMatrix::identity(2 * n, 2 * n) + held_for(acceleration, t);
    (0..n).for_each(|i| map[(i, n + i)] += t);
    map
}
