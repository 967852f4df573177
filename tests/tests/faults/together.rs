//! Two runs at once in one folder.

use crate::kinds::Kind;
use std::process::Stdio;
use std::time::Duration;

#[test]
fn a_second_run_in_the_same_folder_is_told_who_is_there() {
    let kind = Kind::body();
    let mut first = kind.command("run", &[]).stderr(Stdio::null()).spawn().unwrap();
    while !kind.is_unfinished("run") {
        std::thread::sleep(Duration::from_millis(1));
    }
    for more in [&[][..], &["--resume"][..]] {
        let (code, message) = Kind::ends(kind.command("run", more));
        assert_eq!(code, Some(75), "{message}");
        let owner = format!("`sinew track body`, process {}", first.id());
        assert!(message.contains(&owner), "{message}");
    }
    assert!(first.wait().unwrap().success());
    assert_eq!(Kind::ends(kind.command("alone", &[])).0, Some(0));
    assert!(kind.files("run") == kind.files("alone"));
}
