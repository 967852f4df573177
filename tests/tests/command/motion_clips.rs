//! Recorded motion, where the recordings are beside the project. Without them these tests say that
//! they are skipped.

use sinew::motion::{self, ArmSide, ReadOptions, clips, landmarks::Arm};
use sinew::scene::{Scene, SceneOptions, Sides};
use std::path::{Path, PathBuf};

fn recordings() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/mocap");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no recordings in {}", folder.display());
    None
}

#[test]
fn every_clip_has_a_busy_arm() {
    let Some(folder) = recordings() else { return };
    let found = clips::available(&folder);
    assert!(found.len() >= 6, "{} clips", found.len());
    for clip in found {
        let motion = clip.read(&folder).unwrap().resampled(15.0).unwrap();
        let hands: Vec<_> = motion.side(clip.side).iter().map(|d| d.upper_arm * 0.33 + d.forearm * 0.35).collect();
        let path_m: f32 = hands.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        let speed = path_m * 15.0 / hands.len() as f32;
        assert!((0.5..4.0).contains(&speed), "{}: the hand moves {speed} m/s", clip.name);
    }
}

#[test]
fn recorded_arms_have_the_size_of_an_adult_s() {
    let Some(folder) = recordings() else { return };
    for (file, skeleton) in [
        ("bandai/dataset-2_wave-both-hands_normal_001.bvh", None),
        ("pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", None),
        ("cmu-walk/35/35_01.amc", None),
        ("cmu-exercise/13_30.amc", Some("cmu-walk/35/35.asf")),
        ("hdm05/HDM_dg_06-03_03_120.amc", None),
    ] {
        let skeleton = skeleton.map(|skeleton| folder.join(skeleton));
        let options = ReadOptions { skeleton: skeleton.as_deref(), ..ReadOptions::default() };
        let motion = motion::read(&folder.join(file), &options).unwrap();
        for side in [ArmSide::Left, ArmSide::Right] {
            let arm = Arm::find(&motion, side).unwrap();
            let lengths_m = |frame: usize| {
                let positions = motion.frame(frame);
                let [shoulder, elbow, wrist] = [arm.shoulder, arm.elbow, arm.wrist].map(|joint| positions[joint]);
                [(elbow - shoulder).norm(), (wrist - elbow).norm()]
            };
            let (first, last) = (lengths_m(0), lengths_m(motion.len() - 1));
            for (length_m, later_m) in first.into_iter().zip(last) {
                assert!((0.15..0.40).contains(&length_m), "{file} {side:?}: a bone of {length_m} m");
                assert!((length_m - later_m).abs() < 1.0e-3, "{file} {side:?}: {length_m} becomes {later_m} m");
            }
        }
    }
}

#[test]
fn in_recorded_walks_the_arms_hang_beside_the_body() {
    let Some(folder) = recordings() else { return };
    for file in [
        "bandai/dataset-2_walk_normal_001.bvh",
        "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
        "cmu-walk/07/07_01.amc",
        "cmu-expmap/train_walking_1.txt",
    ] {
        let path = folder.join(file);
        let motion = motion::read(&path, &ReadOptions::default()).unwrap();
        let arms = motion::ArmMotion::from_motion(&motion, &path).unwrap();
        for side in [ArmSide::Left, ArmSide::Right] {
            let directions = arms.side(side);
            let mean_up = directions.iter().map(|d| d.upper_arm.y).sum::<f32>() / directions.len() as f32;
            let bend = directions.iter().map(|d| d.forearm.z - d.upper_arm.z).sum::<f32>() / directions.len() as f32;
            assert!(mean_up < -0.8, "{file} {side:?}: the upper arm points {mean_up} up");
            assert!(bend > 0.05, "{file} {side:?}: the forearm is bent {bend} to the front");
        }
    }
}

#[test]
fn clips_are_seen_through_the_camera() {
    let Some(folder) = recordings() else { return };
    for clip in clips::available(&folder) {
        let options = SceneOptions { frames: 120, sides: Sides::One(clip.side), ..SceneOptions::default() };
        let scene = Scene::new(&clip.read(&folder).unwrap(), &options).unwrap();
        let seen = (0..scene.len()).filter(|&frame| scene.truth(frame).sides[0].hand_visible).count();
        assert!((96..=108).contains(&seen), "{}: the hand is seen in {seen} of 120 frames", clip.name);
    }
}
