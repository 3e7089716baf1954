//! The host, which counts nothing.

/// Whether instructions and stack are counted.
pub const COUNTS: bool = false;

/// Prints to the standard output.
pub fn print(text: &str) {
    print!("{text}");
}

/// Ends the program.
pub fn exit(code: u8) -> ! {
    std::process::exit(code.into())
}

/// Calls `f`.
pub fn instructions(f: &mut dyn FnMut()) -> u32 {
    f();
    0
}

/// Calls `f`.
pub fn stack(f: &mut dyn FnMut()) -> u32 {
    f();
    0
}
