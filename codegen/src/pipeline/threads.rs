//! The number of threads that the environment asks for.

use std::path::Path;

use crate::error::Error;

/// Most threads that may be asked for; rayon would try to start any number.
const MOST: usize = 1024;
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// A fault where the environment asks for more threads than any machine has processors.
pub(super) fn check() -> Result<(), Error> {
    let asked = std::env::var(VARIABLE).ok();
    match asked.as_deref().and_then(excess) {
        None => Ok(()),
        Some(number) => Err(Error::input(
            Path::new("environment"),
            VARIABLE,
            format!("is {number}"),
            format!("write a number of threads from 1 to {MOST}, or unset it for one a processor"),
        )),
    }
}

/// `asked`, where that is a number of threads beyond all measure.
fn excess(asked: &str) -> Option<&str> {
    let digits = asked.trim();
    let number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    (number && digits.parse::<usize>().map_or(true, |number| number > MOST)).then_some(digits)
}

#[cfg(test)]
mod tests {
    use super::excess;

    #[test]
    fn only_absurd_numbers_are_refused() {
        for fine in ["", "0", "4", "1024", "many", "-1"] {
            assert_eq!(excess(fine), None, "{fine}");
        }
        for absurd in ["1025", "99999999", "99999999999999999999999"] {
            assert_eq!(excess(absurd), Some(absurd));
        }
    }
}
