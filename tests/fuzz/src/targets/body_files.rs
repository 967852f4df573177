//! Readers of a person's measures and of poses.

use crate::Target;
use crate::file::file;
use sinew::body::pose_file::{pose_json, read_pose};
use sinew::body::run::measures_source::read_measures;
use sinew::body::{BodyFile, BodyRecording, BodyRecordingOptions, BodySize, measure};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};
use std::path::Path;

/// `body.json`, `first_pose.json`, and bodies measured from a motion.
pub const TARGETS: &[Target] = &[
    Target { name: "body_file", run: body, seeds: || vec![body_json()] },
    Target { name: "pose_file", run: pose, seeds: || vec![pose_json(&[0.25; BODY_ANGLES]).into_bytes()] },
    Target { name: "body_recording", run: recording, seeds: || vec![stick_figure().into_bytes()] },
];

fn size_of(path: &Path) -> Option<BodySize> {
    read_measures(path, false, &mut Vec::new()).ok()
}

fn body_json() -> Vec<u8> {
    let measures = BodyMeasures::of_height(1.7).expect("a usual height");
    serde_json::to_vec_pretty(&BodyFile::from(&measures)).expect("memory takes it")
}

fn body(bytes: &[u8]) {
    let Some(size) = size_of(&file("body.json", bytes)) else { return };
    full_body(&size.measures).expect("measures that were read make a skeleton");
    let text = serde_json::to_vec(&BodyFile::from(&size)).expect("memory takes it");
    let again = size_of(&file("again.json", &text)).expect("it was written");
    assert_eq!(again, size, "as it was written");
}

fn pose(bytes: &[u8]) {
    let Ok(angles) = read_pose(&file("pose.json", bytes)) else { return };
    let again = read_pose(&file("again.json", pose_json(&angles).as_bytes())).expect("it was written");
    assert_eq!(again, angles, "as it was written");
}

/// Two frames of a whole body as TRC, millimetres.
fn stick_figure() -> String {
    let joints: [(&str, [i32; 3]); 16] = [
        ("Hips", [0, 900, 0]),
        ("LHip", [90, 880, 0]),
        ("RHip", [-90, 880, 0]),
        ("LKnee", [95, 470, 20]),
        ("RKnee", [-95, 470, 20]),
        ("LAnkle", [95, 60, 0]),
        ("RAnkle", [-95, 60, 0]),
        ("LBigToe", [100, 20, 150]),
        ("RBigToe", [-100, 20, 150]),
        ("Neck", [0, 1420, 0]),
        ("LShoulder", [180, 1400, 0]),
        ("RShoulder", [-180, 1400, 0]),
        ("LElbow", [200, 1100, 10]),
        ("RElbow", [-200, 1100, 10]),
        ("LWrist", [210, 850, 40]),
        ("RWrist", [-210, 850, 40]),
    ];
    let names: Vec<String> = joints.iter().map(|(name, _)| format!("{name}\t\t")).collect();
    let numbers: Vec<String> = joints.iter().map(|(_, [x, y, z])| format!("{x}\t{y}\t{z}")).collect();
    let count = joints.len();
    format!(
        "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n60\t60\t2\t{count}\tmm\n\
        Frame#\tTime\t{}\n\t\tX1\tY1\tZ1\n\n1\t0.0\t{row}\n2\t0.016\t{row}\n",
        names.join("\t"),
        row = numbers.join("\t")
    )
}

fn recording(bytes: &[u8]) {
    let path = file("body.trc", bytes);
    if let Ok(recording) = BodyRecording::read(&path, &BodyRecordingOptions::default()) {
        let _ = measure(&recording);
    }
    let _ = size_of(&path);
}
