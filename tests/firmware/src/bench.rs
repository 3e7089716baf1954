//! A board with the arm simulated.

use gramforge_runtime::simulate::{JointState, Plant, Simulation};

use crate::control_loop::Board;
use crate::hash::Hash;

/// What goes wrong on the bench.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trouble {
    /// The first tick at which the encoders fail, and how many do: they give NaN.
    pub blind: [u32; 2],
    /// The first tick that is missed, and how many are.
    pub missed: [u32; 2],
}

/// The board of a simulated arm.
#[derive(Debug)]
pub struct Bench<P, const N: usize> {
    simulation: Simulation<P, f32, N>,
    trouble: Trouble,
    ticks: u32,
    next: u32,
    torque: [f32; N],
    /// Hash of all torques that were driven.
    pub hash: Hash,
    /// How often the watchdog was fed.
    pub fed: u32,
    /// Whether a torque was infinite or NaN, or the simulated arm went astray.
    pub astray: bool,
}

impl<P: Plant<f32, N>, const N: usize> Bench<P, N> {
    /// A simulated arm that ends the loop after some ticks.
    pub fn new(simulation: Simulation<P, f32, N>, ticks: u32, trouble: Trouble) -> Self {
        Self {
            simulation,
            trouble,
            ticks,
            next: 0,
            torque: [0.0; N],
            hash: Hash::default(),
            fed: 0,
            astray: false,
        }
    }

    /// Position and velocity of the arm.
    pub fn state(&self) -> &JointState<f32, N> {
        self.simulation.state()
    }

    fn within(now: u32, [first, many]: [u32; 2]) -> bool {
        now.wrapping_sub(first) < many
    }

    fn advance(&mut self) {
        self.astray |= self.simulation.advance(&self.torque).is_err();
    }
}

impl<P: Plant<f32, N>, const N: usize> Board<N> for Bench<P, N> {
    fn wait_for_tick(&mut self) -> Option<u32> {
        if self.next > 0 {
            self.advance();
        }
        while Self::within(self.next, self.trouble.missed) {
            // The motors hold their torque.
            self.next += 1;
            self.advance();
        }
        let tick = self.next;
        self.next += 1;
        (tick < self.ticks).then_some(tick)
    }

    fn encoders(&mut self) -> ([f32; N], [f32; N]) {
        let JointState { q, qd } = *self.simulation.state();
        if Self::within(self.next - 1, self.trouble.blind) { ([f32::NAN; N], qd) } else { (q, qd) }
    }

    fn drive(&mut self, torque: &[f32; N]) {
        self.torque = *torque;
        self.hash.vector(torque);
        self.astray |= !torque.iter().all(|x| x.is_finite());
    }

    fn feed_watchdog(&mut self) {
        self.fed += 1;
    }
}
