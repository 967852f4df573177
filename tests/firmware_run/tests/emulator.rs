//! A run in the emulator ends, whatever the image does.

use sinew_firmware_run::emulator::{Machine, is_installed, run};
use std::fs;

#[test]
fn what_is_no_image_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image");
    assert!(run(&path, Machine::M4, None).unwrap_err().to_string().contains("image"));
    if !is_installed() {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "CI has to have the emulator");
        eprintln!("left out: there is no emulator");
        return;
    }
    fs::write(&path, "no ELF file").unwrap();
    let ended = run(&path, Machine::M4, None).unwrap();
    assert!(ended.code != Some(0) && ended.results.is_none(), "{ended:?}");
}

#[test]
fn a_machine_has_one_of_two_names() {
    assert_eq!("m7".parse::<Machine>().unwrap(), Machine::M7);
    assert!("m5".parse::<Machine>().unwrap_err().to_string().contains("m4 or m7"));
}
