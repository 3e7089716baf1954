//! How deep the stack went: it is painted before, and read after.
#![allow(unsafe_code, reason = "the stack below the own frame belongs to no variable")]

const PAINT: u32 = 0xA5C3_5A3C;
/// Bytes that are painted.
const DEPTH: usize = 16 * 1024;
/// Bytes below the mark that may be of the own frame.
const FRAME: usize = 128;

/// Bytes of stack below this function's mark that `f` has used, no fewer than `FRAME`.
#[inline(never)]
pub fn stack(f: &mut dyn FnMut()) -> u32 {
    let mark = 0_u32;
    let top = (core::ptr::from_ref(core::hint::black_box(&mark)) as usize) & !3;
    let bottom = top - DEPTH;
    let words = || (bottom..top - FRAME).step_by(4).map(|address| address as *mut u32);
    for word in words() {
        // Sound: memory of the stack that nothing uses.
        unsafe { word.write_volatile(PAINT) };
    }
    f();
    // Sound: as above.
    let untouched = words().take_while(|word| unsafe { word.read_volatile() } == PAINT).count();
    (DEPTH - 4 * untouched) as u32
}
