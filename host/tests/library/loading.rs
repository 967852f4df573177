//! Every reader of a text file takes it with a byte order mark, and refuses a device without end.

use sinew::body::run::tuning_file;
use sinew::body::{BodyFile, pose_file};
use sinew::config::Config;
use sinew::error::ErrorKind;
use sinew::skin::labelled_pixels;
use sinew::stereo::{StereoOptions, StereoScene, read_stick, read_truth, stick_file, stick_wave, truth};
use sinew::{Error, Result};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::BODY_ANGLES;
use std::fs;
use std::path::Path;

type Reader = fn(&Path) -> Result<()>;

/// Names, readers and a file that each takes.
fn readers() -> Vec<(&'static str, Reader, String)> {
    let person = BodyFile::from(&BodyMeasures::of_height(1.7).unwrap());
    let mut wave = stick_wave(1, 15.0, 1.0, 3.0).unwrap();
    wave.recording.joints_m.truncate(2);
    let stick = stick_file::stick_csv(&StereoOptions::default().camera, &wave.stick_m[..2]);
    let scene = StereoScene::new(wave.recording, StereoOptions::default()).unwrap();
    vec![
        ("camera.toml", |path| Config::load(path).map(drop), "[body]\nheight_m = 1.8\n".to_owned()),
        ("tuning.toml", |path| tuning_file::load(path).map(drop), "pulling_blocks = 12\n".to_owned()),
        ("body.json", |path| BodyFile::read(path).map(drop), serde_json::to_string(&person).unwrap()),
        ("pose.json", |path| pose_file::read_pose(path).map(drop), pose_file::pose_json(&[0.0; BODY_ANGLES])),
        ("stick.csv", |path| read_stick(path).map(drop), stick),
        ("truth.csv", |path| read_truth(path).map(drop), truth::truth_csv(&scene)),
        ("pixels.txt", |path| labelled_pixels::read(path).map(drop), "1 2 3 1\n4 5 6 2\n".to_owned()),
    ]
}

#[test]
fn a_byte_order_mark_is_dropped() {
    let folder = tempfile::tempdir().unwrap();
    for (name, read, text) in readers() {
        let path = folder.path().join(name);
        for text in [text.clone(), format!("\u{feff}{text}")] {
            fs::write(&path, text).unwrap();
            read(&path).map_err(|error| error.chain()).unwrap();
        }
    }
}

#[cfg(unix)]
#[test]
fn a_device_without_end_is_refused_by_name() {
    for (name, read, _) in readers() {
        let error: Error = read(Path::new("/dev/zero")).unwrap_err();
        let message = error.chain();
        assert_eq!(error.kind(), ErrorKind::Data, "{name}: {message}");
        assert!(message.contains("/dev/zero") && message.contains("268435456 bytes"), "{name}: {message}");
    }
}

#[test]
fn a_file_that_is_not_there_is_no_input() {
    for (name, read, _) in readers() {
        let error = read(Path::new("nowhere/file")).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NoInput, "{name}: {}", error.chain());
    }
}
