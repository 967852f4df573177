//! `sinew track body` as a user types it: what it writes, on good input and on bad.

use assert_cmd::Command;
use sinew::body::run::{BodyEvent, BodyTrackOptions, BodyTrackRun};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_JOINT_NAMES, full_body};
use sinew_tests::sinew_command;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

/// Frames of a scene that tests track.
const FRAMES: usize = 8;

/// The built-in motion `name` seen with few points, made once a process.
fn simulated(name: &'static str) -> &'static Path {
    static SCENES: OnceLock<BTreeMap<&str, TempDir>> = OnceLock::new();
    let scenes = SCENES.get_or_init(|| {
        let simulate = |motion: &'static str| {
            let folder = tempfile::tempdir().unwrap();
            let mut command = Command::from_std(sinew_command());
            command.args(["simulate", "stereo", "--motion", motion, "--points", "400", "--out"]);
            command.arg(folder.path()).assert().success();
            (motion, folder)
        };
        ["stick-wave", "pelvic-lift"].map(simulate).into()
    });
    scenes[name].path()
}

/// A scene of few frames in `in`, beside a place for outputs.
struct Scene {
    root: TempDir,
}

impl Scene {
    fn new(motion: &'static str) -> Self {
        let scene = Self { root: tempfile::tempdir().unwrap() };
        fs::create_dir_all(scene.path("in/points")).unwrap();
        let files = ["body.json", "first_pose.json", "truth.csv", "run.json", "stick.csv"].map(str::to_owned);
        for name in files.into_iter().chain((0..FRAMES).map(|frame| format!("points/{frame:06}.ply"))) {
            let from = simulated(motion).join(&name);
            if from.exists() {
                fs::copy(from, scene.path("in").join(name)).unwrap();
            }
        }
        scene
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    fn cloud(&self, frame: usize) -> PathBuf {
        self.path(&format!("in/points/{frame:06}.ply"))
    }

    /// Puts points of this text (a line each) in the place of a frame.
    fn points(&self, frame: usize, lines: &[&str]) {
        let count = lines.len();
        let body: String = lines.iter().map(|line| format!("{line}\n")).collect();
        let header = format!(
            "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        );
        fs::write(self.cloud(frame), header + &body).unwrap();
    }

    fn track(&self, out: &str, words: &[&str]) -> Output {
        let mut command = Command::from_std(sinew_command());
        command.current_dir(self.root.path()).args(["track", "body", "in", "--out", out, "--particles", "30"]);
        command.args(words).output().unwrap()
    }

    /// Tracks, expects success, checks all that holds of every table, and returns what was said on
    /// standard error.
    fn tracks(&self, out: &str, words: &[&str]) -> String {
        let output = self.track(out, words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {message}");
        assert_sound(&self.path(out).join("track.csv"));
        message
    }

    /// Expects a refusal with all of `parts` in its message, and nothing written.
    fn refuses(&self, words: &[&str], parts: &[&str]) {
        let output = self.track("out", words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(64..=66 | 73)), "{words:?}: {:?}: {message}", output.status);
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
        assert!(!message.contains("panicked"), "{message}");
        assert!(!self.path("out").exists(), "{words:?} left an output folder");
    }

    fn table(&self, out: &str) -> Table {
        Table::read(&self.path(out).join("track.csv"))
    }

    fn report(&self, out: &str) -> serde_json::Value {
        serde_json::from_slice(&fs::read(self.path(out).join("run.json")).unwrap()).unwrap()
    }
}

/// A table by its columns' names.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f32>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let number = |cell: &str| cell.parse().unwrap();
        let rows = reader.records().map(|row| row.unwrap().iter().map(number).collect()).collect();
        Self { header, rows }
    }

    fn column(&self, name: &str) -> Vec<f32> {
        let index =
            self.header.iter().position(|column| column == name).unwrap_or_else(|| panic!("no column `{name}`"));
        self.rows.iter().map(|row| row[index]).collect()
    }
}

/// Numbers are finite and no limit is broken.
fn assert_sound(path: &Path) {
    let table = Table::read(path);
    assert!(table.rows.iter().flatten().all(|value| value.is_finite()), "{}", path.display());
    let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
    for (name, limit) in BODY_ANGLE_NAMES.iter().zip(skeleton.limits()).skip(3) {
        for value in table.column(&format!("{name}_rad")) {
            assert!((limit.low_rad..=limit.high_rad).contains(&value), "{name} = {value} breaks its limit");
        }
    }
    for size in table.column("effective_sample_size") {
        assert!((0.99..=30.01).contains(&size), "{size} of 30 particles");
    }
}

#[test]
fn more_modes_than_there_are_is_refused() {
    Scene::new("stick-wave").refuses(&["--model", "modes"], &["--particles has to be from 1 to 8 with --model modes"]);
}

#[test]
fn every_model_writes_all_its_files() {
    let scene = Scene::new("stick-wave");
    for model in ["guided", "end-effector", "angular", "stick", "pelvic-lift", "end-effector-paper", "angular-paper"] {
        scene.tracks(model, &["--model", model]);
        let report = scene.report(model);
        assert_eq!((&report["complete"], &report["frames_finished"]), (&true.into(), &FRAMES.into()), "{model}");
        assert_eq!(report["options"]["model"], model);
        for name in ["track.bvh", "track.trc"] {
            assert!(scene.path(model).join(name).is_file(), "{model}: {name}");
        }
    }
    let pose = fs::read_to_string(scene.path("in/first_pose.json")).unwrap();
    let pose: BTreeMap<String, f32> = serde_json::from_str(&pose).unwrap();
    let first_rad = scene.table("stick").column("l_elbow_flexion_rad")[0];
    assert_eq!(first_rad, pose["l_elbow_flexion"], "the first row is the first pose");
    let error_m = |out: &str| scene.report(out)["joint_error_m"].as_f64().unwrap();
    assert!(error_m("guided") < 0.12, "{}", error_m("guided"));
    assert_eq!(scene.table("guided").column("frame"), (0..FRAMES).map(|frame| frame as f32).collect::<Vec<_>>());
}

#[test]
fn a_pelvic_lift_stays_above_the_floor() {
    let scene = Scene::new("pelvic-lift");
    scene.tracks("out", &["--model", "pelvic-lift"]);
    assert!(scene.report("out")["joint_error_m"].as_f64().unwrap() < 0.12);
    // The built-in camera is a metre above the floor.
    assert!(scene.table("out").column("root_y_m").iter().all(|&y| y <= 1.0));
}

#[test]
fn the_bvh_has_the_joints_of_the_table() {
    let scene = Scene::new("stick-wave");
    fs::remove_file(scene.cloud(3)).unwrap();
    scene.tracks("out", &[]);
    let text = fs::read_to_string(scene.path("out/track.bvh")).unwrap();
    let motion = sinew::motion::bvh::parse(&text, Path::new("track.bvh"), Some(0.01)).unwrap();
    let table = scene.table("out");
    assert_eq!(motion.len(), FRAMES, "a frame for every number");
    for name in BODY_JOINT_NAMES {
        let joint = motion.joint(name).unwrap();
        let [x, y, z] = ["x", "y", "z"].map(|axis| table.column(&format!("{name}_{axis}_m")));
        for (row, frame) in table.column("frame").into_iter().enumerate() {
            let place = motion.frame(frame as usize)[joint];
            let off = [place.x - x[row], place.y + y[row], place.z + z[row]];
            assert!(off.iter().all(|value| value.abs() < 1.0e-3), "{name} of frame {frame}: {off:?}");
        }
        assert_eq!(motion.frame(3)[joint], motion.frame(2)[joint], "the frame without a file repeats the pose before");
    }
    let trc = sinew::motion::trc::read(&scene.path("out/track.trc")).unwrap();
    assert_eq!((trc.names.len(), trc.positions_m.len()), (BODY_JOINT_NAMES.len(), FRAMES));
    assert!(trc.positions_m[3].iter().all(Option::is_none), "the frame without a file is a gap in time");
}

#[test]
fn threads_change_no_byte_and_the_seed_does() {
    let scene = Scene::new("stick-wave");
    for (out, words) in [
        ("one", ["--threads", "1", "--seed", "5"]),
        ("eight", ["--threads", "8", "--seed", "5"]),
        ("other", ["--threads", "2", "--seed", "6"]),
    ] {
        scene.tracks(out, &[&words[..], &["--particles-csv"]].concat());
    }
    let bytes = |out: &str, name: &str| fs::read(scene.path(out).join(name)).unwrap();
    for name in ["track.csv", "track.bvh", "track.trc", "particles.csv"] {
        assert!(bytes("one", name) == bytes("eight", name), "{name} depends on the threads");
        assert!(bytes("one", name) != bytes("other", name), "{name} does not depend on the seed");
    }
    let particles = Table::read(&scene.path("one/particles.csv"));
    assert_eq!(particles.rows.len(), 30 * FRAMES);
    let sum: f32 = particles.column("weight").iter().sum();
    assert!((sum - FRAMES as f32).abs() < 1.0e-3, "{sum}");
}

#[test]
fn frames_without_evidence_are_predicted() {
    let scene = Scene::new("stick-wave");
    scene.points(2, &[]);
    scene.points(3, &["0.1 0.2 3.0"]);
    scene.points(4, &["nan 0 3", "0 inf 3", "0 0 nan"]);
    scene.points(5, &["0 0 0", "0.001 0 0.001"]);
    for model in ["guided", "end-effector", "angular", "stick"] {
        scene.tracks(model, &["--model", model]);
        let (table, report) = (scene.table(model), scene.report(model));
        assert_eq!(table.column("points")[2..6], [0.0, 1.0, 0.0, 0.0], "{model}");
        assert_eq!(table.column("head_observed")[2..6], [0.0; 4], "{model}");
        assert_eq!(table.column("head_observed")[7], 1.0, "{model}");
        assert_eq!((&report["points"]["skipped"], &report["points"]["frames_without_points"]), (&5.into(), &3.into()));
        let spread = table.column("l_wrist_spread_m");
        assert!(spread[5] > spread[1], "{model}: {spread:?}");
    }
}

#[test]
fn points_in_other_units_or_axes_are_refused_with_the_remedy() {
    let changes = [
        ([100.0, 100.0, 100.0], "m from the camera, and 30 m is the most"),
        ([1000.0, 1000.0, 1000.0], "farther than 1000 m"),
        ([1.0, -1.0, -1.0], "100 % of the first points of `in/points` are behind the camera"),
    ];
    for (factors, part) in changes {
        let scene = Scene::new("stick-wave");
        for frame in 0..FRAMES {
            let points_m = sinew::cloud::read(&scene.cloud(frame)).unwrap().points_m;
            let line = |point: &sinew_core::math::Vec3| {
                format!("{} {} {}", factors[0] * point.x, factors[1] * point.y, factors[2] * point.z)
            };
            let lines: Vec<String> = points_m.iter().map(line).collect();
            scene.points(frame, &lines.iter().map(String::as_str).collect::<Vec<_>>());
        }
        scene.refuses(&[], &[part]);
    }
}

#[test]
fn ends_that_most_frames_do_not_show_are_warned_of() {
    let scene = Scene::new("stick-wave");
    (2..FRAMES).for_each(|frame| scene.points(frame, &[]));
    let output = scene.track("out", &[]);
    let summary = String::from_utf8_lossy(&output.stdout);
    assert!(summary.contains("warning: head, hands and feet were each observed in fewer than half"), "{summary}");
    let report = scene.report("out");
    assert_eq!((report["warnings"].as_array().unwrap().len(), &report["observed_frames"]["head"]), (1, &2.into()));
}

#[test]
fn a_gap_in_the_numbers_is_time_that_passes() {
    let scene = Scene::new("stick-wave");
    scene.tracks("whole", &[]);
    (2..6).for_each(|frame| fs::remove_file(scene.cloud(frame)).unwrap());
    scene.tracks("gap", &[]);
    assert_eq!(scene.table("gap").column("frame"), [0.0, 1.0, 6.0, 7.0]);
    assert_eq!(scene.report("gap")["frames_missing"], 4);
    let spread = |out: &str, row: usize| scene.table(out).column("r_wrist_spread_m")[row];
    assert!(spread("gap", 2) > spread("whole", 2), "{} after the gap", spread("gap", 2));
}

#[test]
fn a_damaged_cloud_is_skipped_or_ends_a_strict_run() {
    let scene = Scene::new("stick-wave");
    let bytes = fs::read(scene.cloud(4)).unwrap();
    fs::write(scene.cloud(4), &bytes[..bytes.len() / 2]).unwrap();
    let message = scene.tracks("out", &[]);
    assert!(message.contains("skipped frame 4") && message.contains("000004.ply"), "{message}");
    let report = scene.report("out");
    assert_eq!((&report["skipped"][0]["frame"], &report["complete"]), (&4.into(), &true.into()));
    assert_eq!(scene.table("out").column("points")[4], 0.0);
    let output = scene.track("strict", &["--strict"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(65));
    assert!(message.contains("000004.ply") && message.contains("4 finished frames"), "{message}");
    assert_eq!((scene.table("strict").rows.len(), &scene.report("strict")["complete"]), (4, &false.into()));
}

#[test]
fn more_points_than_can_be_weighed_are_drawn_from() {
    let scene = Scene::new("stick-wave");
    let lines: Vec<String> =
        (0..25_000).map(|i| format!("{} {} 3.0", (i % 100) as f32 * 0.004, (i / 100) as f32 * 0.004)).collect();
    scene.points(1, &lines.iter().map(String::as_str).collect::<Vec<_>>());
    (2..FRAMES).for_each(|frame| fs::remove_file(scene.cloud(frame)).unwrap());
    let message = scene.tracks("out", &[]);
    assert!(message.contains("25000 points; 20000 of them"), "{message}");
    assert_eq!(scene.report("out")["points"]["over_cap"], 5000);
    assert_eq!(scene.table("out").column("points")[1], 20_000.0);
}

#[test]
fn who_is_not_known_is_said_and_found() {
    let scene = Scene::new("stick-wave");
    for name in ["body.json", "first_pose.json", "run.json", "stick.csv"] {
        fs::remove_file(scene.path("in").join(name)).unwrap();
    }
    let message = scene.tracks("out", &["--pictures"]);
    for part in ["1.75 m tall", "no first pose", "15 Hz"] {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    let error_m = scene.report("out")["joint_error_m"].as_f64().unwrap();
    assert!(error_m < 0.2, "{error_m}");
    for name in ["contact_sheet.png", "effective_samples.png", "joint_error.png"] {
        assert!(image::open(scene.path("out").join(name)).unwrap().width() > 500, "{name}");
    }
    let message = scene.tracks("tall", &["--height", "1.9", "--rate", "30"]);
    assert!(!message.contains("m tall") && !message.contains("Hz"), "{message}");
    assert!(scene.report("tall")["body"]["trunk_m"].as_f64() > scene.report("out")["body"]["trunk_m"].as_f64());
    // The animation of one run is the skeleton of another, whose measures are the same to a file's
    // decimals.
    scene.tracks("measured", &["--skeleton", "tall/track.bvh"]);
    let thigh_m = |out: &str| scene.report(out)["body"]["thigh_m"].as_f64().unwrap();
    assert!((thigh_m("measured") - thigh_m("tall")).abs() < 1.0e-3, "{}", thigh_m("measured"));
}

#[test]
fn a_first_pose_beyond_the_limits_is_brought_inside_and_said() {
    let scene = Scene::new("stick-wave");
    fs::write(scene.path("pose.json"), r#"{"root_z": 3.0, "l_knee_flexion": -0.7, "root_turn": 0.1}"#).unwrap();
    let message = scene.tracks("out", &["--init", "pose.json"]);
    assert!(message.contains("l_knee_flexion = -0.7 breaks its limit; 0 is used"), "{message}");
    assert!(!message.contains("root_turn"), "{message}");
}

#[test]
fn a_stick_may_be_known_in_pixels_only_or_not_at_all() {
    let scene = Scene::new("stick-wave");
    let stick = fs::read_to_string(scene.path("in/stick.csv")).unwrap();
    let with = |cells: std::ops::Range<usize>| {
        let rows = stick.lines().enumerate().map(|(number, line)| {
            let cell =
                |(index, cell): (usize, &str)| if number > 0 && cells.contains(&index) { "" } else { cell }.to_owned();
            line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",") + "\n"
        });
        rows.collect::<String>()
    };
    fs::write(scene.path("pixels.csv"), with(1..7)).unwrap();
    fs::write(scene.path("none.csv"), with(1..11)).unwrap();
    for (out, file) in [("space", "in/stick.csv"), ("pixels", "pixels.csv"), ("none", "none.csv")] {
        scene.tracks(out, &["--model", "stick", "--stick", file]);
    }
    let wrist = |out: &str| scene.table(out).column("l_wrist_z_m");
    assert_ne!(wrist("space"), wrist("pixels"));
    assert_ne!(wrist("pixels"), wrist("none"));
    fs::remove_file(scene.path("in/run.json")).unwrap();
    let message = scene.tracks("blind", &["--model", "stick", "--stick", "pixels.csv"]);
    assert!(message.contains("in pixels only, and no run.json has a camera"), "{message}");
}

#[test]
fn what_cannot_be_used_is_refused_before_anything_is_written() {
    let scene = Scene::new("stick-wave");
    let body = fs::read_to_string(scene.path("in/body.json")).unwrap();
    let zero = body.lines().map(|line| if line.contains("\"forearm_m\"") { "\"forearm_m\": 0.0," } else { line });
    fs::write(scene.path("zero.json"), zero.collect::<String>()).unwrap();
    fs::write(scene.path("unknown.toml"), "[guided]\nsolver_stesp = 3\n").unwrap();
    fs::write(scene.path("wrong.toml"), "[angular]\npersistence = 2.0\n").unwrap();
    fs::write(scene.path("pose.json"), r#"{"l_knee": 0.1}"#).unwrap();
    fs::write(scene.path("stick.csv"), "frame\n0\n").unwrap();
    fs::create_dir(scene.path("empty")).unwrap();
    for (words, parts) in [
        (&["--skeleton", "zero.json"][..], &["zero.json", "forearm_m"][..]),
        (&["--skeleton", "nowhere.bvh"], &["nowhere.bvh"]),
        (&["--skeleton", "stick.csv"], &["stick.csv", "no skeleton that can be read"]),
        (&["--skeleton", "in/body.json", "--height", "1.8"], &["--height"]),
        (&["--height", "9"], &["--height", "0.5 to 2.5"]),
        (&["--config", "unknown.toml"], &["guided.solver_stesp", "nearest one is `guided.solver_steps`"]),
        (&["--config", "wrong.toml"], &["wrong.toml", "angular.persistence", "from 0 to 1"]),
        (&["--init", "pose.json"], &["pose.json", "`l_knee` is no coordinate", "l_knee_flexion"]),
        (&["--model", "stick", "--stick", "stick.csv"], &["stick.csv", "line 1"]),
        (&["--stick", "in/stick.csv"], &["--stick is for --model stick"]),
        (&["--model", "walking"], &["walking", "end-effector"]),
        (&["--threads", "0"], &["--threads", "from 1 to"]),
        (&["--rate", "-3"], &["--rate", "0.1 to 1000"]),
    ] {
        scene.refuses(words, parts);
    }
    let refuses = |folder: &str, out: &str, part: &str| {
        let mut command = Command::from_std(sinew_command());
        command.current_dir(scene.root.path()).args(["track", "body", folder, "--out", out]);
        let message = String::from_utf8_lossy(&command.assert().failure().get_output().stderr).into_owned();
        assert!(message.contains(part), "{message}");
    };
    refuses("empty", "out", "`empty` is empty");
    refuses("nowhere", "out", "check the path");
    refuses("in", "in", "choose another --out");
    refuses("in", "in/points", "choose another --out");
    fs::remove_file(scene.path("in/stick.csv")).unwrap();
    scene.refuses(&["--model", "stick"], &["--stick FILE"]);
    fs::write(scene.path("in/run.json"), "{\"rate_hz\": 0}").unwrap();
    scene.refuses(&[], &["run.json", "rate_hz has to be"]);
    for particles in ["0", "99999", "-1"] {
        let mut command = Command::from_std(sinew_command());
        command.current_dir(scene.root.path()).args(["track", "body", "in", "--out", "out", "--particles", particles]);
        command.assert().failure();
    }
    assert!(!scene.path("out").exists());
}

#[test]
fn the_printed_configuration_is_one() {
    let scene = Scene::new("stick-wave");
    let printed = Command::from_std(sinew_command()).args(["track", "body", "--print-config"]).output().unwrap();
    fs::write(scene.path("printed.toml"), printed.stdout).unwrap();
    scene.tracks("default", &[]);
    scene.tracks("printed", &["--config", "printed.toml"]);
    let bytes = |out: &str| fs::read(scene.path(out).join("track.csv")).unwrap();
    assert!(bytes("default") == bytes("printed"));
}

#[test]
fn what_was_finished_before_ctrl_c_is_kept() {
    let scene = Scene::new("stick-wave");
    let options = BodyTrackOptions {
        folder: scene.path("in"),
        particles: 30,
        threads: Some(2),
        pictures: true,
        ..BodyTrackOptions::default()
    };
    let stop = AtomicBool::new(false);
    let run = BodyTrackRun::prepare(options, &scene.path("out")).unwrap();
    let stopped = run.run(&stop, &mut |event| {
        if let BodyEvent::Finished(3) = event {
            stop.store(true, Ordering::Relaxed);
        }
    });
    let stopped = stopped.unwrap_err();
    let interrupted = stopped.interrupted().unwrap();
    assert_eq!((interrupted.finished, interrupted.all), (3, Some(FRAMES)));
    assert_sound(&scene.path("out/track.csv"));
    assert_eq!((scene.table("out").rows.len(), &scene.report("out")["complete"]), (3, &false.into()));
    assert!(scene.path("out/track.bvh").is_file() && scene.path("out/contact_sheet.png").is_file());
}
