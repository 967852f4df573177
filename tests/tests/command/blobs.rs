//! `sinew blobs` as a user types it.

use assert_cmd::Command;
use image::{Rgb, RgbImage};
use predicates::str::contains;
use serde_json::Value;
use sinew_tests::sinew_command;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Stdio;

fn sinew() -> Command {
    Command::from_std(sinew_command())
}

/// A square of skin with its left upper corner at (`u`, 20) before a blue wall.
fn picture(left: u32) -> RgbImage {
    RgbImage::from_fn(120, 90, |u, v| {
        let skin = (left..left + 30).contains(&u) && (20..50).contains(&v);
        Rgb(if skin { [196, 140, 115] } else { [90, 120, 200] })
    })
}

fn write_folder(folder: &Path) {
    picture(60).save(folder.join("f_10.png")).unwrap();
    picture(20).save(folder.join("f_9.png")).unwrap();
    RgbImage::new(7, 7).save(folder.join("f_11.png")).unwrap();
}

#[test]
fn a_row_for_each_blob_in_natural_order() {
    let folder = tempfile::tempdir().unwrap();
    write_folder(folder.path());
    let output = sinew().arg("blobs").arg(folder.path()).assert().success().get_output().stdout.clone();
    let mut reader = csv::Reader::from_reader(&output[..]);
    let headers = reader.headers().unwrap().clone();
    let column = |name: &str| headers.iter().position(|header| header == name).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.iter().map(|row| &row[0]).collect::<Vec<_>>(), ["f_9.png", "f_10.png"]);
    let number = |row: usize, name: &str| rows[row][column(name)].parse::<f64>().unwrap();
    assert_eq!((number(0, "area_px"), number(0, "left_px"), number(0, "width_px")), (900.0, 20.0, 30.0));
    assert!((number(1, "centroid_u_px") - number(0, "centroid_u_px") - 40.0).abs() < 1.0e-3);
    assert!((0.0..=1.0).contains(&number(0, "hand_likelihood")) && number(0, "hand_likelihood") > 0.0);
}

#[test]
fn json_and_csv_hold_the_same_and_can_go_to_a_file() {
    let folder = tempfile::tempdir().unwrap();
    write_folder(folder.path());
    let out = folder.path().join("tables/blobs.json");
    sinew().arg("blobs").arg(folder.path()).args(["--format", "json", "--out"]).arg(&out).assert().success().stdout("");
    let rows: Value = serde_json::from_str(&fs::read_to_string(&out).unwrap()).unwrap();
    assert_eq!(rows.as_array().unwrap().len(), 2);
    assert_eq!((&rows[1]["image"], &rows[1]["area_px"]), (&"f_10.png".into(), &900.into()));
}

#[test]
fn an_image_without_skin_gives_a_header_only() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("black.png");
    RgbImage::new(40, 30).save(&image).unwrap();
    let output = sinew().arg("blobs").arg(&image).assert().success().get_output().stdout.clone();
    assert_eq!(String::from_utf8(output).unwrap().lines().count(), 1);
}

#[test]
fn bad_input_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    sinew().arg("blobs").arg(folder.path()).assert().code(65).stderr(contains("is empty"));
    fs::write(folder.path().join("a.png"), b"no picture").unwrap();
    sinew().arg("blobs").arg(folder.path()).assert().code(65).stderr(contains("a.png"));
    sinew().arg("blobs").arg(folder.path()).args(["--format", "xml"]).assert().code(64);
}

#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    // More than a pipe holds: hundreds of small blobs an image.
    let dots = RgbImage::from_fn(400, 400, |u, v| {
        Rgb(if u % 20 < 12 && v % 20 < 12 { [196, 140, 115] } else { [90, 120, 200] })
    });
    for number in 0..8 {
        dots.save(folder.path().join(format!("{number}.png"))).unwrap();
    }
    let mut child =
        sinew_command().arg("blobs").arg(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut byte = [0];
    child.stdout.take().unwrap().read_exact(&mut byte).unwrap();
    let mut errors = String::new();
    child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    assert!(child.wait().unwrap().success() && !errors.contains("panicked"), "{errors}");
}
