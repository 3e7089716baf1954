//! A RISC-V core with single precision: QEMU's virt with `-icount shift=6`.
#![allow(unsafe_code, reason = "registers of a bare core")]

use core::arch::{asm, global_asm};

pub use super::stack::stack;

/// Whether instructions and stack are counted.
pub const COUNTS: bool = true;

// Sets the stack, turns the floating-point unit on, clears the memory that starts as zero.
global_asm!(
    ".section .text.reset",
    ".global reset",
    "reset:",
    "la sp, __stack",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "fscsr zero",
    "la t0, __bss",
    "la t1, __bss_end",
    "1: bgeu t0, t1, 2f",
    "sw zero, 0(t0)",
    "addi t0, t0, 4",
    "j 1b",
    "2: la t0, trap",
    "csrw mtvec, t0",
    "j start",
    ".align 2",
    "trap: li a0, 102",
    "j leave",
);

/// Prints to the serial line, QEMU's standard output.
pub fn print(text: &str) {
    for byte in text.bytes() {
        unsafe { (0x1000_0000 as *mut u8).write_volatile(byte) };
    }
}

/// Ends QEMU.
pub fn exit(code: u8) -> ! {
    leave(code.into())
}

#[unsafe(no_mangle)]
extern "C" fn leave(code: u32) -> ! {
    loop {
        let word = if code == 0 { 0x5555 } else { code << 16 | 0x3333 };
        unsafe { (0x10_0000 as *mut u32).write_volatile(word) };
    }
}

#[inline(always)]
fn instret() -> u32 {
    let count;
    unsafe { asm!("csrr {}, minstret", out(reg) count) };
    count
}

#[inline(never)]
fn passed(f: &mut dyn FnMut()) -> u32 {
    let before = instret();
    f();
    instret().wrapping_sub(before)
}

/// Instructions of one call of `f`, up to 60 million, less those of calling a closure that is empty.
///
/// With `-icount shift=6` this counter of QEMU's counts nanoseconds of virtual time, 64 an instruction.
pub fn instructions(f: &mut dyn FnMut()) -> u32 {
    passed(f) / 64 - passed(&mut || {}) / 64
}
