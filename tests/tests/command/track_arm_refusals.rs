//! What `sinew track arm` refuses: with what is wrong, where, and the remedy, and before anything
//! is written.

use assert_cmd::Command;
use image::{Rgb, RgbImage};
use sinew_tests::sinew_command;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder with three small frames beside a place for the output.
struct Scene {
    root: TempDir,
}

impl Scene {
    fn new() -> Self {
        let scene = Self { root: tempfile::tempdir().unwrap() };
        fs::create_dir(scene.path("in")).unwrap();
        (0..3).for_each(|frame| scene.frame(&format!("in/{frame}.png"), 32, 24));
        scene
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    fn frame(&self, name: &str, width: u32, height: u32) {
        RgbImage::from_pixel(width, height, Rgb([90, 120, 200])).save(self.path(name)).unwrap();
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Expects `sinew track arm INPUT --out out WORDS` to fail with all of `parts` in its message,
    /// and to write nothing.
    fn refuses(&self, input: &str, words: &[&str], parts: &[&str]) {
        let mut command = Command::from_std(sinew_command());
        command.current_dir(self.root.path()).args(["track", "arm", input]).args(words);
        if !words.contains(&"--out") {
            command.args(["--out", "out"]);
        }
        let output = command.output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(64..=66 | 73)), "{words:?}: {:?}: {message}", output.status);
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
        assert!(!message.contains("panicked"), "{message}");
        assert!(!self.path("out").exists(), "{words:?} left an output folder");
    }
}

#[test]
fn a_missing_folder() {
    Scene::new().refuses("nowhere", &[], &["`nowhere`", "no such folder", "give a folder"]);
}

#[test]
fn an_empty_folder() {
    let scene = Scene::new();
    fs::create_dir(scene.path("empty")).unwrap();
    scene.refuses("empty", &[], &["`empty` is empty", ".png"]);
}

#[test]
fn a_folder_without_an_image() {
    let scene = Scene::new();
    fs::create_dir(scene.path("texts")).unwrap();
    scene.write("texts/a.txt", "");
    scene.refuses("texts", &[], &["holds no image", "*.txt"]);
}

#[test]
fn a_file_in_place_of_the_folder() {
    Scene::new().refuses("in/0.png", &[], &["`in/0.png` is not a folder", "give the folder"]);
}

#[test]
fn a_folder_with_no_readable_image() {
    let scene = Scene::new();
    fs::create_dir(scene.path("broken")).unwrap();
    let bytes = fs::read(scene.path("in/0.png")).unwrap();
    fs::write(scene.path("broken/0.png"), &bytes[..bytes.len() - 20]).unwrap();
    scene.refuses("broken", &[], &["no image in `broken` can be read", "0.png"]);
    scene.write("broken/1.png", "text");
    scene.refuses("broken", &[], &["no image in `broken` can be read", "0.png"]);
}

#[test]
fn frames_of_different_sizes() {
    let scene = Scene::new();
    scene.frame("in/1.png", 24, 32);
    scene.frame("in/2.png", 99, 99);
    scene.refuses("in", &[], &["1.png` has 24x32", "0.png` has 32x24", "one size"]);
}

#[test]
fn an_unknown_key_with_the_nearest_right_one() {
    let scene = Scene::new();
    scene.write("c.toml", "[tracker]\nparticels = 9\n");
    scene.refuses("in", &["--config", "c.toml"], &["`c.toml`", "tracker.particels", "tracker.particles"]);
}

#[test]
fn a_configuration_that_is_missing_or_no_toml_or_out_of_range() {
    let scene = Scene::new();
    scene.refuses("in", &["--config", "no.toml"], &["`no.toml` cannot be read", "--print-config"]);
    scene.write("c.toml", "[tracker\n");
    scene.refuses("in", &["--config", "c.toml"], &["`c.toml`", "not valid TOML"]);
    scene.write("c.toml", "[tracker]\nparticles = 0\n");
    scene.refuses("in", &["--config", "c.toml"], &["`c.toml`", "`particles` must lie from 1 to 5000"]);
    scene.write("c.toml", "[body]\nheight_m = 40.0\n");
    scene.refuses("in", &["--config", "c.toml"], &["`c.toml`", "`height_m` must lie from"]);
}

#[test]
fn the_configuration_of_another_camera() {
    let scene = Scene::new();
    scene.write("c.toml", "[camera]\nwidth_px = 640\nheight_px = 480\n");
    scene.refuses("in", &["--config", "c.toml"], &["32 x 24", "640", "leave the size out"]);
}

#[test]
fn numbers_of_particles_out_of_range() {
    for count in ["0", "-3", "5001", "2.5", "many"] {
        Scene::new().refuses("in", &["--particles", count], &["--particles", "from 1 to 5000", count]);
    }
}

#[test]
fn rates_out_of_range() {
    for rate in ["0", "-15", "nan", "inf", "1e9", "fast"] {
        Scene::new().refuses("in", &["--rate", rate], &["--rate", "from 0.001 to 10000 Hz", rate]);
    }
}

#[test]
fn words_that_are_no_choice() {
    Scene::new().refuses("in", &["--variant", "pic"], &["--variant", "pik"]);
    Scene::new().refuses("in", &["--side", "middle"], &["--side", "both"]);
    Scene::new().refuses("in", &["--seed", "-1"], &["-1"]);
}

#[test]
fn a_skin_model_that_is_none() {
    let scene = Scene::new();
    scene.write("model.json", "{}");
    scene.refuses("in", &["--skin", "model.json"], &["`model.json`", "sinew train skin"]);
    scene.refuses("in", &["--skin", "in/0.png"], &["`in/0.png`", "sinew train skin"]);
    scene.refuses("in", &["--skin", "gausian"], &["gausian", "gaussian, histogram"]);
}

#[test]
fn a_calibration_rectangle_outside_of_the_image() {
    let scene = Scene::new();
    scene.refuses("in", &["--calibrate", "30,0,9,9"], &["30,0,9,9", "32x24"]);
    scene.refuses("in", &["--calibrate", "1,2,0,4"], &["--calibrate", "at least 1"]);
    scene.write("in/0.png", "no image");
    scene.refuses("in", &["--calibrate", "0,0,9,9"], &["0.png", "--calibrate needs the first image"]);
}

#[test]
fn an_unreadable_image_if_strict() {
    let scene = Scene::new();
    let bytes = fs::read(scene.path("in/1.png")).unwrap();
    fs::write(scene.path("in/1.png"), &bytes[..bytes.len() - 20]).unwrap();
    scene.refuses("in", &["--strict"], &["1.png", "1 of 3 images", "--strict"]);
}

#[test]
fn an_output_that_cannot_be_written() {
    let scene = Scene::new();
    scene.write("file", "");
    scene.refuses("in", &["--out", "file"], &["`file` is a file", "give a folder"]);
    scene.refuses("in", &["--out", "file/inside"], &["file/inside", "cannot be created"]);
}

#[test]
fn an_output_among_the_frames() {
    let scene = Scene::new();
    scene.refuses("in", &["--out", "in"], &["among the frames", "another --out"]);
    fs::create_dir(scene.path("run")).unwrap();
    fs::rename(scene.path("in"), scene.path("run/overlay")).unwrap();
    scene.refuses("run/overlay", &["--out", "run", "--overlay"], &["among the frames", "another --out"]);
    assert_eq!(fs::read_dir(scene.path("run/overlay")).unwrap().count(), 3);
}

#[test]
fn no_folder_and_no_output() {
    let output = sinew_command().args(["track", "arm"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(64));
    assert!(message.contains("<FOLDER|VIDEO>") && message.contains("--out"), "{message}");
}
