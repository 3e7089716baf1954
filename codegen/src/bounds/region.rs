//! The domain as a box of variables: the errors (or positions) of the joints that occur, and time.

use crate::domain::Domain;
use crate::lagrangian::MAX_JOINTS;
use crate::motion::Motion;

/// Most variables: all joints and time.
pub const MAX_VARIABLES: usize = MAX_JOINTS + 1;

/// A box of variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Lower ends.
    pub low: [f64; MAX_VARIABLES],
    /// Upper ends.
    pub high: [f64; MAX_VARIABLES],
}

/// The positions that a [`Cell`] stands for: q = centre + e + speed·s + o with |e| ≤ width, |s| ≤ half, |o| ≤ off.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Position at the centre of the cell.
    pub centre: [f64; MAX_JOINTS],
    /// Half-widths of the joint variables.
    pub width: [f64; MAX_JOINTS],
    /// q̇_d at the middle of the time interval; zero without time.
    pub speed: [f64; MAX_JOINTS],
    /// Half the time interval, s.
    pub half: f64,
    /// Bound on |q̈_d| over the interval.
    pub acceleration: [f64; MAX_JOINTS],
    /// ½ acceleration half².
    pub off: [f64; MAX_JOINTS],
    /// width + |speed| half + off: no position is further from the centre.
    pub total: [f64; MAX_JOINTS],
}

impl Frame {
    /// The same positions through fewer joints, by slot of this frame.
    pub fn only(&self, slots: &[usize]) -> Self {
        let mut out = Self { half: self.half, ..Self::default() };
        for (to, &from) in slots.iter().enumerate() {
            out.centre[to] = self.centre[from];
            out.width[to] = self.width[from];
            out.speed[to] = self.speed[from];
            out.acceleration[to] = self.acceleration[from];
            out.off[to] = self.off[from];
            out.total[to] = self.total[from];
        }
        out
    }
}

/// A domain seen through the joints on which a function depends.
#[derive(Clone, Debug)]
pub struct Region<'a> {
    /// The joints.
    pub joints: &'a [usize],
    /// The motion around which the joint variables are errors; `None` where they are positions.
    pub motion: Option<&'a Motion>,
    /// All of it.
    pub root: Cell,
}

impl<'a> Region<'a> {
    /// The part of `domain` that `joints` see.
    pub fn new(domain: &'a Domain, joints: &'a [usize]) -> Self {
        let mut root = Cell { low: [0.0; MAX_VARIABLES], high: [0.0; MAX_VARIABLES] };
        let motion = domain.motion();
        let side = |j: usize| match domain {
            Domain::Workspace(limits) => limits[j],
            Domain::Tube(_, errors) => [-errors[j], errors[j]],
            Domain::Path(_) => [0.0; 2],
        };
        for (slot, &j) in joints.iter().enumerate() {
            [root.low[slot], root.high[slot]] = side(j);
        }
        // What does not move the joints needs no time.
        if let Some(motion) = motion.filter(|_| !joints.is_empty()) {
            root.high[joints.len()] = motion.duration();
        }
        Self { joints, motion, root }
    }

    /// Number of variables.
    pub fn variables(&self) -> usize {
        self.joints.len() + usize::from(self.motion.is_some())
    }

    /// The positions of `cell`.
    pub fn frame(&self, cell: &Cell) -> Frame {
        let k = self.joints.len();
        let mut out = Frame::default();
        for i in 0..k {
            out.centre[i] = 0.5 * (cell.low[i] + cell.high[i]);
            // Rounding of the centre stays inside a hair of extra width.
            let width = 0.5 * (cell.high[i] - cell.low[i]);
            out.width[i] =
                if width > 0.0 { width + 4.0 * f64::EPSILON * cell.high[i].abs().max(width) } else { 0.0 };
        }
        if let Some(motion) = self.motion {
            let (t0, t1) = (cell.low[k], cell.high[k]);
            let target = motion.at(0.5 * (t0 + t1));
            out.half = if t1 > t0 { 0.5 * (t1 - t0) + 4.0 * f64::EPSILON * t1 } else { 0.0 };
            let most = if t1 > t0 { motion.acceleration_within(t0, t1) } else { target.qdd.clone() };
            for (i, &j) in self.joints.iter().enumerate() {
                out.centre[i] += target.q[j];
                out.speed[i] = target.qd[j];
                out.acceleration[i] = most[j].abs();
                out.off[i] = 0.5 * most[j].abs() * out.half * out.half;
            }
        }
        for i in 0..k {
            out.total[i] = out.width[i] + out.speed[i].abs() * out.half + out.off[i];
        }
        out
    }

    /// Time and position of all joints at the variables `x`; joints that do not matter stand where the motion wants
    /// them, or at 0.
    pub fn position(&self, dof: usize, x: &[f64]) -> (Option<f64>, Vec<f64>) {
        let time = self.motion.and(x.get(self.joints.len()).copied());
        let mut q = self.motion.map_or(vec![0.0; dof], |motion| motion.at(time.unwrap_or(0.0)).q);
        for (&j, e) in self.joints.iter().zip(x) {
            q[j] += e;
        }
        (time, q)
    }

    /// The cell that is the point with the given variables.
    pub fn point(x: &[f64]) -> Cell {
        let mut at = [0.0; MAX_VARIABLES];
        at[..x.len()].copy_from_slice(x);
        Cell { low: at, high: at }
    }
}

/// Bounds on |q_j| over a domain, by joint of the arm.
pub fn position_bound(domain: &Domain) -> Vec<f64> {
    match domain {
        Domain::Workspace(limits) => limits.iter().map(|[a, b]| a.abs().max(b.abs())).collect(),
        Domain::Tube(motion, errors) => {
            motion.position_bound().position.iter().zip(errors).map(|(q, e)| q + e.abs()).collect()
        }
        Domain::Path(motion) => motion.position_bound().position,
    }
}
