//! `sinew segment` as a user types it.

use assert_cmd::Command;
use image::{GrayImage, Rgb, RgbImage};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::{shared_data, sinew_command};
use std::fs;
use std::path::Path;

fn sinew() -> Command {
    Command::from_std(sinew_command())
}

/// A square of skin before a blue wall.
fn picture(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |u, v| {
        let skin = (10..30).contains(&u) && (10..30).contains(&v);
        Rgb(if skin { [196, 140, 115] } else { [90, 120, 200] })
    })
}

fn skin_pixels(mask: &Path) -> usize {
    let mask: GrayImage = image::open(mask).unwrap().into_luma8();
    assert!(mask.pixels().all(|pixel| [0, 255].contains(&pixel.0[0])));
    mask.pixels().filter(|pixel| pixel.0[0] == 255).count()
}

#[test]
fn masks_of_images_of_different_sizes_and_formats() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    picture(50, 40).save(input.join("a.png")).unwrap();
    picture(64, 64).save(input.join("b.ppm")).unwrap();
    RgbImage::new(1, 1).save(input.join("dot.png")).unwrap();
    fs::rename(input.join("a.png"), input.join("a.PNG")).unwrap();
    for skin in ["gaussian", "histogram"] {
        sinew().arg("segment").arg(&input).arg("--out").arg(&out).args(["--skin", skin]).assert().success();
        for (name, expected) in [("a.png", 400), ("b.png", 400), ("dot.png", 0)] {
            assert_eq!(skin_pixels(&out.join(name)), expected, "{skin}, {name}");
        }
        assert_eq!(fs::read_dir(&out).unwrap().count(), 3, "no temporary file stays");
    }
}

#[test]
fn stems_of_one_spelling_do_not_overwrite_each_other() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    picture(50, 40).save(input.join("a.png")).unwrap();
    RgbImage::new(50, 40).save(input.join("A.ppm")).unwrap();
    let run = || sinew().arg("segment").arg(&input).arg("--out").arg(&out).assert();
    run().success().stderr(contains("shares its stem"));
    assert_eq!((skin_pixels(&out.join("a.png.png")), skin_pixels(&out.join("A.ppm.png"))), (400, 0));
    RgbImage::new(50, 40).save(input.join("a.ppm")).unwrap();
    run().code(65).stderr(contains("holds `a.png` and `a.ppm`"));
}

#[test]
fn unreadable_images_are_skipped_named_and_counted() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    picture(50, 40).save(input.join("a.png")).unwrap();
    fs::write(input.join("b.png"), b"no picture").unwrap();
    let run = |path: &Path, more: &[&str]| sinew().arg("segment").arg(path).arg("--out").arg(&out).args(more).assert();
    run(&input, &[]).success().stderr(contains("b.png").and(contains("1 of 2 images were skipped")));
    assert_eq!(skin_pixels(&out.join("a.png")), 400);
    run(&input, &["--strict"]).code(65).stderr(contains("b.png"));
    run(&input.join("b.png"), &[]).code(65).stderr(contains("b.png"));
}

/// A file that the operating system opens and does not let be read.
#[cfg(target_os = "linux")]
fn unreadable(path: &Path) {
    std::os::unix::fs::symlink("/proc/self/mem", path).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_the_system_refuses_loses_no_other() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    for name in ["a.png", "c.png"] {
        picture(50, 40).save(input.join(name)).unwrap();
    }
    unreadable(&input.join("b.png"));
    let run = |command: &str, more: &[&str]| {
        sinew().arg(command).arg(&input).arg("--out").arg(out.join(command)).args(more).assert()
    };
    let named = || contains("b.png").and(contains("what could be read is written"));
    run("segment", &[]).code(74).stderr(named()).stdout(contains("2 masks written"));
    assert_eq!(["a.png", "c.png"].map(|name| skin_pixels(&out.join("segment").join(name))), [400, 400]);
    run("blobs", &[]).code(74).stderr(named());
    let table = fs::read_to_string(out.join("blobs")).unwrap();
    assert!(table.contains("\na.png,") && table.contains("\nc.png,"), "{table}");
    run("segment", &["--strict"]).code(74).stderr(contains("b.png"));
}

#[test]
fn grey_pictures_are_called_grey() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    fs::create_dir(&input).unwrap();
    for number in 0..8 {
        image::DynamicImage::from(picture(64, 64)).into_luma8().save(input.join(format!("f_{number}.png"))).unwrap();
    }
    for command in ["segment", "blobs"] {
        let run = sinew().arg(command).arg(&input).arg("--out").arg(out.join(command)).assert().success();
        run.stderr(contains("8 of 8 pictures are grey; skin is found by its colour; give pictures"));
    }
    let run = sinew().args(["track", "arm"]).arg(&input).arg("--out").arg(out.join("arm")).assert().success();
    run.stdout(contains("8 of 8 frames are grey; skin is found by its colour"));
    sinew().arg("doctor").arg(&input).assert().stdout(contains("the images are grey"));
}

#[test]
fn bad_input_is_refused_with_the_reason() {
    let root = tempfile::tempdir().unwrap();
    let (input, out) = (root.path().join("in"), root.path().join("out"));
    let run = |path: &Path, more: &[&str]| sinew().arg("segment").arg(path).arg("--out").arg(&out).args(more).assert();
    run(&input, &[]).code(66).stderr(contains("no such folder"));
    fs::create_dir(&input).unwrap();
    run(&input, &[]).code(65).stderr(contains("is empty"));
    fs::write(input.join("notes.txt"), b"x").unwrap();
    run(&input, &[]).code(65).stderr(contains("*.txt").and(contains(".png")));
    picture(50, 40).save(input.join("a.png")).unwrap();
    run(&input, &["--skin", "nowhere.json"]).code(65).stderr(contains("sinew train skin"));
    let notes = input.join("notes.txt");
    run(&input, &["--skin", notes.to_str().unwrap()]).code(65).stderr(contains("cannot be used as a skin model"));
    run(&input, &["--calibrate", "1,2,3"]).code(64).stderr(contains("X,Y,W,H"));
    run(&input, &["--calibrate", "45,0,10,10"]).code(65).stderr(contains("50x40"));
    sinew().arg("segment").arg(&input).arg("--out").arg(&notes).assert().code(73).stderr(contains("is a file"));
    sinew().arg("segment").arg(&input).arg("--out").arg(&input).assert().code(64).stderr(contains("overwrite"));
}

#[test]
fn a_calibration_finds_skin_in_coloured_light() {
    let root = tempfile::tempdir().unwrap();
    let image = root.path().join("a.png");
    let mut bluish = picture(50, 40);
    for pixel in bluish.pixels_mut().filter(|pixel| pixel.0 == [196, 140, 115]) {
        pixel.0 = [120, 105, 140];
    }
    bluish.save(&image).unwrap();
    for skin in ["gaussian", "histogram"] {
        let out = root.path().join(skin);
        let run = |more: &[&str]| {
            sinew()
                .arg("segment")
                .arg(&image)
                .arg("--out")
                .arg(&out)
                .args(["--skin", skin])
                .args(more)
                .assert()
                .success();
            skin_pixels(&out.join("a.png"))
        };
        assert_eq!(run(&[]), 0, "{skin}");
        assert_eq!(run(&["--calibrate", "12,12,16,16"]), 400, "{skin}");
    }
}

/// The hands of the webcam sequence are found and the beige couch behind them is not.
#[test]
fn webcam_hands_and_couch() {
    let Some(frames) = shared_data("video/handtracking/hand2") else { return };
    let out = tempfile::tempdir().unwrap();
    sinew().arg("segment").arg(&frames).arg("--out").arg(out.path()).assert().success();
    let mask = image::open(out.path().join("frame_0020.png")).unwrap().into_luma8();
    let share = |x: u32, y: u32, w: u32, h: u32| {
        let pixels = (y..y + h).flat_map(|v| (x..x + w).map(move |u| (u, v)));
        pixels.filter(|&(u, v)| mask.get_pixel(u, v).0[0] == 255).count() as f64 / f64::from(w * h)
    };
    assert!(share(370, 175, 60, 30) > 0.6, "back of the right hand: {}", share(370, 175, 60, 30));
    assert!(share(510, 40, 80, 140) < 0.1, "couch: {}", share(510, 40, 80, 140));
    assert!(share(20, 260, 560, 150) < 0.01, "table: {}", share(20, 260, 560, 150));
}
