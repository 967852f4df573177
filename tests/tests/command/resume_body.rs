//! `sinew track body --resume`: a run that was broken off and taken up again writes what an
//! unbroken one writes.

use sinew::body::BodyPart;
use sinew::body::run::{BodyEvent, BodyTrackOptions, BodyTrackRun};
use sinew::body::tracking::BodyModelKind;
use sinew_tests::{files_below, modified, set_modified, sinew_command};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

const FRAMES: usize = 10;
/// A cloud that cannot be read.
const BROKEN: usize = 4;
/// A frame without a file.
const MISSING: usize = 6;
const TIMES: [&str; 2] = ["frames_per_second", "seconds_per_step"];

struct Scene {
    root: TempDir,
}

impl Scene {
    /// The built-in person with a stick, with a cloud that cannot be read and a gap.
    fn new() -> Self {
        let scene = Self { root: tempfile::tempdir().unwrap() };
        let mut command = sinew_command();
        command.args(["simulate", "stereo", "--motion", "stick-wave", "--points", "300", "--quiet", "--out"]);
        assert!(command.arg(scene.path("in")).output().unwrap().status.success());
        let mut clouds: Vec<PathBuf> =
            fs::read_dir(scene.path("in/points")).unwrap().map(|entry| entry.unwrap().path()).collect();
        clouds.sort();
        clouds.drain(..=FRAMES);
        clouds.iter().for_each(|cloud| fs::remove_file(cloud).unwrap());
        fs::write(scene.cloud(BROKEN), "no cloud").unwrap();
        fs::remove_file(scene.cloud(MISSING)).unwrap();
        scene
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    fn cloud(&self, frame: usize) -> PathBuf {
        self.path(&format!("in/points/{frame:06}.ply"))
    }

    /// Breaks runs off after so many frames, takes them up, and expects what an unbroken run
    /// writes.
    fn resumes(&self, options: &BodyTrackOptions, breaks: &[&[usize]]) {
        let never = AtomicBool::new(false);
        BodyTrackRun::prepare(options.clone(), &self.path("whole")).unwrap().run(&never, &mut |_| ()).unwrap();
        let whole = files_below(&self.path("whole"), &TIMES);
        assert!(whole.len() >= 4, "{:?}", whole.keys());
        for places in breaks {
            let out = self.path("broken");
            break_off(BodyTrackRun::prepare(options.clone(), &out).unwrap(), places[0]);
            assert!(out.join("resume.json").exists());
            for &place in &places[1..] {
                break_off(BodyTrackRun::resume(options.clone(), &out).unwrap(), place);
            }
            // Any number of threads gives the same; only the report names them.
            let run = BodyTrackRun::resume(BodyTrackOptions { threads: Some(1), ..options.clone() }, &out).unwrap();
            assert_eq!(run.frames_finished(), *places.last().unwrap());
            run.run(&never, &mut |_| ()).unwrap();
            let resumed = files_below(&out, &TIMES);
            assert_same(&whole, &resumed, places);
            fs::remove_dir_all(out).unwrap();
        }
    }

    fn options(&self, model: BodyModelKind, everything: bool) -> BodyTrackOptions {
        BodyTrackOptions {
            folder: self.path("in"),
            model,
            particles: 20,
            seed: 3,
            particles_csv: everything,
            pictures: everything,
            ..BodyTrackOptions::default()
        }
    }

    /// `sinew track body` with the options of the scene.
    fn command(&self, more: &[&str]) -> (bool, String) {
        let mut command = sinew_command();
        command.args(["track", "body", "--quiet", "--particles", "20", "--model", "stick"]);
        command.arg(self.path("in")).arg("--out").arg(self.path("run"));
        if !more.contains(&"--seed") {
            command.args(["--seed", "3"]);
        }
        let output = command.args(more).output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    }
}

/// Ends `run` after the frame with which `finished` frames are done.
fn break_off(run: BodyTrackRun, finished: usize) {
    let stop = AtomicBool::new(finished == 0);
    let error = run.run(&stop, &mut |event| {
        if matches!(event, BodyEvent::Finished(count) if count == finished) {
            stop.store(true, Ordering::Relaxed);
        }
    });
    let error = error.unwrap_err();
    let interrupted = error.interrupted().unwrap();
    assert_eq!((interrupted.finished, interrupted.all), (finished, Some(FRAMES)));
}

/// Compares run directories, but for the number of threads.
fn assert_same(whole: &BTreeMap<String, Vec<u8>>, resumed: &BTreeMap<String, Vec<u8>>, places: &[usize]) {
    assert_eq!(resumed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{places:?}");
    for (name, bytes) in whole {
        if name == "run.json" {
            let text = String::from_utf8(resumed[name].clone()).unwrap();
            let text = text.replace("\"threads\":1", "\"threads\":null");
            assert!(text.as_bytes() == bytes, "{places:?}: run.json differs: {text}");
        } else {
            assert!(resumed[name] == *bytes, "{places:?}: {name} differs");
        }
    }
}

#[test]
fn a_run_with_every_output_goes_on_wherever_it_was_broken_off() {
    let scene = Scene::new();
    // Before the first frame, after it, beside the broken cloud, beside the gap, twice, and before
    // the last.
    let breaks: [&[usize]; 6] = [&[0], &[1], &[BROKEN], &[BROKEN + 1, MISSING], &[2, 3, 8], &[9]];
    scene.resumes(&scene.options(BodyModelKind::Stick, true), &breaks);
}

#[test]
fn every_model_goes_on() {
    let scene = Scene::new();
    for model in [
        BodyModelKind::Guided,
        BodyModelKind::EndEffector,
        BodyModelKind::Angular,
        BodyModelKind::PelvicLift,
        BodyModelKind::EndEffectorPaper,
        BodyModelKind::AngularPaper,
    ] {
        scene.resumes(&scene.options(model, false), &[&[5]]);
    }
    scene.resumes(&BodyTrackOptions { particles: 8, ..scene.options(BodyModelKind::Modes, false) }, &[&[5]]);
}

#[test]
fn an_upper_body_whose_start_is_found_goes_on() {
    let scene = Scene::new();
    fs::remove_file(scene.path("in/first_pose.json")).unwrap();
    let options = BodyTrackOptions { part: Some(BodyPart::Upper), ..scene.options(BodyModelKind::Guided, true) };
    scene.resumes(&options, &[&[3], &[7]]);
}

#[test]
fn a_run_begun_otherwise_is_refused_by_what_differs() {
    let scene = Scene::new();
    let anew = "leave --resume out";
    let (good, message) = scene.command(&["--resume"]);
    assert!(!good && message.contains("holds no unfinished run") && message.contains(anew), "{message}");
    assert!(!scene.path("run").exists());
    let options = scene.options(BodyModelKind::Stick, false);
    break_off(BodyTrackRun::prepare(options, &scene.path("run")).unwrap(), 5);
    let table = fs::read(scene.path("run/track.csv")).unwrap();
    let refused = |more: &[&str], parts: &[&str]| {
        let (good, message) = scene.command(&[&["--resume"], more].concat());
        assert!(!good && parts.iter().all(|part| message.contains(part)), "{more:?}: {message}");
        assert!(fs::read(scene.path("run/track.csv")).unwrap() == table, "{more:?}");
    };
    refused(&["--seed", "4"], &["seed = 3, not 4", anew]);
    refused(&["--rate", "30"], &["rate_hz = null, not 30.0", anew]);
    refused(&["--height", "1.7"], &["height_m = null, not 1.7", anew]);
    refused(&["--pictures"], &["pictures = false, not true", anew]);
    let changed = |name: &str, change: fn(&Path), parts: &[&str]| {
        let path = scene.path(name);
        let kept = fs::read(&path).ok().map(|bytes| (bytes, modified(&path)));
        change(&path);
        refused(&[], parts);
        match kept {
            Some((bytes, changed)) => {
                fs::write(&path, bytes).unwrap();
                set_modified(&path, changed);
            }
            None => fs::remove_file(path).unwrap(),
        }
    };
    let append = |path: &Path| {
        let mut bytes = fs::read(path).unwrap();
        bytes.push(b'\n');
        fs::write(path, bytes).unwrap();
    };
    changed("in/stick.csv", append, &["stick.csv` is not as it was", anew]);
    changed("in/body.json", append, &["body.json` is not as it was", anew]);
    changed(
        "in/points/000006.ply",
        |path| fs::write(path, "").unwrap(),
        &["number 6 was 000007.ply (", "and is 000006.ply (", anew],
    );
    changed("in/points/000004.ply", append, &["number 4 was 000004.ply (", anew]);
    append(&scene.path("run/track.csv"));
    let (good, message) = scene.command(&["--resume"]);
    assert!(!good && message.contains("track.csv` has changed since the run was ended"), "{message}");
    fs::write(scene.path("run/track.csv"), &table).unwrap();
    let other = |path: &Path| {
        let text = fs::read_to_string(path).unwrap();
        fs::write(path, text.replace("\"sinew_version\": \"", "\"sinew_version\": \"0.0.")).unwrap();
    };
    changed("run/resume.json", other, &["written by sinew 0.0.", anew]);
    changed("run/resume.json", |path| fs::write(path, "{").unwrap(), &["resume.json", "not JSON", anew]);
    let (good, message) = scene.command(&["--resume", "--threads", "1"]);
    assert!(good, "{message}");
    assert!(!scene.path("run/resume.json").exists());
    refused_as_complete(&scene);
}

fn refused_as_complete(scene: &Scene) {
    let (good, message) = scene.command(&["--resume"]);
    assert!(!good && message.contains("is complete; leave --resume out"), "{message}");
}
