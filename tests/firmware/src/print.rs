//! Lines of results. `core::fmt` is not used: it alone is larger than a control step.

use crate::board;

/// Prints `MODULE KEY VALUE`, the value in hexadecimal.
pub fn line(module: &str, key: &str, value: u64) {
    parts(&[module, " ", key, " "], value);
}

/// Prints `MODULE GROUP_KEY VALUE`.
pub fn grouped(module: &str, group: &str, key: &str, value: u64) {
    parts(&[module, " ", group, "_", key, " "], value);
}

fn parts(texts: &[&str], value: u64) {
    for text in texts {
        board::print(text);
    }
    for nibble in (0..16).rev() {
        board::print(digit((value >> (4 * nibble)) as u8 & 15));
    }
    board::print("\n");
}

/// Prints a count, which only a bare core has.
pub fn count(module: &str, key: &str, value: u32) {
    if board::COUNTS {
        line(module, key, u64::from(value));
    }
}

fn digit(nibble: u8) -> &'static str {
    match nibble {
        0 => "0",
        1 => "1",
        2 => "2",
        3 => "3",
        4 => "4",
        5 => "5",
        6 => "6",
        7 => "7",
        8 => "8",
        9 => "9",
        10 => "a",
        11 => "b",
        12 => "c",
        13 => "d",
        14 => "e",
        _ => "f",
    }
}
