//! The first pose of a body, found in the points of one frame, whichever way the person faces
//! (docs/measurements_scenes.md). Runs in release where `../shared/data` is at hand.

use crate::shared_data;

use rayon::prelude::*;
use sinew::body::BodyPart;
use sinew::body::tracking::{BodyStreamOptions, start::pose_from_points};
use sinew::cloud::blocks_of;
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_BONES, full_body};
use sinew_lab::body::MotionChoice;
use std::path::Path;
use std::str::FromStr;

/// Arms over standing legs, and two walks: no number of the search was chosen on these people.
const MOTIONS: [&str; 3] =
    ["cmu-expmap/train_directing_traffic_1.txt@0-8", "cmu-walk/02/02_01.amc", "cmu-walk/35/35_01.amc"];
/// Headings of each motion.
const HEADINGS: usize = 4;
/// A start is right whose joints are so far off on the mean, metres. Chosen: the tracker closes in
/// from there.
const RIGHT_M: f32 = 0.15;
/// Share of the starts that are right, of 24.
const RIGHT_SHARE: std::ops::RangeInclusive<f32> = 0.85..=1.0;

/// Mean distances of the joints from the true ones, metres: in the first and the middle frame of a
/// motion whose person is turned by `heading_rad`.
fn starts_m(path: &Path, heading_rad: f32) -> [f32; 2] {
    let motion = MotionChoice::from_str(&path.display().to_string()).unwrap();
    let seen = motion.read_turned(None, heading_rad, false).unwrap().seen(BodyPart::Whole, 1).unwrap();
    let tuning = BodyStreamOptions::default().tuning;
    [0, seen.clouds_m.len() / 2].map(|frame| {
        let points_m = &seen.clouds_m[frame];
        let blocks = blocks_of(&mut points_m.clone(), tuning.range_smoothing().unwrap().as_ref());
        let points = &tuning.guided_points;
        let pose = pose_from_points(BodyPart::Whole, &seen.measures.into(), points, points_m, &blocks).unwrap();
        let ends = posture(&full_body(&seen.measures).unwrap(), &Vec3::zeros(), &pose.angles_rad).ends;
        let off_m: Vec<f32> =
            (0..BODY_BONES).filter_map(|bone| Some((ends[bone] - seen.joints_m[frame][bone]?).norm())).collect();
        off_m.iter().sum::<f32>() / off_m.len() as f32
    })
}

#[test]
fn most_first_poses_are_right_whichever_way_people_face() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let mut cases = Vec::new();
    for motion in MOTIONS {
        for heading in 0..HEADINGS {
            cases.push((data.join(motion), std::f32::consts::TAU * heading as f32 / HEADINGS as f32));
        }
    }
    let found_m: Vec<[f32; 2]> = cases.par_iter().map(|(path, heading_rad)| starts_m(path, *heading_rad)).collect();
    let all: Vec<f32> = found_m.concat();
    let right = all.iter().filter(|off_m| **off_m < RIGHT_M).count() as f32 / all.len() as f32;
    println!("first poses: {:.0} % right; {found_m:.2?}", 100.0 * right);
    assert!(RIGHT_SHARE.contains(&right), "{right}: {found_m:?}");
}
