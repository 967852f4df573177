//! `sinew track body` on depth images, with a wall and a floor behind the person.

use assert_cmd::Command;
use image::{ImageBuffer, Luma};
use serde_json::Value;
use sinew::output::OutputDir;
use sinew::stereo::visible::visible_pixels;
use sinew::stereo::{StereoOptions, StereoScene, StereoSource};
use sinew_core::camera::Pixel;
use sinew_tests::sinew_command;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;
use tempfile::TempDir;

/// Frames that are kept.
const FRAMES: usize = 10;
/// Distance of the wall, metres.
const WALL_M: f32 = 4.5;

/// A person before a wall, in `depth`, and the same scene as clouds in `clouds`; made once.
fn scenes() -> &'static Path {
    static SCENES: OnceLock<TempDir> = OnceLock::new();
    SCENES.get_or_init(made).path()
}

fn made() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let source = StereoSource {
        motion: PathBuf::from("stick-wave"),
        skeleton: None,
        motion_rate_hz: None,
        between_s: None,
        partial: false,
        distance_m: 3.0,
        heading_deg: 0.0,
        rate_hz: 15.0,
        seed: 1,
    };
    let motion = source.read().unwrap();
    let scene = StereoScene::new(motion.recording, StereoOptions::default()).unwrap();
    for name in ["clouds", "depth"] {
        let out = OutputDir::create(&root.path().join(name)).unwrap();
        scene.write_folder("stick-wave", motion.floor_y_m, None, &[], &out).unwrap();
    }
    for frame in FRAMES..scene.len() {
        fs::remove_file(root.path().join(format!("clouds/points/{frame:06}.ply"))).unwrap();
    }
    let folder = root.path().join("depth");
    fs::remove_dir_all(folder.join("points")).unwrap();
    fs::create_dir(folder.join("depth")).unwrap();
    let camera = scene.options().camera;
    for frame in 0..FRAMES {
        let mut image = ImageBuffer::from_fn(camera.width_px, camera.height_px, |u, v| {
            let down = camera.direction(Pixel::new(u as f32, v as f32)).y;
            let floor_m = if down > 0.0 { motion.floor_y_m / down } else { f32::INFINITY };
            Luma([(1000.0 * floor_m.min(WALL_M)) as u16])
        });
        for seen in visible_pixels(&camera, &scene.capsules(frame)) {
            image.put_pixel(seen.pixel.u_px as u32, seen.pixel.v_px as u32, Luma([(1000.0 * seen.depth_m) as u16]));
        }
        image.save(folder.join(format!("depth/{frame:06}.png"))).unwrap();
    }
    let centre = camera.centre();
    let text = format!(
        r#"{{"width": 640, "height": 480, "fx": {f}, "fy": {f}, "ppx": {}, "ppy": {}, "depth_scale": 0.001}}"#,
        centre.u_px,
        centre.v_px,
        f = camera.focal_px
    );
    fs::write(folder.join("camera.json"), text).unwrap();
    fs::write(root.path().join("floor.txt"), format!("0,-1,0,{}", motion.floor_y_m - 0.03)).unwrap();
    root
}

fn track(folder: &str, out: &Path, words: &[&str]) -> Output {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(scenes()).args(["track", "body", folder, "--particles", "20", "--out"]).arg(out);
    command.args(words).output().unwrap()
}

fn report(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap()
}

/// What cuts wall and floor off.
fn cut() -> Vec<String> {
    let floor = fs::read_to_string(scenes().join("floor.txt")).unwrap();
    ["--inside", "-1.5,1.5,-2,2,0.5,4.4", "--above-plane", &floor].map(str::to_owned).to_vec()
}

/// These depth images have no noise but their millimetres. So their errors are a tenth of those of
/// clouds, 0.03 to 0.4 times.
#[test]
fn a_person_before_a_wall_is_tracked_as_in_clouds() {
    let out = tempfile::tempdir().unwrap();
    let [clouds, depth] = ["clouds", "depth"].map(|name| out.path().join(name));
    assert!(track("clouds", &clouds, &[]).status.success());
    let cut = cut();
    let cut: Vec<&str> = cut.iter().map(String::as_str).collect();
    let said = track("depth", &depth, &cut);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let (clouds, depth) = (report(&clouds), report(&depth));
    let joints_m = |run: &Value| run["joint_error_m"].as_f64().unwrap();
    let ratio = joints_m(&depth) / joints_m(&clouds);
    assert!((0.03..0.4).contains(&ratio), "{} instead of {}", joints_m(&depth), joints_m(&clouds));
    assert_eq!((&depth["frames_finished"], &depth["complete"]), (&FRAMES.into(), &true.into()));
    assert_eq!(depth["points"]["used"], 2000 * FRAMES);
    let outside = depth["points"]["outside"].as_u64().unwrap();
    assert!(outside > 200_000 * FRAMES as u64, "{outside} points of wall and floor");
    assert!(depth["inputs"]["camera"].as_str().unwrap().ends_with("camera.json"));
}

#[test]
fn what_is_wrong_is_said() {
    let out = tempfile::tempdir().unwrap();
    let says = |words: &[&str], code: i32, message: &str| {
        let output = track("depth", &out.path().join("run"), words);
        let said = String::from_utf8_lossy(&output.stderr).replace('\n', " ");
        assert!(output.status.code() == Some(code) && said.contains(message), "{:?} {said}", output.status.code());
    };
    says(&["--inside", "1,0,0,1,0,1"], 64, "--inside has to be least and greatest");
    says(&["--above-plane", "0,0,0,1"], 64, "--above-plane has to be finite with a direction");
    says(&["--inside", "1,2"], 64, "6 numbers with commas");
    says(&["--points", "0"], 64, "--points has to be from 1 to 20000");
    let camera = out.path().join("c.json");
    fs::write(&camera, "{}").unwrap();
    says(&["--camera", camera.to_str().unwrap()], 65, "it needs fx, fy, cx and cy");
    fs::write(&camera, r#"{"fx": 500, "fy": 500, "cx": 10, "cy": 10, "width": 10, "height": 10}"#).unwrap();
    says(
        &["--camera", camera.to_str().unwrap()],
        65,
        "its camera takes images of 10 x 10 pixels, and it has 640 x 480",
    );
}

#[test]
fn the_doctor_knows_a_folder_of_depth_images() {
    let output = Command::from_std(sinew_command()).arg("doctor").arg(scenes().join("depth")).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains(&format!("{FRAMES} clouds")), "{said}");
}
