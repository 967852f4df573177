//! Readers of the files beside a scene: the stick, the truth, labelled pixels.

use crate::Target;
use crate::file::file;
use sinew::skin::labelled_pixels;
use sinew::stereo::stick_file::STICK_HEADER;
use sinew::stereo::{StereoOptions, StereoScene, read_stick, read_truth, stick_wave, truth};

/// `stick.csv`, `truth.csv` and labelled pixels.
pub const TARGETS: &[Target] = &[
    Target { name: "stick_file", run: stick, seeds: || vec![sticks().into_bytes()] },
    Target { name: "truth_file", run: true_frames, seeds: || vec![truth_of_two().into_bytes()] },
    Target { name: "labelled_pixels", run: pixels, seeds: || vec![b"74\t85 123  1\n\n1 2 3 2\r\n".to_vec()] },
];

fn sticks() -> String {
    format!("{STICK_HEADER}\n0,0.5,0.1,2,-0.5,0.2,2.5,100.5,90,220,91\n1,,,,,,,100,90,220,91\n2,,,,,,,,,,\n")
}

fn truth_of_two() -> String {
    let mut recording = stick_wave(1, 15.0, 1.0, 3.0).expect("it is built in").recording;
    recording.joints_m.truncate(2);
    truth::truth_csv(&StereoScene::new(recording, StereoOptions::default()).expect("it is built in"))
}

fn stick(bytes: &[u8]) {
    let Ok(frames) = read_stick(&file("stick.csv", bytes)) else { return };
    let ends = frames.iter().filter_map(|frame| frame.ends_m).flatten();
    assert!(ends.into_iter().all(|end_m| end_m.iter().all(|coordinate| coordinate.is_finite())), "an end");
}

fn true_frames(bytes: &[u8]) {
    let Ok(frames) = read_truth(&file("truth.csv", bytes)) else { return };
    let joints = frames.iter().flat_map(|frame| frame.joints_m).flatten();
    assert!(joints.into_iter().all(|joint_m| joint_m.iter().all(|coordinate| coordinate.is_finite())), "a joint");
}

fn pixels(bytes: &[u8]) {
    let Ok(pixels) = labelled_pixels::read(&file("pixels.txt", bytes)) else { return };
    assert!(pixels.unique.len() <= pixels.row_count && pixels.unique.is_sorted());
}
