//! Readers of keypoints in pictures.

use crate::Target;
use crate::file::{file, folder};
use serde_json::json;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::keypoints::{TrackOptions, read, track};
use std::fs;

/// JSON in its forms, folders of OpenPose files, and tables.
pub const TARGETS: &[Target] = &[
    Target { name: "keypoints_json", run: |bytes| keypoints("k.json", bytes), seeds: jsons },
    Target { name: "keypoints_csv", run: |bytes| keypoints("k.csv", bytes), seeds: || vec![table().into_bytes()] },
    Target { name: "openpose_folder", run: openpose, seeds: || jsons().split_off(3) },
];

fn points() -> Vec<f64> {
    (0..17).flat_map(|i| [100.0 + f64::from(i * i % 7), 50.0 + 9.0 * f64::from(i), 0.9]).collect()
}

fn jsons() -> Vec<Vec<u8>> {
    let pairs: Vec<[f64; 2]> = points().chunks(3).map(|point| [point[0], point[1]]).collect();
    let people = |count: usize| {
        let numbers: Vec<f64> = points().into_iter().cycle().take(3 * count).collect();
        json!({ "version": 1.3, "people": [{ "pose_keypoints_2d": numbers }, { "pose_keypoints_2d": [] }] })
    };
    [
        json!([{ "image_id": 4, "category_id": 1, "keypoints": points(), "score": 0.9 }, { "image_id": "f_5.png", "keypoints": points() }]),
        json!({
            "images": [{ "id": 70, "file_name": "f_2.png" }, { "id": 71, "file_name": "f_3.png" }],
            "annotations": [{ "image_id": 71, "keypoints": points() }],
        }),
        json!({ "instance_info": [{ "frame_id": 1, "instances": [{ "keypoints": pairs, "keypoint_scores": vec![0.7; 17] }] }] }),
        people(25),
        people(18),
        json!([points(), points()]),
    ]
    .map(|value| value.to_string().into_bytes())
    .to_vec()
}

fn table() -> String {
    let columns = ["nose", "left_shoulder", "right_shoulder", "left_hip", "right_hip", "left_knee", "right_knee"];
    let header: Vec<String> =
        columns.iter().flat_map(|name| ["x", "y", "confidence"].map(|axis| format!("{name}_{axis}"))).collect();
    let row = |frame: u32| format!("{frame}{}\n", ",50.5,20,0.8".repeat(columns.len()));
    format!("frame,{}\n{}{}", header.join(","), row(1), row(3))
}

fn keypoints(name: &str, bytes: &[u8]) {
    let path = file(name, bytes);
    if let Ok(found) = read(&path, None) {
        let people = found.frames.iter().flat_map(|frame| &frame.people);
        let is_sound = |point: f64| point.is_finite();
        assert!(people.flatten().all(|keypoint| keypoint.position_px.into_iter().all(is_sound)), "a keypoint");
        let _ = track(&found, &TrackOptions::default(), &path);
    }
    if let Ok(recorded) = angles(&path, &RecordingOptions::default()) {
        let rows = recorded.table.rows().iter();
        assert!(rows.flat_map(|row| row.angles_rad).flatten().all(f64::is_finite), "an angle");
    }
}

/// The bytes as two of three frames.
fn openpose(bytes: &[u8]) {
    let frames = folder().join("openpose");
    fs::create_dir_all(&frames).expect("a temporary folder");
    for name in ["openpose/f_1_keypoints.json", "openpose/f_3_keypoints.json"] {
        let _ = file(name, bytes);
    }
    if let Ok(found) = read(&frames, None) {
        let _ = track(&found, &TrackOptions::default(), &frames);
    }
}
