//! A Cortex-M4F: QEMU's mps2-an386 with semihosting and `-icount shift=6`.
#![allow(unsafe_code, reason = "vectors, registers and the semihosting call of a bare core")]

use core::arch::asm;
use core::sync::atomic::{AtomicU32, Ordering};

pub use super::stack::stack;

/// Whether instructions and stack are counted.
pub const COUNTS: bool = true;

unsafe extern "C" {
    static mut __bss: u32;
    static mut __bss_end: u32;
    static mut __data: u32;
    static mut __data_end: u32;
    static __data_load: u32;
    static __stack: u32;
}

/// An entry of the vector table: the first is the top of the stack.
#[repr(C)]
union Vector {
    handler: unsafe extern "C" fn() -> !,
    stack: *const u32,
}

// Sound: nothing writes to it.
unsafe impl Sync for Vector {}

#[unsafe(link_section = ".vectors")]
#[used]
static VECTORS: [Vector; 16] = {
    let mut vectors = [const { Vector { handler: hard_fault } }; 16];
    vectors[0] = Vector { stack: &raw const __stack };
    vectors[1] = Vector { handler: reset };
    vectors
};

unsafe extern "C" {
    /// The program, which does not return.
    safe fn start() -> !;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn reset() -> ! {
    unsafe {
        // CPACR: turns the floating-point unit on.
        (0xE000_ED88 as *mut u32).write_volatile(0xF << 20);
        asm!("dsb", "isb");
        let (mut to, mut from) = (&raw mut __data, &raw const __data_load);
        while to < &raw mut __data_end {
            to.write_volatile(from.read_volatile());
            (to, from) = (to.add(1), from.add(1));
        }
        let mut zero = &raw mut __bss;
        while zero < &raw mut __bss_end {
            zero.write_volatile(0);
            zero = zero.add(1);
        }
    }
    start()
}

unsafe extern "C" fn hard_fault() -> ! {
    exit(102)
}

fn semihosting(operation: u32, arguments: *const u32) -> u32 {
    let result;
    unsafe { asm!("bkpt 0xAB", inlateout("r0") operation => result, in("r1") arguments) };
    result
}

/// Prints to QEMU's standard output.
pub fn print(text: &str) {
    static HANDLE: AtomicU32 = AtomicU32::new(0);
    if HANDLE.load(Ordering::Relaxed) == 0 {
        // SYS_OPEN of ":tt" for writing is the standard output.
        HANDLE.store(semihosting(1, [c":tt".as_ptr() as u32, 4, 3].as_ptr()), Ordering::Relaxed);
    }
    // SYS_WRITE.
    semihosting(5, [HANDLE.load(Ordering::Relaxed), text.as_ptr() as u32, text.len() as u32].as_ptr());
}

/// Ends QEMU.
pub fn exit(code: u8) -> ! {
    loop {
        // SYS_EXIT_EXTENDED with ADP_Stopped_ApplicationExit.
        semihosting(0x20, [0x2_0026_u32, u32::from(code)].as_ptr());
    }
}

/// SysTick: control, reload, current.
const SYSTICK: *mut u32 = 0xE000_E010 as *mut u32;

#[inline(always)]
fn systick() -> u32 {
    unsafe { SYSTICK.add(2).read_volatile() }
}

#[inline(never)]
fn ticks(f: &mut dyn FnMut()) -> u32 {
    let before = systick();
    f();
    before.wrapping_sub(systick()) & 0xFF_FFFF
}

/// Instructions of one call of `f`, up to 10 million, less those of calling a closure that is empty.
///
/// With `-icount shift=6` an instruction takes 64 ns of virtual time; SysTick has 25 MHz: 1.6 ticks an instruction.
pub fn instructions(f: &mut dyn FnMut()) -> u32 {
    unsafe {
        SYSTICK.add(1).write_volatile(0xFF_FFFF);
        SYSTICK.add(2).write_volatile(0);
        SYSTICK.write_volatile(0b101);
    }
    let of = |ticks: u32| (ticks * 5 + 4) / 8;
    of(ticks(f)) - of(ticks(&mut || {}))
}
