//! Keypoints of one walk in the forms of many detectors, and with what goes wrong with them.

use sinew::cyclic::recording::{RecordedAngles, RecordingOptions, all_angles, angles};
use sinew::keypoints::{self, DEFAULT_MIN_CONFIDENCE, Detections, Facing, TrackOptions};
use sinew_tests::shared_data;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

fn case(name: &str) -> Option<PathBuf> {
    shared_data(&format!("cases/keypoints/{name}"))
}

fn options() -> RecordingOptions {
    RecordingOptions { min_confidence: DEFAULT_MIN_CONFIDENCE, ..RecordingOptions::default() }
}

fn read(path: &Path) -> Detections {
    keypoints::read(path, None).unwrap()
}

fn recorded(path: &Path, options: &RecordingOptions) -> RecordedAngles {
    angles(path, options).unwrap()
}

/// Angles of upper arms, forearms, thighs and shanks. The others need a neck, of which some forms
/// have one of their own.
const LIMBS: [usize; 8] = [2, 3, 5, 6, 8, 9, 11, 12];

/// Largest difference of the limbs' angles in frames that both have, after `shift` frames, radians;
/// and how many frames that are.
fn apart(found: &RecordedAngles, wanted: &RecordedAngles, shift: i64) -> (f64, usize) {
    let (mut largest, mut count) = (0.0_f64, 0);
    for row in found.table.rows() {
        let other = row.frame.checked_add_signed(shift).and_then(|frame| wanted.table.row(frame));
        let Some(other) = other else { continue };
        count += 1;
        let both = LIMBS.map(|limb| Some(row.angles_rad[limb]? - other.angles_rad[limb]?));
        assert!(both.iter().flatten().count() >= 4, "frame {}: {both:?}", row.frame);
        let off = |difference: &f64| ((difference + PI).rem_euclid(TAU) - PI).abs();
        largest = both.iter().flatten().map(off).fold(largest, f64::max);
    }
    (largest, count)
}

/// Two decimals of a pixel on a hand's breadth.
const ROUNDED_RAD: f64 = 1.0e-3;

#[test]
fn a_clean_recording_has_neither_notes_nor_doubts() {
    let Some(base) = case("base") else { return };
    let found = read(&base);
    assert_eq!((found.frames.len(), found.layout.as_str(), found.rate_hz), (90, "COCO, 17 points", None));
    let track = keypoints::track(&found, &TrackOptions::default(), &base).unwrap();
    assert_eq!(
        (track.mended.frames, track.facing, track.doubts.len()),
        (0, Some(Facing::Right), 0),
        "{:?}",
        track.doubts
    );
    assert_eq!(recorded(&base, &options()).notes, [""; 0]);
}

#[test]
fn the_same_walk_in_other_forms_gives_the_same_angles() {
    let Some(truth) = case("mediapipe_confidence.csv") else { return };
    let wanted = recorded(&truth, &options());
    assert_eq!((wanted.table.rows().len(), read(&truth).rate_hz), (266, None));
    for (name, frames) in [
        ("mediapipe_visibility.csv", 266),
        ("semicolon.csv", 266),
        ("frame_float.csv", 266),
        ("dlc.csv", 266),
        ("y_up.csv", 266),
        ("base", 90),
        ("body25b", 90),
        ("mmpose_list.json", 266),
    ] {
        let path = case(name).unwrap();
        let found = recorded(&path, &options());
        let (largest, both) = apart(&found, &wanted, 0);
        assert_eq!((found.table.rows().len(), both), (frames, frames), "{name}");
        assert!(largest < ROUNDED_RAD, "{name}: {largest}");
    }
}

#[test]
fn shares_of_the_picture_need_its_size() {
    let (Some(table), Some(folder)) = (case("mediapipe_norm.csv"), case("yolo_txt")) else { return };
    let wanted = recorded(&case("mediapipe_confidence.csv").unwrap(), &options());
    let sized = RecordingOptions { image_size_px: Some([1920.0, 1080.0]), ..options() };
    // YOLO counts frames from 1.
    for (path, shift, frames) in [(&table, 0, 266), (&folder, -1, 90)] {
        let message = angles(path, &options()).unwrap_err().to_string();
        assert!(message.contains("--image-size WIDTH,HEIGHT"), "{message}");
        let found = recorded(path, &sized);
        let (largest, both) = apart(&found, &wanted, shift);
        assert_eq!((found.table.rows().len(), both), (frames, frames));
        assert!(largest < 2.0 * ROUNDED_RAD, "{}: {largest}", path.display());
        assert!(found.notes[0].contains("1920 x 1080"));
    }
}

#[test]
fn y_that_points_up_is_turned_over_with_a_note() {
    let Some(path) = case("y_up.csv") else { return };
    let notes = recorded(&path, &options()).notes;
    assert!(notes[0].contains("y points up") && notes[0].contains("266 of 266"), "{notes:?}");
}

#[test]
fn points_of_body_25b_are_known_by_where_they_lie() {
    let Some(path) = case("body25b") else { return };
    let found = read(&path);
    assert_eq!(found.layout, "OpenPose BODY_25B, 25 points");
    assert!(found.notes[0].contains("BODY_25B") && found.doubts.is_empty(), "{found:?}");
}

#[test]
fn numbers_and_times_show_missing_frames() {
    let (Some(names), Some(times)) = (case("name_number_first"), case("timestamp_vfr.csv")) else { return };
    let found = read(&names);
    let files = std::fs::read_dir(&names).unwrap().count();
    let (first, last) = (found.frames[0].frame, found.frames[found.frames.len() - 1].frame);
    assert_eq!((found.frames.len(), first, last), (files, 1, 134));
    let wanted = recorded(&case("mediapipe_confidence.csv").unwrap(), &options());
    assert!(apart(&recorded(&names, &options()), &wanted, 0).0 < ROUNDED_RAD);

    let found = recorded(&times, &options());
    assert_eq!((found.rate_hz, found.table.rows().len()), (Some(30.0), 177));
    let last = found.table.rows().last().unwrap().frame;
    assert_eq!(last, 264, "a third of the rows is missing");
    assert!(apart(&found, &recorded(&case("frame_float.csv").unwrap(), &options()), 1).0 < ROUNDED_RAD);
    let other = RecordingOptions { input_rate_hz: Some(60.0), ..options() };
    let message = angles(&times, &other).unwrap_err().to_string();
    assert!(message.contains("`--input-rate 60`") && message.contains("30.00 frames per second"), "{message}");
    let near = RecordingOptions { input_rate_hz: Some(29.97), ..options() };
    assert_eq!(recorded(&times, &near).rate_hz, Some(30.0));
}

#[test]
fn exchanged_legs_are_mended_and_counted() {
    let Some(path) = case("lr_swap") else { return };
    let track = keypoints::track(&read(&path), &TrackOptions::default(), &path).unwrap();
    assert!(track.mended.legs.abs_diff(24) <= 2 && track.mended.arms == 0, "{:?}", track.mended);
    let (found, wanted) = (recorded(&path, &options()), recorded(&case("base").unwrap(), &options()));
    assert!(found.notes[0].contains("were mended in"), "{:?}", found.notes);
    let [index, right] = [&found, &wanted].map(hip_index);
    assert!((index - right).abs() < 5.0, "{index} for {right}");
    let wrong = found.table.rows().iter().zip(wanted.table.rows());
    let wrong = wrong.filter(|(a, b)| a.angles_rad.iter().zip(&b.angles_rad).any(|(a, b)| a != b)).count();
    assert!(wrong <= 2, "{wrong} frames differ");
}

/// Symmetry index of the ranges of both thighs, percent.
fn hip_index(recorded: &RecordedAngles) -> f64 {
    let range = |angle: usize| {
        let angles = recorded.table.rows().iter().filter_map(|row| row.angles_rad[angle]);
        let (low, high) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    };
    let (left, right) = (range(8), range(11));
    200.0 * (left - right) / (left + right)
}

#[test]
fn a_camera_that_pans_and_a_turn_are_doubted() {
    let (Some(pan), Some(base)) = (case("pan"), case("base")) else { return };
    let track = keypoints::track(&read(&pan), &TrackOptions::default(), &pan).unwrap();
    assert_eq!(track.facing, Some(Facing::Right));
    assert!(track.doubts.len() == 1 && track.doubts[0].contains("the camera pans"), "{:?}", track.doubts);
    assert!(apart(&recorded(&pan, &options()), &recorded(&base, &options()), 0).0 < ROUNDED_RAD);

    // The walk, and from its middle on the way back as in a mirror.
    let mut turned = read(&base);
    let middle_px = turned.frames[45].people[0][0].position_px[0];
    for keypoint in turned.frames[45..].iter_mut().flat_map(|frame| frame.people.iter_mut().flatten()) {
        keypoint.position_px[0] = 2.0 * middle_px - keypoint.position_px[0];
    }
    let track = keypoints::track(&turned, &TrackOptions::default(), &base).unwrap();
    assert!(track.doubts.iter().any(|doubt| doubt.contains("cut the recording there into two")), "{:?}", track.doubts);
}

#[test]
fn noise_changes_no_sides_and_raises_no_doubt() {
    let Some(base) = case("base") else { return };
    for noise_px in [1.0, 2.0, 3.0] {
        let mut seed = 7_u32;
        let mut random = || {
            // Twelve even numbers: near to a normal one.
            let mut sum = -6.0;
            for _ in 0..12 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                sum += f64::from(seed >> 8) / f64::from(1_u32 << 24);
            }
            noise_px * sum
        };
        let mut noisy = read(&base);
        for keypoint in noisy.frames.iter_mut().flat_map(|frame| frame.people.iter_mut().flatten()) {
            keypoint.position_px = keypoint.position_px.map(|coordinate| coordinate + random());
        }
        let track = keypoints::track(&noisy, &TrackOptions::default(), &base).unwrap();
        assert_eq!(
            (track.mended.frames, track.doubts.len()),
            (0, 0),
            "{noise_px} px: {:?} {:?}",
            track.mended,
            track.doubts
        );
    }
}

#[test]
fn everybody_gets_a_table() {
    let Some(base) = case("base") else { return };
    assert_eq!(all_angles(&base, &options()).unwrap(), [recorded(&base, &options())]);
}
