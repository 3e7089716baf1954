//! The clock of `embassy-time` on SysTick. The crate of your processor has one of its own.

use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::Waker;

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;
use critical_section::Mutex;
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;

use crate::board::MILLISECOND;

struct Clock {
    milliseconds: AtomicU32,
    waiting: Mutex<RefCell<Queue>>,
}

embassy_time_driver::time_driver_impl!(static CLOCK: Clock = Clock {
    milliseconds: AtomicU32::new(0),
    waiting: Mutex::new(RefCell::new(Queue::new())),
});

impl Driver for Clock {
    fn now(&self) -> u64 {
        u64::from(self.milliseconds.load(Ordering::Relaxed))
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        critical_section::with(|token| {
            self.waiting.borrow(token).borrow_mut().schedule_wake(at, waker);
        });
    }
}

/// Starts the clock.
pub fn start() {
    let Some(core) = cortex_m::Peripherals::take() else { return };
    let mut timer = core.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(MILLISECOND - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
}

#[exception]
fn SysTick() {
    let now = CLOCK.milliseconds.load(Ordering::Relaxed).wrapping_add(1);
    CLOCK.milliseconds.store(now, Ordering::Relaxed);
    critical_section::with(|token| {
        // Wakes all whose time has come.
        CLOCK.waiting.borrow(token).borrow_mut().next_expiration(now.into());
    });
}
