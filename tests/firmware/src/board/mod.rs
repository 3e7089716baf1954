//! The machine that the program runs on: output, end, instruction counter, stack.

#[cfg(target_arch = "arm")]
mod cortex_m;
#[cfg(not(target_os = "none"))]
mod host;
#[cfg(target_arch = "riscv32")]
mod riscv;
#[cfg(target_os = "none")]
mod stack;

#[cfg(target_arch = "arm")]
use cortex_m as machine;
#[cfg(not(target_os = "none"))]
use host as machine;
#[cfg(target_arch = "riscv32")]
use riscv as machine;

pub use machine::{COUNTS, exit, instructions, print, stack};

/// A program without std must have one. Nothing reaches it: a test finds no trace of it in the image.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
