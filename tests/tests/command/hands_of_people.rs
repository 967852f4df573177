//! `sinew track arm` on a person before a webcam whose face is in view.

use sinew::config::Config;
use sinew::track::{Event, FrontEnd, SideChoice, TrackOptions, TrackRun};
use sinew_core::camera::Pixel;
use sinew_lab::people::reference::{Palm, read};
use sinew_tests::{shared_data, table_rows};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

fn options(video: &Path) -> TrackOptions {
    TrackOptions {
        folder: video.to_owned(),
        side: SideChoice::Both,
        rate_hz: 30.0,
        seed: 1,
        skin: "gaussian".to_owned(),
        calibrate: None,
        front_end: FrontEnd::Pictures,
        hands: None,
        head: None,
        face: true,
        overlay: false,
        particles_csv: false,
        strict: false,
        config: Config::default(),
    }
}

fn run(options: TrackOptions, out: &Path) {
    TrackRun::prepare(options, out).unwrap().run(&AtomicBool::new(false), &mut |_| ()).unwrap();
}

/// Of the rows that say `tracking` where both palms are known: how many lie on one, and all.
fn on_palms(track: &Path, points: &Path) -> [usize; 2] {
    let frames = read(points).unwrap();
    let mut counts = [0; 2];
    for row in table_rows(track).iter().filter(|row| row["status"] == "tracking") {
        let palms: Vec<Palm> = frames[row["frame"].parse::<usize>().unwrap()].palms().collect();
        let [Ok(u_px), Ok(v_px)] = ["hand_u_px", "hand_v_px"].map(|column| row[column].parse()) else { continue };
        if palms.len() == 2 {
            counts[0] += usize::from(palms.iter().any(|palm| palm.holds(Pixel::new(u_px, v_px))));
            counts[1] += 1;
        }
    }
    counts
}

#[test]
fn a_person_with_bare_arms_is_tracked_by_default() {
    let Some(clips) = shared_data("video/asl") else { return };
    let folder = tempfile::tempdir().unwrap();
    run(options(&clips.join("milk.mkv")), folder.path());
    let [on, all] = on_palms(&folder.path().join("track.csv"), &clips.join("milk_points.csv"));
    assert!(all > 60 && on * 100 > 90 * all, "{on} of {all} rows lie on a palm");
    let without = tempfile::tempdir().unwrap();
    run(TrackOptions { face: false, ..options(&clips.join("milk.mkv")) }, without.path());
    let [on, all] = on_palms(&without.path().join("track.csv"), &clips.join("milk_points.csv"));
    assert!(on * 2 < all, "without the face {on} of {all} rows lie on a palm");
}

#[test]
fn lines_of_a_camera_show_the_same_person() {
    let Some(clips) = shared_data("video/asl") else { return };
    let folder = tempfile::tempdir().unwrap();
    run(TrackOptions { front_end: FrontEnd::Lines, ..options(&clips.join("milk.mkv")) }, folder.path());
    let [on, all] = on_palms(&folder.path().join("track.csv"), &clips.join("milk_points.csv"));
    assert!(all > 45 && on * 100 > 80 * all, "{on} of {all} rows lie on a palm");
}

#[test]
fn a_run_that_was_broken_off_goes_on_to_the_same_bytes() {
    goes_on(FrontEnd::Pictures);
}

#[test]
fn a_run_by_lines_that_was_broken_off_goes_on_to_the_same_bytes() {
    goes_on(FrontEnd::Lines);
}

fn goes_on(front_end: FrontEnd) {
    let Some(clips) = shared_data("video/asl") else { return };
    let (whole, broken) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let options = TrackOptions { front_end, ..options(&clips.join("eat.mkv")) };
    run(options.clone(), whole.path());
    // In the first part, and while the answer about a second face is awaited.
    for last in [7, 34] {
        let stop = AtomicBool::new(false);
        let run = TrackRun::prepare(options.clone(), broken.path()).unwrap();
        let ended = run.run(&stop, &mut |event| {
            if matches!(event, Event::Finished(count) if count == last) {
                stop.store(true, Ordering::Relaxed);
            }
        });
        assert!(ended.is_err());
        let resumed = TrackRun::resume(options.clone(), broken.path()).unwrap();
        assert_eq!(resumed.frames_finished(), last);
        resumed.run(&AtomicBool::new(false), &mut |_| ()).unwrap();
        let [a, b] = [&whole, &broken].map(|folder| fs::read(folder.path().join("track.csv")).unwrap());
        assert!(a == b, "broken off after {last} frames");
    }
}
