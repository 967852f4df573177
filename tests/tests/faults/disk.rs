//! A disk that is full, inputs that vanish.

use crate::kinds::Kind;
use std::fs;
use std::process::Stdio;
use std::time::Duration;

/// A shell's limit of the size of files, in blocks of 512 bytes, without the signal that
/// comes with it: a write beyond fails as on a full disk.
const SMALL_FILES: &str = "trap '' XFSZ; ulimit -f 1000";

#[test]
fn a_full_disk_keeps_what_was_finished_and_an_older_run() {
    for kind in [Kind::arm(), Kind::body(), Kind::rows()] {
        assert_eq!(Kind::ends(kind.command("whole", &[])).0, Some(0));
        let whole = kind.files("whole");
        let (code, message) = Kind::ends(kind.command("run", &["--seed", "9"]));
        assert_eq!(code, Some(0), "{message}");
        let older = kind.files("run");
        let (code, message) = Kind::ends(kind.shell(SMALL_FILES, "run", kind.often()));
        assert_eq!(code, Some(74), "{message}");
        assert!(message.contains("--resume") && message.contains("cannot be written"), "{message}");
        assert!(kind.is_unfinished("run"));
        let after = kind.files("run");
        for (name, bytes) in older.iter().filter(|(name, _)| !name.starts_with("overlay/")) {
            assert!(after[name] == *bytes, "{name} of the older run has changed");
        }
        kind.assert_resumes("run", &whole, "after a full disk");
    }
}

#[test]
fn a_folder_that_vanishes_ends_a_run_that_can_be_resumed() {
    for (kind, folder) in [(Kind::arm(), "scene/frames"), (Kind::body(), "scene/points")] {
        assert_eq!(Kind::ends(kind.command("whole", &[])).0, Some(0));
        let whole = kind.files("whole");
        let mut child = kind.command("run", &["--checkpoint", "0"]).stderr(Stdio::piped()).spawn().unwrap();
        while !kind.is_unfinished("run") {
            std::thread::sleep(Duration::from_millis(1));
        }
        fs::rename(kind.path(folder), kind.path("away")).unwrap();
        let status = child.wait().unwrap();
        fs::rename(kind.path("away"), kind.path(folder)).unwrap();
        assert_eq!(status.code(), Some(74), "an error of the operating system is no bad picture");
        kind.assert_resumes("run", &whole, "after the folder came back");
    }
}
