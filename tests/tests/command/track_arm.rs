//! `sinew track arm` as a user types it: what it writes, and that nothing that was finished is
//! lost.

use assert_cmd::Command;
use image::{Rgb, RgbImage};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use sinew_tests::{shared_data, sinew_command};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// `sinew track arm FOLDER --out OUT`.
fn track(folder: &Path, out: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.args(["track", "arm"]).arg(folder).arg("--out").arg(out);
    command
}

/// A skin-coloured disc before a blue wall, its place moving with the frame.
fn picture(frame: u32, width: u32, height: u32) -> RgbImage {
    let (u, v) = (width / 4 + 2 * frame, height / 2);
    RgbImage::from_fn(width, height, |x, y| {
        let inside = x.abs_diff(u).pow(2) + y.abs_diff(v).pow(2) < (height / 8).pow(2);
        Rgb(if inside { [196, 140, 115] } else { [90, 120, 200] })
    })
}

/// A folder `in` with some frames, and the name of an output folder that does not exist.
fn scene(frames: u32) -> (TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    for frame in 0..frames {
        picture(frame, 96, 72).save(input.join(format!("f_{frame}.png"))).unwrap();
    }
    (root, input, out)
}

fn truncate(file: &Path) {
    let bytes = fs::read(file).unwrap();
    fs::write(file, &bytes[..bytes.len() / 2]).unwrap();
}

fn rows(out: &Path) -> Vec<csv::StringRecord> {
    csv::Reader::from_path(out.join("track.csv")).unwrap().records().map(Result::unwrap).collect()
}

fn column(out: &Path, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(out.join("track.csv")).unwrap();
    let index = reader.headers().unwrap().iter().position(|header| header == name).unwrap();
    reader.records().map(|row| row.unwrap()[index].to_owned()).collect()
}

fn report(out: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap()
}

fn names(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_folder_becomes_a_run_directory() {
    let (_root, input, out) = scene(12);
    fs::rename(input.join("f_3.png"), input.join("f_3.PNG")).unwrap();
    let summary = contains("tracked 12 of 12 frames of 96x72 pixels").and(contains("right arm:"));
    track(&input, &out).args(["--overlay", "--particles-csv"]).assert().success().stdout(summary).stderr(is_empty());
    let expected = ["contact_sheet.png", "hand.png", "overlay", "particles.csv", "run.json", "track.csv"];
    assert_eq!(names(&out), expected.map(String::from).into());
    assert_eq!(column(&out, "frame"), (0..12).map(|frame| frame.to_string()).collect::<Vec<_>>());
    assert_eq!(column(&out, "image")[9..], ["f_9.png", "f_10.png", "f_11.png"], "natural order");
    assert!(column(&out, "side").iter().all(|side| side == "right"));
    assert_eq!(names(&out.join("overlay")), (0..12).map(|frame| format!("f_{frame}.png")).collect());
    assert_eq!(image::image_dimensions(out.join("overlay/f_3.png")).unwrap(), (96, 72));
    let particles = fs::read_to_string(out.join("particles.csv")).unwrap();
    assert_eq!(particles.lines().count(), 1 + 12 * 50);
    let report = report(&out);
    assert_eq!((&report["complete"], &report["seed"]), (&true.into(), &1.into()));
    assert_eq!(report["options"]["config"]["tracker"]["particles"], 50);
    assert_eq!(report["inputs"]["files"].as_array().unwrap().len(), 12);
    assert!(report["frames_per_second"].as_f64().unwrap() > 0.0);
    let counts = report["status_counts"]["right"].as_object().unwrap();
    assert_eq!(counts.values().map(|count| count.as_u64().unwrap()).sum::<u64>(), 12);
}

#[test]
fn options_of_the_command_line_come_before_the_file() {
    let (root, input, out) = scene(2);
    let config = root.path().join("c.toml");
    fs::write(&config, "[tracker]\nparticles = 20\nvariant = \"standard\"\n").unwrap();
    let command = || {
        let mut command = track(&input, &out);
        command.arg("--config").arg(&config);
        command
    };
    command().assert().success();
    assert_eq!(report(&out)["options"]["config"]["tracker"]["particles"], 20);
    command().args(["--particles", "7", "--variant", "corrected"]).assert().success();
    let tracker = &report(&out)["options"]["config"]["tracker"];
    assert_eq!((&tracker["particles"], &tracker["variant"]), (&7.into(), &"corrected".into()));
}

#[test]
fn the_printed_configuration_is_accepted_and_changes_nothing() {
    let (root, input, out) = scene(5);
    let printed = Command::from_std(sinew_command()).args(["track", "arm", "--print-config"]).assert().success();
    let config = root.path().join("printed.toml");
    fs::write(&config, &printed.get_output().stdout).unwrap();
    track(&input, &out).assert().success();
    let without = fs::read(out.join("track.csv")).unwrap();
    track(&input, &out).arg("--config").arg(&config).assert().success();
    assert_eq!(fs::read(out.join("track.csv")).unwrap(), without);
}

#[test]
fn both_sides_are_two_rows_a_frame_left_first() {
    let (_root, input, out) = scene(4);
    track(&input, &out).args(["--side", "both"]).assert().success();
    assert_eq!(column(&out, "side"), ["left", "right"].repeat(4));
    assert_eq!(column(&out, "frame"), ["0", "0", "1", "1", "2", "2", "3", "3"]);
}

#[test]
fn every_variant_answers_every_frame() {
    let (_root, input, out) = scene(3);
    for variant in ["pik", "pik-weighted", "bootstrap", "corrected", "standard"] {
        track(&input, &out).args(["--variant", variant]).assert().success();
        assert_eq!(rows(&out).len(), 3, "{variant}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (root, input, _) = scene(40);
    let read = |threads: &str| {
        let out = root.path().join(threads);
        let options = ["--side", "both", "--overlay", "--particles-csv"];
        track(&input, &out).args(options).env("RAYON_NUM_THREADS", threads).assert().success();
        let files = ["track.csv", "particles.csv", "contact_sheet.png", "overlay/f_39.png", "hand.png"];
        files.map(|file| fs::read(out.join(file)).unwrap())
    };
    assert!(read("1") == read("2"));
}

#[test]
fn another_seed_gives_another_track() {
    let (_root, input, out) = scene(4);
    let read = |seed: &str| {
        track(&input, &out).args(["--seed", seed, "--particles-csv"]).assert().success();
        fs::read(out.join("particles.csv")).unwrap()
    };
    let first = read("1");
    assert!(first == read("1") && first != read("2"));
}

#[test]
fn a_truncated_image_among_others_is_a_missing_frame() {
    let (_root, input, out) = scene(6);
    truncate(&input.join("f_2.png"));
    fs::write(input.join("f_4.png"), "no image").unwrap();
    let named = contains("f_2.png").and(contains("f_4.png"));
    let counted = contains("2 images are missing or could not be read");
    track(&input, &out).arg("--overlay").assert().success().stderr(named).stdout(counted);
    let blob_counts = column(&out, "blob_count");
    assert_eq!(blob_counts.len(), 6);
    for (frame, count) in blob_counts.iter().enumerate() {
        assert_eq!(count.is_empty(), [2, 4].contains(&frame), "frame {frame}");
    }
    assert!(column(&out, "status")[2] != "tracking");
    let skipped = report(&out)["skipped"].as_array().unwrap().clone();
    assert_eq!((&skipped[0]["file"], &skipped[1]["frame"]), (&"f_2.png".into(), &4.into()));
    assert_eq!(names(&out.join("overlay")).len(), 4);
}

#[test]
fn images_that_are_all_skin_or_no_skin_or_one_pixel_are_tracked() {
    for (colour, size) in [([196, 140, 115], (64, 48)), ([0, 0, 0], (64, 48)), ([196, 140, 115], (1, 1))] {
        let (_root, input, out) = scene(0);
        for frame in 0..3 {
            RgbImage::from_pixel(size.0, size.1, Rgb(colour)).save(input.join(format!("{frame}.png"))).unwrap();
        }
        track(&input, &out).args(["--side", "both", "--overlay"]).assert().success().stderr(is_empty());
        assert_eq!(rows(&out).len(), 6, "{colour:?} {size:?}");
    }
}

#[test]
fn an_overlay_that_cannot_be_written_keeps_the_finished_frames() {
    let (_root, input, out) = scene(5);
    // A folder that holds something cannot be replaced by a file, whoever runs the test.
    fs::create_dir_all(out.join("overlay/f_3.png/inside")).unwrap();
    let message = contains("f_3.png").and(contains("the last checkpoint is kept")).and(contains("--resume"));
    track(&input, &out).arg("--overlay").assert().code(73).stderr(message);
    let litter = |name: &String| name.starts_with(".sinew");
    assert!(!names(&out).iter().any(litter) && !names(&out.join("overlay")).iter().any(litter));
    assert!(out.join("track.csv.partial").exists() && !out.join("track.csv").exists());
    fs::remove_dir_all(out.join("overlay/f_3.png")).unwrap();
    track(&input, &out).args(["--overlay", "--resume"]).assert().success();
    assert_eq!(rows(&out).len(), 5);
}

#[test]
#[cfg(unix)]
fn ctrl_c_keeps_the_frames_that_are_finished() {
    const FRAMES: usize = 1500;
    let (_root, input, out) = scene(0);
    let first = input.join("0.png");
    picture(3, 320, 240).save(&first).unwrap();
    for frame in 1..FRAMES {
        fs::copy(&first, input.join(format!("{frame}.png"))).unwrap();
    }
    let mut command = sinew_command();
    command.args(["track", "arm", "--overlay"]).arg(&input).arg("--out").arg(&out);
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
    // The first overlay shows that the run is under way; a run that ends without one fails below.
    while !out.join("overlay/0.png").exists() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("interrupted after"), "{message}");
    let finished = rows(&out).len();
    assert!((1..FRAMES).contains(&finished), "{finished} frames");
    assert_eq!(report(&out)["frames_finished"], finished);
    assert_eq!(names(&out.join("overlay")).len(), finished);
}

#[test]
fn a_real_sequence_gets_a_row_a_frame_and_side() {
    let Some(folder) = shared_data("video/handtracking/hand1") else { return };
    let (_root, _, out) = scene(0);
    track(&folder, &out).args(["--side", "both"]).assert().success().stderr(is_empty());
    let report = report(&out);
    assert_eq!(rows(&out).len(), 2 * report["frames"].as_u64().unwrap() as usize);
    assert!(column(&out, "blob_count").iter().skip(4).all(|count| count.parse::<usize>().unwrap() > 0));
}
