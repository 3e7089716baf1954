//! The fixed-step loop as a task of Embassy.
#![no_std]
#![no_main]

#[path = "../../board_of_examples.rs"]
mod board;
mod clock;

use board::Arm;
use embassy_executor::Spawner;
use embassy_time::{Duration, Instant, Ticker};
use gramforge_runtime::TickReference;
use puma560_one_percent::{REFERENCE, controller};

#[rustfmt::skip]
mod puma560_one_percent {
    include!(concat!(env!("GRAMFORGE_MODULES"), "/puma560_one_percent.rs"));
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // Yours: brakes, then a reset.
    loop {
        cortex_m::asm::bkpt();
    }
}

/// Other tasks of the same executor can make this loop late. With others, run it in an `InterruptExecutor`.
#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    clock::start();
    let mut controller = controller();
    let mut arm = Arm::at(REFERENCE.from);
    let mut faults_in_a_row = 0;
    // The period of the module is one millisecond.
    let mut ticker = Ticker::every(Duration::from_millis(1));
    let start = Instant::now();
    loop {
        ticker.next().await;
        // A ticker that is late ticks at once until it has caught up. The clock says which tick it is.
        let tick = start.elapsed().as_millis() as u32;
        let desired = REFERENCE.at(tick);
        let (q, qd) = arm.encoders();
        let torque = match controller.step(&q, &qd, &desired) {
            Ok(command) => {
                faults_in_a_row = 0;
                command.torque
            }
            Err(fault) => {
                faults_in_a_row += 1;
                fault.command
            }
        };
        arm.drive(&torque, (desired.q, desired.qd));
        // After more faults in a row the arm is left to the watchdog.
        if faults_in_a_row <= 3 {
            arm.feed_watchdog();
        }
    }
}
