//! Videos in place of image folders. Needs `ffmpeg`; with `CI=true` a missing one is a failure.

use sinew::config::Config;
use sinew::images::{VideoFrames, load_rgb};
use sinew::track::{Event, FrontEnd, SideChoice, TrackOptions, TrackRun};
use sinew_tests::sinew_command;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

/// Frames of the scene, at 15 per second.
const FRAMES: usize = 30;

/// A rendered scene, or none where there is no ffmpeg to make a video of it.
fn scene() -> Option<TempDir> {
    let is_there = Command::new("ffmpeg").arg("-version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "ffmpeg is missing: `apt-get install ffmpeg` gives it");
        eprintln!("skipped: there is no ffmpeg");
        return None;
    }
    let root = tempfile::tempdir().unwrap();
    let made = sinew(root.path(), "simulate arm --motion builtin --frames 30 --out scene");
    assert!(made.status.success(), "{}", stderr(&made));
    Some(root)
}

/// Encodes the scene's frames.
fn encode(root: &Path, name: &str, options: &str) -> PathBuf {
    let mut ffmpeg = Command::new("ffmpeg");
    ffmpeg.args(["-nostdin", "-v", "error", "-framerate", "15", "-i", "scene/frames/frame_%04d.png"]);
    let output = ffmpeg.args(options.split_whitespace()).arg(name).current_dir(root).output().unwrap();
    assert!(output.status.success(), "{name}: {}", stderr(&output));
    root.join(name)
}

/// Every pixel as it was.
fn lossless(root: &Path) -> PathBuf {
    encode(root, "clip.mkv", "-c:v ffv1 -pix_fmt bgr0")
}

fn sinew(folder: &Path, words: &str) -> Output {
    sinew_command().current_dir(folder).args(words.split_whitespace()).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The rows of `track.csv` without the names of the images.
fn rows(run: &Path) -> Vec<Vec<String>> {
    let mut table = csv::Reader::from_path(run.join("track.csv")).unwrap();
    let without_name = |row: csv::StringRecord| {
        row.iter().enumerate().filter(|(column, _)| *column != 1).map(|(_, cell)| cell.to_owned()).collect()
    };
    table.records().map(|row| without_name(row.unwrap())).collect()
}

fn report(run: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(run.join("run.json")).unwrap()).unwrap()
}

#[test]
fn a_video_is_tracked_as_its_frames_are() {
    let Some(root) = scene() else { return };
    let root = root.path();
    lossless(root);
    let options = "--config scene/camera.toml --side both --overlay --out";
    for (input, run) in [("scene/frames", "of_folder"), ("clip.mkv", "of_video")] {
        let output = sinew(root, &format!("track arm {input} {options} {run}"));
        assert!(output.status.success() && stderr(&output).is_empty(), "{}", stderr(&output));
    }
    let (folder, video) = (root.join("of_folder"), root.join("of_video"));
    assert_eq!(rows(&folder), rows(&video));
    let report = report(&video);
    assert_eq!(
        (&report["complete"], &report["frames"], &report["frames_finished"]),
        (&true.into(), &30.into(), &30.into())
    );
    assert_eq!(report["inputs"]["files"][29], "clip_000029.png");
    assert_eq!(report["options"]["rate_hz"], 15.0);
    assert_eq!(fs::read_dir(video.join("overlay")).unwrap().count(), FRAMES);
    let page = sinew(root, "report of_video --out page.html");
    assert!(page.status.success() && !String::from_utf8_lossy(&page.stdout).contains("notice"), "{page:?}");

    let doctor = sinew(root, "doctor clip.mkv");
    let text = String::from_utf8_lossy(&doctor.stdout).into_owned();
    assert!(doctor.status.success() && text.contains("30 frames of 640x480 pixels, 15.000 per second"), "{text}");
}

#[test]
fn a_video_is_recorded_for_firmware_as_its_frames_are() {
    let Some(root) = scene() else { return };
    let root = root.path();
    let bytes = fs::read(lossless(root)).unwrap();
    for (input, run) in [("scene/frames", "of_folder"), ("clip.mkv", "of_video")] {
        let output = sinew(root, &format!("track arm {input} --config scene/camera.toml --out {run}"));
        assert!(output.status.success(), "{}", stderr(&output));
        for form in ["tracker", "camera"] {
            let output = sinew(root, &format!("record {run} --form {form} --out {run}.{form}"));
            assert!(output.status.success(), "{}", stderr(&output));
            assert!(String::from_utf8_lossy(&output.stdout).contains("of 30 frames"), "{output:?}");
        }
    }
    for form in ["tracker", "camera"] {
        let [folder, video] =
            ["of_folder", "of_video"].map(|run| fs::read(root.join(format!("{run}.{form}"))).unwrap());
        assert!(folder == video, "{form}");
    }
    fs::write(root.join("clip.mkv"), &bytes[..bytes.len() / 2]).unwrap();
    let refused = sinew(root, "record of_video --out broken");
    assert!(!refused.status.success() && stderr(&refused).contains("is broken after"), "{}", stderr(&refused));
    assert!(!root.join("broken").exists());
}

#[test]
fn masks_and_blobs_of_a_video_are_those_of_its_frames() {
    let Some(root) = scene() else { return };
    let root = root.path();
    lossless(root);
    assert!(sinew(root, "segment scene/frames --out a").status.success());
    let output = sinew(root, "segment clip.mkv --out b");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "30 masks written to b\n");
    for frame in [0, 7, 29] {
        let masks = [format!("a/frame_{frame:04}.png"), format!("b/clip_{frame:06}.png")];
        let [a, b] = masks.map(|mask| fs::read(root.join(mask)).unwrap());
        assert!(a == b, "mask {frame}");
    }
    let blobs = |input: &str| {
        let output = sinew(root, &format!("blobs {input}"));
        let text = String::from_utf8(output.stdout).unwrap();
        text.lines().map(|line| line.split_once(',').unwrap().1.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(blobs("scene/frames"), blobs("clip.mkv"));
}

#[test]
fn every_container_and_any_rate_is_read() {
    let Some(root) = scene() else { return };
    let root = root.path();
    for name in ["clip.mp4", "clip.MOV", "clip.avi", "-i.mkv"] {
        encode(root, &format!("./{name}"), "-c:v mpeg4 -q:v 2");
        let output = sinew(root, &format!("track arm --out run -- {name}"));
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        assert_eq!(rows(&root.join("run")).len(), FRAMES, "{name}");
    }
    // An animation: its colours are few, its frames all there.
    encode(root, "clip.gif", "");
    let output = sinew(root, "track arm clip.gif --out run");
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(rows(&root.join("run")).len(), FRAMES);
    // Half the rate is every second frame, twice the rate each frame twice.
    for (rate, count) in [("7.5", 15), ("30", 60)] {
        let output = sinew(root, &format!("track arm clip.mp4 --rate {rate} --out run"));
        let found = rows(&root.join("run")).len();
        assert!(output.status.success() && found.abs_diff(count) <= 1, "{rate} Hz: {found} rows");
    }
}

#[test]
fn a_broken_off_run_over_a_video_goes_on() {
    let Some(root) = scene() else { return };
    let root = root.path();
    let video = lossless(root);
    let options = TrackOptions {
        folder: video,
        side: SideChoice::Right,
        rate_hz: 15.0,
        seed: 1,
        skin: "gaussian".to_owned(),
        calibrate: None,
        front_end: FrontEnd::Pictures,
        hands: None,
        head: None,
        face: true,
        overlay: true,
        particles_csv: false,
        strict: false,
        config: Config::default(),
    };
    let stop = AtomicBool::new(false);
    let run = TrackRun::prepare(options, &root.join("broken_off")).unwrap();
    let ended = run.run(&stop, &mut |event| {
        if matches!(event, Event::Finished(11)) {
            stop.store(true, Ordering::Relaxed);
        }
    });
    assert!(ended.is_err());
    assert_eq!(rows(&root.join("broken_off")).len(), 11);
    assert!(sinew(root, "track arm clip.mkv --overlay --out whole").status.success());
    let resumed = sinew(root, "track arm clip.mkv --overlay --out broken_off --resume");
    assert!(resumed.status.success(), "{}", stderr(&resumed));
    for file in ["track.csv", "hand.png", "contact_sheet.png", "overlay/clip_000000.png", "overlay/clip_000029.png"] {
        let [a, b] = ["whole", "broken_off"].map(|run| fs::read(root.join(run).join(file)).unwrap());
        assert!(a == b, "{file}");
    }
}

#[test]
fn what_came_before_a_break_is_kept() {
    let Some(root) = scene() else { return };
    let root = root.path();
    let bytes = fs::read(lossless(root)).unwrap();
    fs::write(root.join("cut.mkv"), &bytes[..bytes.len() / 2]).unwrap();
    let output = sinew(root, "track arm cut.mkv --out run");
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(65), "{message}");
    assert!(
        message.contains("`cut.mkv` is broken after") && message.contains("finished frames are in `run`"),
        "{message}"
    );
    let kept = rows(&root.join("run")).len();
    assert!((8..22).contains(&kept), "{kept} frames");
    assert_eq!(report(&root.join("run"))["complete"], false);
    let output = sinew(root, "segment cut.mkv --out masks");
    assert!(
        output.status.code() == Some(65) && stderr(&output).contains("what could be read is written"),
        "{}",
        stderr(&output)
    );
    assert_eq!(fs::read_dir(root.join("masks")).unwrap().count(), kept);
}

/// Puts a program `ffmpeg` into the folder `bin`, which gives five frames and half of a sixth, and
/// then does `ending`.
#[cfg(unix)]
fn failing_ffmpeg(root: &Path, ending: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = std::env::var("PATH").unwrap();
    let bin = root.join("bin");
    fs::create_dir_all(&bin).unwrap();
    let program = bin.join("ffmpeg");
    fs::write(&program, format!("#!/bin/sh\nPATH='{path}' ffmpeg \"$@\" | head -c 5068000\n{ending}\n")).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    format!("{}:{path}", bin.display())
}

#[cfg(unix)]
#[test]
fn a_run_whose_video_cannot_be_read_any_more_goes_on() {
    let Some(root) = scene() else { return };
    let root = root.path();
    let video = lossless(root);
    assert!(sinew(root, "track arm clip.mkv --out whole").status.success());
    let endings = ["kill -9 $$", "kill -15 $$", "exit 255", "mv clip.mkv away.mkv; exit 1"];
    for (run, ending) in endings.into_iter().enumerate() {
        let path = failing_ffmpeg(root, ending);
        let words = format!("track arm clip.mkv --out run{run}");
        let output = sinew_command().current_dir(root).args(words.split(' ')).env("PATH", path).output().unwrap();
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(74), "{message}");
        assert!(message.contains("`clip.mkv` cannot be read any more after 5 frames"), "{message}");
        if !video.exists() {
            fs::rename(root.join("away.mkv"), &video).unwrap();
        }
        let resumed = sinew(root, &format!("{words} --resume"));
        assert!(resumed.status.success(), "{}", stderr(&resumed));
        let tables = ["whole".to_owned(), format!("run{run}")].map(|run| fs::read(root.join(run).join("track.csv")));
        assert_eq!(tables[0].as_ref().unwrap(), tables[1].as_ref().unwrap());
    }
    let path = failing_ffmpeg(root, "kill -9 $$");
    let segment = ["segment", "clip.mkv", "--out", "masks"];
    let output = sinew_command().current_dir(root).args(segment).env("PATH", path).output().unwrap();
    assert_eq!(output.status.code(), Some(74), "{}", stderr(&output));
    assert!(stderr(&output).contains("what could be read is written"), "{}", stderr(&output));
}

#[test]
fn a_video_that_is_none_and_a_missing_ffmpeg_are_reported_with_the_remedy() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("words.mp4"), "no video").unwrap();
    for command in ["track arm words.mp4 --out run", "segment words.mp4 --out masks", "blobs words.mp4"] {
        let mut without = sinew_command();
        without.current_dir(root.path()).args(command.split_whitespace()).env("PATH", root.path());
        let output = without.output().unwrap();
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(66), "{message}");
        assert!(message.contains("apt install ffmpeg") && message.contains("give a folder of images"), "{message}");
        assert!(!root.path().join("run").exists());
    }
    if scene().is_some() {
        let message = stderr(&sinew(root.path(), "track arm words.mp4 --out run"));
        assert!(message.contains("`words.mp4` cannot be read as a video") && message.contains("whole"), "{message}");
    }
}

#[test]
fn ten_bits_and_oblong_pixels_come_as_eight_bits_and_squares() {
    let Some(root) = scene() else { return };
    for (name, options) in [
        ("ten.mkv", "-c:v ffv1 -pix_fmt yuv420p10le"),
        ("oblong.mkv", "-c:v ffv1 -vf scale=320:480,setsar=2 -pix_fmt bgr0"),
    ] {
        let video = encode(root.path(), name, options);
        let mut frames = VideoFrames::open(&video, 15.0).unwrap();
        let first = frames.next_frame().unwrap().unwrap();
        assert_eq!(first.dimensions(), (640, 480), "{name}");
        let original = load_rgb(&root.path().join("scene/frames/frame_0000.png")).unwrap();
        let sum: u64 = first.as_raw().iter().zip(original.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = sum as f64 / first.as_raw().len() as f64;
        assert!(mean < 4.0, "{name}: {mean} levels off");
    }
}
