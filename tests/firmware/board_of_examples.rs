//! What stands for your board: encoders, motors and watchdog of a make-believe arm that follows every motion.

use cortex_m_semihosting::debug;

/// Joints.
pub const JOINTS: usize = 6;
/// Processor cycles in one millisecond.
pub const MILLISECOND: u32 = 25_000;
/// Ticks after which the example ends.
const TICKS: u32 = 500;

/// The arm.
pub struct Arm {
    q: [f32; JOINTS],
    qd: [f32; JOINTS],
    ticks: u32,
}

impl Arm {
    /// At rest at `q`, rad.
    pub const fn at(q: [f32; JOINTS]) -> Self {
        Self { q, qd: [0.0; JOINTS], ticks: 0 }
    }

    /// Position, rad, and velocity, rad/s, as your encoders give them.
    pub fn encoders(&self) -> ([f32; JOINTS], [f32; JOINTS]) {
        (self.q, self.qd)
    }

    /// Where your motors get their torque, N·m. This arm goes where it is wanted instead.
    pub fn drive(&mut self, torque: &[f32; JOINTS], wanted: ([f32; JOINTS], [f32; JOINTS])) {
        (self.q, self.qd) = wanted;
        if !torque.iter().all(|x| x.is_finite()) {
            debug::exit(debug::EXIT_FAILURE);
        }
    }

    /// Where your watchdog is fed. The example ends here.
    pub fn feed_watchdog(&mut self) {
        self.ticks += 1;
        if self.ticks == TICKS {
            debug::exit(debug::EXIT_SUCCESS);
        }
    }
}
