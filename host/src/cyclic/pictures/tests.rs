use super::animation;
use super::*;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::figures;
use crate::cyclic::tracking::{Tracked, TrackingOptions, track};
use crate::cyclic::{AngleRow, AngleTable, CyclicModel};
use crate::output::OutputDir;
use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The shipped walk; hips at (100 + f, 90), trunk 60 px, the other lengths those of a person of
/// that size; frames from `first` on.
fn keypoints(first: u64, frames: u64, facing: &str) -> AngleTable {
    let model = CyclicModel::from_option("walking").unwrap();
    let columns = ["hip_center_u_px", "hip_center_v_px", "neck_length_px", "facing"].map(str::to_owned);
    let rows = (first..first + frames).map(|frame| {
        let pose = model.view().mean_pose_rad::<ANGLES>(model.view().point(frame as f32 / 60.0));
        let extra = [(100 + frame).to_string(), "90".into(), "60".into(), facing.to_owned()];
        AngleRow { frame, angles_rad: pose.map(|angle| Some(f64::from(angle))), extra: extra.to_vec() }
    });
    AngleTable::new(rows.collect(), columns.to_vec()).unwrap()
}

fn run(table: &AngleTable) -> (Tracked, Vec<crate::cyclic::report::joints::Figure>, Body) {
    let model = CyclicModel::from_option("walking").unwrap();
    let tracked = track(table, &model, &TrackingOptions { rate_hz: Some(60.0), ..TrackingOptions::default() }).unwrap();
    let body = Body::of_table(table, 1.75);
    let figures = figures(table, &tracked, &[1.0; ANGLES], &body, 0.1).unwrap();
    (tracked, figures, body)
}

fn images(folder: &Path, count: usize) {
    for index in 0..count {
        image::RgbImage::from_pixel(240, 220, image::Rgb([90, 110, 90]))
            .save(folder.join(format!("f{index}.png")))
            .unwrap();
    }
}

fn overlaid(folder: &Path, table: &AngleTable) -> (Overlaid, std::path::PathBuf) {
    let (tracked, figures, body) = run(table);
    let output = OutputDir::create(&folder.join("out")).unwrap();
    let mut frames = OverlayFrames::open(&folder.join("in"), 60.0).unwrap();
    let drawn = Drawn { table, tracked: &tracked, figures: &figures, body: &body };
    (frames.draw(&drawn, &output, &AtomicBool::new(false)).unwrap(), folder.join("out"))
}

#[test]
fn the_figure_stands_where_the_person_is_on_the_image_of_its_number() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    images(&folder.path().join("in"), 12);
    for facing in ["right", "left"] {
        let (result, out) = overlaid(folder.path(), &keypoints(4, 8, facing));
        assert_eq!(result, Overlaid { written: 8, skipped: Vec::new() });
        assert!(!out.join("f3.png").exists(), "frame 4 is the first");
        let picture = image::open(out.join("f11.png")).unwrap().into_rgb8();
        // The trunk goes up from the hips, which are at 100 + frame in both directions.
        let light = |u: u32, v: u32| picture.get_pixel(u, v).0.iter().all(|channel| *channel > 200);
        assert!((105..117).any(|u| light(u, 60)), "{facing}");
        let far = picture
            .enumerate_pixels()
            .filter(|(u, v, pixel)| *v > 80 && pixel.0 != [90, 110, 90] && u.abs_diff(111) > 90);
        assert_eq!(far.count(), 0);
    }
}

/// A broken image and rows beyond the last image: reported, and the others are there.
#[test]
fn what_cannot_be_drawn_is_skipped_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("in");
    fs::create_dir(&input).unwrap();
    images(&input, 6);
    fs::write(input.join("f2.png"), b"no picture").unwrap();
    let (result, out) = overlaid(folder.path(), &keypoints(0, 9, "right"));
    assert_eq!(result.written, 5);
    assert_eq!(result.skipped.len(), 2, "{result:?}");
    assert!(result.skipped[0].contains("f2.png"), "{result:?}");
    assert!(result.skipped[1].contains("3 rows have no image"), "{result:?}");
    assert!(out.join("f5.png").exists() && !out.join("f2.png").exists());
    image::RgbImage::new(100, 220).save(input.join("f4.png")).unwrap();
    let message = OverlayFrames::open(&input, 60.0).unwrap_err().to_string();
    assert!(message.contains("100x220"), "{message}");
    assert!(OverlayFrames::open(&folder.path().join("gone"), 60.0).is_err());
}

#[test]
fn a_table_of_angles_alone_has_no_place_in_a_picture() {
    let angles = AngleTable::from_angles(0, &[[Some(0.5); ANGLES]; 3]).unwrap();
    let message = OverlayFrames::check(&angles).unwrap_err().to_string();
    assert!(message.contains("`overlay` needs a table") && message.contains("--animation"), "{message}");
    assert!(OverlayFrames::check(&keypoints(0, 3, "right")).is_ok());
}

/// With places or without: the figure fills the canvas and moves, the measured one shows behind it.
#[test]
fn the_animation_moves_and_shows_what_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let whole = keypoints(0, 61, "right");
    let bare = AngleTable::new(
        whole.rows().iter().map(|row| AngleRow { extra: Vec::new(), ..row.clone() }).collect(),
        Vec::new(),
    );
    for table in [whole, bare.unwrap()] {
        let (tracked, figures, body) = run(&table);
        let path = folder.path().join("walk.gif");
        animation::write(&path, &table, &figures, &body, tracked.rate_hz).unwrap();
        let decoder = GifDecoder::new(BufReader::new(fs::File::open(&path).unwrap())).unwrap();
        let pictures: Vec<_> = decoder.into_frames().collect_frames().unwrap();
        assert_eq!(pictures.len(), 21);
        let coloured = |index: usize| -> Vec<(u32, u32)> {
            let picture = pictures[index].buffer();
            let all = picture.enumerate_pixels().filter(|(_, v, p)| *v > 30 && p[0].abs_diff(p[2]) > 100);
            all.map(|(u, v, _)| (u, v)).collect()
        };
        let (first, half) = (coloured(0), coloured(10));
        assert!(first.len() > 800 && half.len() > 800, "{} {}", first.len(), half.len());
        assert!(half.iter().filter(|place| !first.contains(place)).count() > 100, "it moves");
        let (top, bottom) = (first.iter().map(|p| p.1).min().unwrap(), first.iter().map(|p| p.1).max().unwrap());
        assert!(top < 200 && bottom > 380, "{top} {bottom}");
    }
}
