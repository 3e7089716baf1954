//! The fixed-step loop as a task of RTIC, bound to the timer's interrupt.
#![no_std]
#![no_main]

#[path = "../../board_of_examples.rs"]
mod board;

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

#[rtic::app(device = lm3s6965)]
mod app {
    use cortex_m::peripheral::syst::SystClkSource;
    use gramforge_runtime::{StepController, TickReference};

    use crate::board::{Arm, MILLISECOND};
    use crate::puma560_one_percent::{Puma560OnePercent, REFERENCE, controller};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        controller: StepController<Puma560OnePercent, 6>,
        arm: Arm,
        tick: u32,
        faults_in_a_row: u32,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        let mut timer = context.core.SYST;
        timer.set_clock_source(SystClkSource::Core);
        // The period of the module is one millisecond.
        timer.set_reload(MILLISECOND - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
        let arm = Arm::at(REFERENCE.from);
        (Shared {}, Local { controller: controller(), arm, tick: 0, faults_in_a_row: 0 })
    }

    /// One step. Of all tasks it has the highest priority, so that none of them makes it late.
    #[task(binds = SysTick, priority = 2, local = [controller, arm, tick, faults_in_a_row])]
    fn control(context: control::Context) {
        let control::LocalResources { controller, arm, tick, faults_in_a_row, .. } = context.local;
        let desired = REFERENCE.at(*tick);
        let (q, qd) = arm.encoders();
        let torque = match controller.step(&q, &qd, &desired) {
            Ok(command) => {
                *faults_in_a_row = 0;
                command.torque
            }
            Err(fault) => {
                *faults_in_a_row += 1;
                fault.command
            }
        };
        arm.drive(&torque, (desired.q, desired.qd));
        *tick += 1;
        // After more faults in a row the arm is left to the watchdog.
        if *faults_in_a_row <= 3 {
            arm.feed_watchdog();
        }
    }

    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }
}
