//! `sinew simulate stereo` as a user types it.

use assert_cmd::Command;
use predicates::str::contains;
use sinew::body::{BodyFile, BodyRecording, BodyRecordingOptions, fit_recording, measure};
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_JOINT_NAMES, full_body};
use sinew_tests::{shared_data, sinew_command};
use std::fs;
use std::path::Path;

fn simulate(out: &Path, motion: &str, words: &[&str]) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.args(["simulate", "stereo", "--motion", motion, "--out"]).arg(out).args(words);
    command
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap()
}

#[test]
fn the_stick_has_points_truth_pose_and_ends_in_space_and_pixels() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("out");
    simulate(&out, "stick-wave", &["--rate", "5", "--points", "300"]).assert().success().stdout(contains("100 frames"));
    assert_eq!(fs::read_dir(out.join("points")).unwrap().count(), 100);
    let cloud = sinew::cloud::read(&out.join("points/000099.ply")).unwrap();
    assert!((290..=300).contains(&cloud.points_m.len()), "{}", cloud.points_m.len());
    let truth = sinew::stereo::read_truth(&out.join("truth.csv")).unwrap();
    let stick = sinew::stereo::read_stick(&out.join("stick.csv")).unwrap();
    assert_eq!((truth.len(), stick.len()), (100, 100));
    for (truth, stick) in truth.iter().zip(&stick) {
        let [a, b] = stick.ends_m.unwrap();
        let along = (b - a).normalize();
        for wrist in [5, 8] {
            let from_end = truth.joints_m[wrist].unwrap() - a;
            assert!((from_end - along * from_end.dot(&along)).norm() < 1.0e-4, "the hand is on the stick");
        }
        assert!(stick.ends_px.is_some());
    }
    let pose = sinew::body::pose_file::read_pose(&out.join("first_pose.json")).unwrap();
    let size = BodyFile::read(&out.join("body.json")).unwrap();
    let skeleton = full_body(&size.measures).unwrap();
    let ends = posture(&skeleton, &Vec3::zeros(), &pose).ends;
    for (end, wanted) in ends.iter().zip(&truth[0].joints_m) {
        assert!((end - wanted.unwrap()).norm() < 0.01);
    }
    let run: serde_json::Value = serde_json::from_slice(&bytes(&out, "run.json")).unwrap();
    assert_eq!((run["complete"].as_bool(), run["frames"].as_u64()), (Some(true), Some(100)));
}

#[test]
fn the_same_seed_gives_the_same_points_whatever_the_threads_and_what_is_hidden() {
    let root = tempfile::tempdir().unwrap();
    let make = |name: &str, words: &[&str], threads: &str| {
        let out = root.path().join(name);
        let words = [&["--rate", "2", "--points", "500"], words].concat();
        simulate(&out, "pelvic-lift", &words).env("RAYON_NUM_THREADS", threads).assert().success();
        out
    };
    let (one, two) = (make("a", &[], "1"), make("b", &[], "2"));
    for name in ["points/000003.ply", "truth.csv", "first_pose.json"] {
        assert!(bytes(&one, name) == bytes(&two, name), "{name}");
    }
    let other = make("c", &["--seed", "2"], "2");
    assert!(bytes(&one, "points/000003.ply") != bytes(&other, "points/000003.ply"));
    let hidden = make("d", &["--hide", "r_leg:3-4"], "2");
    assert!(bytes(&one, "points/000005.ply") == bytes(&hidden, "points/000005.ply"));
    let count = |folder: &Path| sinew::cloud::read(&folder.join("points/000003.ply")).unwrap().points_m.len();
    assert!(count(&hidden) < count(&one));
}

#[test]
fn what_cannot_be_used_is_refused_with_a_remedy() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("out");
    let cases: [(&str, &[&str], &str); 7] = [
        ("stick-wave", &["--outliers", "2"], "`outliers` has to be from 0 to 1"),
        ("stick-wave", &["--rate", "0"], "--rate has to be greater than zero"),
        ("stick-wave", &["--hide", "arm:1-2"], "l_arm:30-44"),
        ("stick-wave", &["--rate", "2", "--hide", "l_arm:1-400"], "--hide names frame 400; the last one is 39"),
        ("pelvic-lift", &["--between", "0,1"], "are for motion files"),
        ("pelvic-lift", &["--distance", "0.2"], "--distance has to be from 1 to 20"),
        ("missing.bvh", &[], "missing.bvh"),
    ];
    for (motion, words, message) in cases {
        simulate(&out, motion, words).assert().failure().stderr(contains(message));
    }
    assert!(!out.exists(), "nothing was written");
    simulate(&out, "pelvic-lift", &["--rate", "2"]).assert().success();
    simulate(&out, "pelvic-lift", &["--rate", "2"]).assert().failure().stderr(contains("--force"));
    simulate(&out, "pelvic-lift", &["--rate", "1", "--force"]).assert().success();
    assert_eq!(fs::read_dir(out.join("points")).unwrap().count(), 13, "the old points are gone");
}

/// Largest mean distance of a joint from the recorded one that docs/simulation.md states, metres.
const LARGEST_MEAN_M: f32 = 0.015;

#[test]
fn recorded_people_stand_before_the_camera_and_move_as_the_skeleton_can() {
    let asf = shared_data("mocap/cmu-walk/35/35.asf");
    for name in [
        "bandai/dataset-2_wave-both-hands_normal_001.bvh",
        "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
        "cmu-exercise/13_29.amc",
        "cmu-expmap/train_directing_traffic_1.txt",
        "hdm05/HDM_dg_06-03_03_120.c3d",
    ] {
        let Some(file) = shared_data(&format!("mocap/{name}")) else { return };
        let options = BodyRecordingOptions { skeleton: asf.as_deref(), ..BodyRecordingOptions::default() };
        let recording = BodyRecording::read(&file, &options).unwrap();
        let pelvis_z = recording.joints_m.iter().filter_map(|joints| Some(joints[0]?.z));
        assert!(pelvis_z.fold(f32::INFINITY, f32::min) > 2.0 - 1.0e-3, "{name}");
        let skeleton = full_body(&measure(&recording).unwrap()).unwrap();
        let fits = fit_recording(&skeleton, &recording);
        for (bone, joint) in BODY_JOINT_NAMES.iter().enumerate() {
            let distances: Vec<f32> = fits.iter().filter_map(|fit| fit.residual_m[bone]).collect();
            let mean_m = distances.iter().sum::<f32>() / distances.len() as f32;
            assert!(mean_m < LARGEST_MEAN_M, "{name}: {joint} is {mean_m} m off");
        }
        assert!(fits.iter().all(|fit| skeleton.clamp(fit.angles) == fit.angles));
    }
}
