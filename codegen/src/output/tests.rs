use std::path::PathBuf;

use super::*;

/// A folder of this test's own, removed when it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gramforge-output-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_file_that_cannot_be_written_leaves_the_others_as_they_were() {
    let folder = Folder::new("together");
    let (first, second) = (folder.0.join("first.rs"), folder.0.join("second.rs"));
    fs::write(&first, "old").unwrap();
    fs::create_dir(&second).unwrap();
    let third = first.join("third.rs");
    let refused = write_all(&[(&first, "new"), (&second, "new"), (&third, "new")]).unwrap_err();
    let Error::Input(faults) = &refused else { panic!("{refused}") };
    let named: Vec<&Path> = faults.iter().map(|fault| fault.file.as_path()).collect();
    assert_eq!(named, [&second, &third], "{refused}");
    assert!(faults[0].problem == "is a folder", "{refused}");
    assert_eq!(fs::read_to_string(&first).unwrap(), "old");
    assert_eq!(folder.names(), ["first.rs", "second.rs"]);

    fs::remove_dir(&second).unwrap();
    assert_eq!(write_all(&[(&first, "new"), (&second, "new")]).unwrap(), [true, true]);
    assert_eq!(write_all(&[(&first, "new"), (&second, "other")]).unwrap(), [false, true]);
    assert_eq!(fs::read_to_string(&second).unwrap(), "other");
    assert_eq!(folder.names(), ["first.rs", "second.rs"]);
}

#[test]
fn every_byte_counts() {
    let folder = Folder::new("bytes");
    let path = folder.0.join("arm.rs");
    fs::write(&path, "one\r\ntwo\r\n").unwrap();
    assert!(!is_current(&path, "one\ntwo\n"));
    assert!(write_if_changed(&path, "one\ntwo\n").unwrap());
    assert!(is_current(&path, "one\ntwo\n") && !is_current(&path, "one\ntwo"));
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_neither_followed_nor_replaced() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let (precious, link, pipe) =
        (folder.0.join("precious"), folder.0.join("link.rs"), folder.0.join("pipe.rs"));
    fs::write(&precious, "precious").unwrap();
    symlink(&precious, &link).unwrap();
    // Where a writer of old would have put its temporary file.
    symlink(&precious, folder.0.join("arm.rs.partial")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for (path, kind) in [(&link, "is a symbolic link"), (&pipe, "is not a regular file")] {
        let refused = write_if_changed(path, "text").unwrap_err().to_string();
        assert!(refused.contains(kind), "{refused}");
        assert!(!is_current(path, "text"));
    }
    assert!(write_if_changed(&folder.0.join("arm.rs"), "text").unwrap());
    assert_eq!(fs::read_to_string(&precious).unwrap(), "precious");
}

#[test]
fn what_an_ended_process_left_is_removed_and_what_a_living_one_writes_is_not() {
    let folder = Folder::new("leftovers");
    let path = folder.0.join("arm.rs");
    let (dead, alive) = (leftover::name("arm.rs", 4_000_000, 0), leftover::name("arm.rs", 4_000_001, 0));
    let other = leftover::name("other.rs", 4_000_000, 0);
    for name in [&dead, &alive, &other] {
        fs::write(folder.0.join(name), "half").unwrap();
    }
    let held = fs::File::options().write(true).open(folder.0.join(&alive)).unwrap();
    held.lock().unwrap();
    assert!(write_if_changed(&path, "text").unwrap());
    assert_eq!(folder.names(), [alive.as_str(), &other, "arm.rs"]);
    // Also where the file says already what it is to say.
    fs::write(folder.0.join(&dead), "half").unwrap();
    assert!(!write_if_changed(&path, "text").unwrap());
    assert_eq!(folder.names(), [alive.as_str(), &other, "arm.rs"]);
}

#[test]
fn a_thousand_pairs_of_writers_lose_and_tear_nothing() {
    let folder = Folder::new("pairs");
    let path = folder.0.join("arm.rs");
    // Of different length and long enough to be written in several pieces.
    let texts = ["a".repeat(70_000), "b".repeat(90_001)];
    for round in 0..1000 {
        if round % 10 == 0 {
            let _ = fs::remove_file(&path);
        }
        std::thread::scope(|scope| {
            let path = &path;
            let write = |text| scope.spawn(move || write_if_changed(path, text));
            for writer in [write(&texts[0]), write(&texts[1])] {
                writer.join().unwrap().unwrap_or_else(|error| panic!("round {round}: {error}"));
            }
        });
        let found = fs::read_to_string(&path).unwrap();
        assert!(texts.contains(&found), "round {round}: {} bytes", found.len());
    }
    assert_eq!(folder.names(), ["arm.rs"]);
}
