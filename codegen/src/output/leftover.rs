//! Temporary files of processes that ended before their time.

use std::fs::{self, File};
use std::path::Path;

/// The temporary file for `target` that process number `process` makes as its number `count`.
pub(super) fn name(target: &str, process: u32, count: u64) -> String {
    format!(".{target}.{process}-{count}.partial")
}

/// Whether `file` is a name that [`name`] gives for `target`.
fn is_for(file: &str, target: &str) -> bool {
    let inner = file.strip_prefix('.').and_then(|rest| rest.strip_prefix(target));
    let numbers =
        inner.and_then(|rest| rest.strip_prefix('.')).and_then(|rest| rest.strip_suffix(".partial"));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    numbers.and_then(|n| n.split_once('-')).is_some_and(|(process, count)| digits(process) && digits(count))
}

/// Removes what nobody works on any more of the temporary files for `target` in `folder`.
///
/// Who works on a file holds its lock, and the system lets go of it however the process ends. Between making and locking
/// a file may be taken for left behind; its owner then makes another.
pub(super) fn clean(folder: &Path, target: &str) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let ours = entry.file_name().to_str().is_some_and(|file| is_for(file, target));
        // The kind of the entry itself: what a link points to is not ours.
        if ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let path = entry.path();
            if File::open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
                // Somebody else may have been faster.
                let _ = fs::remove_file(&path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{is_for, name};

    #[test]
    fn own_names_are_known_and_others_are_not() {
        assert!(is_for(&name("arm.rs", 12, 3), "arm.rs"));
        for other in [
            "arm.rs",
            "arm.rs.partial",
            ".arm.rs.partial",
            ".arm.rs.12.partial",
            ".arm.rs.12-.partial",
            ".arm.rs.a-1.partial",
            ".arm2.rs.1-1.partial",
        ] {
            assert!(!is_for(other, "arm.rs"), "{other}");
        }
    }
}
