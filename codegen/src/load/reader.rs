//! The one way in which files are read: never more than a file of this kind can hold.

use std::fs::File;
use std::io::{Error, Read};
use std::path::Path;

/// Most bytes that are read of one file, as MiB: a device may have no end.
const MOST: u64 = 64;

/// The bytes of the file at `path`.
///
/// # Errors
/// Those of the system, and one where the file is longer than 64 MiB.
pub(super) fn bytes(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    File::open(path)?.take((MOST << 20) + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST << 20 {
        return Err(Error::other(format!("it has more than {MOST} MiB")));
    }
    Ok(bytes)
}

/// The text of the file at `path`.
///
/// # Errors
/// Those of [`bytes`], and one where the file is not UTF-8.
pub(crate) fn text(path: &Path) -> Result<String, Error> {
    String::from_utf8(bytes(path)?).map_err(|error| Error::other(format!("it is not UTF-8 text: {error}")))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::bytes;

    #[test]
    fn a_file_without_end_is_not_read_to_it() {
        let endless = Path::new("/dev/zero");
        if endless.exists() {
            let error = bytes(endless).expect_err("too long");
            assert_eq!(error.to_string(), "it has more than 64 MiB");
        }
    }
}
