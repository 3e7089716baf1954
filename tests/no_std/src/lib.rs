//! The generated controllers in a program without std and without an allocator.
//!
//! std brings a panic handler; with the one below there would be two, and this would not compile. A crate that uses
//! `alloc` would not link for want of a global allocator.
#![no_std]

use core::panic::PanicInfo;

use gramforge_generated::{arm3_adaptive, puma560_xi12 as puma};
use gramforge_runtime::reference::Reference;

#[panic_handler]
fn halt(_: &PanicInfo) -> ! {
    loop {}
}

/// One step of the control loop.
pub fn step(q: &[f64; 6], qd: &[f64; 6], t: f64) -> [f64; 6] {
    let mut controller = puma::controller();
    match controller.step(q, qd, &puma::REFERENCE.at(t)) {
        Ok(command) => command.torque,
        Err(fault) => fault.command,
    }
}

/// One step of a law that learns, from what it had learnt; what it has learnt then.
pub fn learn(theta: &mut [f64; arm3_adaptive::PARAMETERS], q: &[f64; 3], qd: &[f64; 3], t: f64) -> [f64; 3] {
    let mut controller = arm3_adaptive::controller();
    controller.restore(*theta);
    let torque = match controller.step(q, qd, &arm3_adaptive::REFERENCE.at(t)) {
        Ok(command) => command.torque,
        Err(fault) => fault.command,
    };
    *theta = *controller.learnt();
    torque
}
