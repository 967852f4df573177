//! `sinew track arm --resume`: a run that was broken off and taken up again writes what an unbroken
//! one writes.

use image::{Rgb, RgbImage};
use sinew::config::Config;
use sinew::track::{Event, FrontEnd, SideChoice, TrackOptions, TrackRun};
use sinew_tests::{files_below, modified, set_modified, sinew_command};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

const FRAMES: u32 = 24;
/// A frame that cannot be read.
const BROKEN: usize = 6;

struct Scene {
    root: TempDir,
    side: SideChoice,
    particles: usize,
    everything: bool,
}

impl Scene {
    /// Two discs of skin that move before a blue wall.
    fn new(side: SideChoice, particles: usize, everything: bool) -> Self {
        let scene = Self { root: tempfile::tempdir().unwrap(), side, particles, everything };
        fs::create_dir(scene.input()).unwrap();
        for frame in 0..FRAMES {
            let inside = |x: u32, y: u32, u: u32| x.abs_diff(u).pow(2) + y.abs_diff(45).pow(2) < 90;
            let picture = RgbImage::from_fn(96, 72, |x, y| {
                let skin = inside(x, y, 20 + 2 * frame) || inside(x, y, 80 - frame);
                Rgb(if skin { [196, 140, 115] } else { [90, 120, 200] })
            });
            picture.save(scene.input().join(format!("{frame}.png"))).unwrap();
        }
        fs::write(scene.input().join(format!("{BROKEN}.png")), "no image").unwrap();
        scene
    }

    fn input(&self) -> PathBuf {
        self.root.path().join("in")
    }

    fn out(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    fn options(&self) -> TrackOptions {
        let mut config = Config::default();
        config.tracker.particles = self.particles;
        TrackOptions {
            folder: self.input(),
            side: self.side,
            rate_hz: 15.0,
            seed: 3,
            skin: "gaussian".to_owned(),
            calibrate: None,
            front_end: FrontEnd::Pictures,
            hands: None,
            head: None,
            face: true,
            overlay: self.everything,
            particles_csv: self.everything,
            strict: false,
            config,
        }
    }

    /// Ends `run` after the frame with which `finished` frames are done.
    fn break_off(run: TrackRun, finished: usize) {
        let stop = AtomicBool::new(finished == 0);
        let error = run.run(&stop, &mut |event| {
            if matches!(event, Event::Finished(count) if count == finished) {
                stop.store(true, Ordering::Relaxed);
            }
        });
        let error = error.unwrap_err();
        let interrupted = error.interrupted().unwrap();
        assert_eq!(interrupted.finished, finished);
    }

    fn begin(&self, out: &str, finished: usize) {
        Self::break_off(TrackRun::prepare(self.options(), &self.out(out)).unwrap(), finished);
    }

    /// `sinew track arm` with the options of this scene.
    fn command(&self, out: &str, more: &[&str]) -> (bool, String) {
        let mut command = sinew_command();
        command.args(["track", "arm", "--quiet", "--particles", &self.particles.to_string()]);
        command.arg(self.input()).arg("--out").arg(self.out(out)).args([
            "--side",
            match self.side {
                SideChoice::Left => "left",
                SideChoice::Right => "right",
                SideChoice::Both => "both",
            },
        ]);
        if !more.contains(&"--seed") {
            command.args(["--seed", "3"]);
        }
        if self.everything {
            command.args(["--overlay", "--particles-csv"]);
        }
        let output = command.args(more).output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    }

    fn files(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        files_below(&self.out(out), &["frames_per_second"])
    }

    /// Breaks runs off after so many frames, takes them up, and expects what an unbroken run
    /// writes.
    fn resumes(&self, breaks: &[&[usize]]) {
        assert!(self.command("whole", &[]).0);
        let whole = self.files("whole");
        for (number, places) in breaks.iter().enumerate() {
            let out = number.to_string();
            self.begin(&out, places[0]);
            assert!(self.out(&out).join("resume.json").exists());
            for &place in &places[1..] {
                Self::break_off(TrackRun::resume(self.options(), &self.out(&out)).unwrap(), place);
            }
            let (good, message) = self.command(&out, &["--resume"]);
            assert!(good && message.is_empty(), "{places:?}: {message}");
            let resumed = self.files(&out);
            assert_eq!(resumed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{places:?}");
            for (name, bytes) in &whole {
                assert!(resumed[name] == *bytes, "{places:?}: {name} differs");
            }
        }
    }
}

#[test]
fn both_arms_with_every_output_go_on_wherever_they_were_broken_off() {
    // Before the first frame, after it, beside the broken frame, twice, and before the last.
    Scene::new(SideChoice::Both, 50, true).resumes(&[&[0], &[1], &[BROKEN], &[BROKEN + 1], &[9, 10, 17], &[23]]);
}

#[test]
fn one_arm_with_any_number_of_particles_goes_on() {
    Scene::new(SideChoice::Left, 7, false).resumes(&[&[11]]);
    Scene::new(SideChoice::Right, 200, false).resumes(&[&[12]]);
    // Trackers with thousands of particles are built on a large stack, as programs have it and
    // threads of tests have not.
    let many = || Scene::new(SideChoice::Right, 1500, false).resumes(&[&[5]]);
    std::thread::scope(|scope| {
        std::thread::Builder::new().stack_size(32 << 20).spawn_scoped(scope, many).unwrap().join().unwrap();
    });
}

#[test]
fn a_run_begun_otherwise_is_refused_by_what_differs() {
    let scene = Scene::new(SideChoice::Right, 20, false);
    scene.begin("run", 9);
    let before = fs::read(scene.out("run").join("track.csv")).unwrap();
    let refused = |more: &[&str], parts: &[&str]| {
        let (good, message) = scene.command("run", &[&["--resume"], more].concat());
        assert!(!good && parts.iter().all(|part| message.contains(part)), "{more:?}: {message}");
        assert!(fs::read(scene.out("run").join("track.csv")).unwrap() == before, "{more:?}");
    };
    let anew = "leave --resume out";
    refused(&["--seed", "4"], &["seed = 3, not 4", anew]);
    refused(&["--rate", "30"], &["rate_hz = 15.0, not 30.0", anew]);
    refused(&["--variant", "bootstrap"], &["config.tracker.variant = \"pik\", not \"bootstrap\"", anew]);
    refused(&["--overlay"], &["overlay = false, not true", anew]);
    refused(&["--calibrate", "0,0,9,9"], &["calibrate", anew]);

    let state = scene.out("run").join("resume.json");
    let kept = fs::read_to_string(&state).unwrap();
    let version = format!("\"sinew_version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(kept.contains(&version));
    fs::write(&state, kept.replace(&version, "\"sinew_version\": \"0.0.1\"")).unwrap();
    refused(&[], &["written by sinew 0.0.1", anew]);
    fs::write(&state, &kept[..kept.len() / 2]).unwrap();
    refused(&[], &["resume.json", "not JSON", anew]);
    fs::write(&state, &kept).unwrap();

    fs::rename(scene.input().join("5.png"), scene.input().join("5b.png")).unwrap();
    refused(&[], &["number 5 was 5.png (", "and is 5b.png (", anew]);
    fs::rename(scene.input().join("5b.png"), scene.input().join("5.png")).unwrap();
    let path = scene.input().join("8.png");
    let (mut image, changed) = (fs::read(&path).unwrap(), modified(&path));
    fs::write(&path, &image).unwrap();
    refused(&[], &["number 8 was 8.png", "changed", anew]);
    // The same size and time: the pixels of the last finished frame are compared.
    let middle = image.len() / 2;
    image[middle] ^= 1;
    fs::write(&path, &image).unwrap();
    set_modified(&path, changed);
    refused(&[], &["`8.png` has changed", anew]);
    image[middle] ^= 1;
    fs::write(&path, image).unwrap();
    set_modified(&path, changed);

    fs::write(scene.out("run").join("track.csv"), "frame\n").unwrap();
    let (good, message) = scene.command("run", &["--resume"]);
    assert!(!good && message.contains("track.csv` has changed"), "{message}");
    fs::write(scene.out("run").join("track.csv"), &before).unwrap();
    assert!(scene.command("run", &["--resume"]).0);
}

#[test]
fn without_a_broken_run_there_is_nothing_to_resume() {
    let scene = Scene::new(SideChoice::Right, 20, false);
    let refused = |part: &str| {
        let (good, message) = scene.command("run", &["--resume"]);
        assert!(!good && message.contains(part) && message.contains("leave --resume out"), "{message}");
    };
    refused("holds no unfinished run");
    assert!(!scene.out("run").exists());
    scene.begin("run", 4);
    assert!(has_state(&scene.out("run")));
    assert!(scene.command("run", &[]).0, "without --resume it begins anew");
    assert!(!has_state(&scene.out("run")));
    refused("is complete");
}

fn has_state(out: &Path) -> bool {
    out.join("resume.json").exists()
}
