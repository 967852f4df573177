//! Runs of `sinew track arm` and `sinew demo`: frames, blobs, arms, particles.

use super::marks::{Shown, colour, jpeg, scalars, weighted_points};
use super::numbers::Numbers;
use super::recording::{Moment, Recording};
use crate::error::Result;
use crate::frames::FrameReader;
use crate::record::SeenFrames;
use crate::track::{FrameFolder, FrameSource};
use re_sdk_types::archetypes::{Clear, EncodedImage, LineStrips2D, LineStrips3D, Pinhole, Points2D, ViewCoordinates};
use serde_json::Value;
use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::path::Path;

/// The camera; what it sees lies below.
pub const CAMERA: &str = "world/camera";
/// A pixel's centre is (0, 0) here and (0.5, 0.5) in the viewer.
const HALF_PX: f32 = 0.5;
/// Columns that are plotted.
const PLOTTED: [&str; 5] = ["hand_likelihood", "effective_sample_size", "log_evidence", "hand_std_m", "hand_z_m"];
/// Colour of blobs, red, green, blue, opacity.
const BLOB: u32 = 0xffd700a0;
const JOINTS: [&str; 3] = ["shoulder", "elbow", "hand"];

/// Writes the run in `folder`.
pub(super) fn write(folder: &Path, report: &Value, recording: &mut Recording<'_>) -> Result<Shown> {
    let track = Numbers::read(&folder.join("track.csv"), |_| true)?;
    let frames: BTreeMap<i64, Moment> = (0..track.len())
        .filter_map(|row| {
            let frame = track.frame(row)?;
            Some((frame, Moment { frame, time_s: track.get(row, "time_s")? }))
        })
        .collect();
    let mut shown = Shown { frames: frames.len(), ..Shown::default() };
    recording.constant("world", &ViewCoordinates::RDF())?;
    match SeenFrames::open(&report["options"]) {
        Ok(seen) => match &seen.frames {
            FrameSource::Folder(images) => pictures(&seen, images, &frames, recording)?,
            // They would have to be kept, since they are looked at twice.
            FrameSource::Video(_) => shown.notes.push(
                "no pictures and no blobs: a video was tracked; `ffmpeg -i VIDEO FOLDER/%06d.png`, then track FOLDER"
                    .to_owned(),
            ),
        },
        Err(error) => shown.notes.push(format!("no pictures and no blobs: {}", error.chain())),
    }
    for side in track.distinct_sides() {
        arm(&track, &side, &frames, recording)?;
        for column in PLOTTED {
            let of_side = (0..track.len()).filter(|&row| track.side(row) == side);
            let values = of_side.filter_map(|row| Some((*frames.get(&track.frame(row)?)?, track.get(row, column)?)));
            scalars(recording, &format!("plots/{column}/{side}"), values)?;
        }
    }
    let particles = folder.join("particles.csv");
    if particles.is_file() {
        let wanted = ["frame", "weight", "hand_x_m", "hand_y_m", "hand_z_m"];
        let particles = Numbers::read(&particles, |name| wanted.contains(&name))?;
        weighted_points(&particles, "hand", &frames, recording)?;
    } else {
        shown.notes.push("no particles: track with --particles-csv".to_owned());
    }
    Ok(shown)
}

/// The camera, its frames, and what was found in them by the vision that the tracker had.
fn pictures(
    seen: &SeenFrames,
    images: &FrameFolder,
    frames: &BTreeMap<i64, Moment>,
    recording: &mut Recording<'_>,
) -> Result<()> {
    let (width_px, height_px) = images.size_px();
    let camera = seen.config.camera.build(width_px, height_px)?;
    let (focal, centre) = (camera.focal_px(), camera.centre());
    let columns = [[focal, 0.0, 0.0], [0.0, focal, 0.0], [centre.u_px + HALF_PX, centre.v_px + HALF_PX, 1.0]];
    recording.constant(CAMERA, &Pinhole::new(columns).with_resolution([width_px as f32, height_px as f32]))?;

    let entity = format!("{CAMERA}/frame");
    let in_folder = |frame: i64| usize::try_from(frame).ok().filter(|&frame| frame < images.files().len());
    let loaded = |frame: i64| in_folder(frame).and_then(|frame| images.load(frame).ok()?.ok());
    let mut missing = Vec::new();
    let pictures = frames.values().filter_map(|&moment| {
        let Some(image) = loaded(moment.frame) else {
            missing.push(moment);
            return None;
        };
        Some((moment, jpeg(&image).map(|bytes| EncodedImage::new(bytes).with_media_type("image/jpeg"))))
    });
    recording.rows(&entity, pictures)?;
    // Without this the viewer would go on to show the picture before.
    recording.rows(&entity, missing.into_iter().map(|moment| (moment, Ok(Clear::new(true)))))?;

    let mut reader = FrameReader::new(seen.config.likelihood.build()?, seen.config.edges.build()?)?;
    let blobs = frames.values().map(|&moment| {
        let Some(image) = loaded(moment.frame) else {
            reader.forget_last_frame();
            return (moment, Ok(Points2D::new(std::iter::empty::<[f32; 2]>())));
        };
        let points = reader.read(&image, &seen.skin).map(|view| {
            let blobs = &view.candidates;
            Points2D::new(blobs.iter().map(|blob| [blob.centre.u_px + HALF_PX, blob.centre.v_px + HALF_PX]))
                .with_radii(blobs.iter().map(|blob| (blob.area_px / PI).sqrt()))
                .with_labels(blobs.iter().map(|blob| format!("{:.2}", blob.likelihood)))
                .with_colors(blobs.iter().map(|_| BLOB))
        });
        (moment, points)
    });
    recording.rows(&format!("{CAMERA}/blobs"), blobs)
}

/// An arm in the image and in space.
fn arm(track: &Numbers, side: &str, frames: &BTreeMap<i64, Moment>, recording: &mut Recording<'_>) -> Result<()> {
    let rows = || {
        let of_side = (0..track.len()).filter(move |&row| track.side(row) == side);
        of_side.filter_map(|row| Some((row, *frames.get(&track.frame(row)?)?)))
    };
    let in_image = rows().map(|(row, moment)| {
        let places = JOINTS.map(|joint| track.place(row, joint, ["u_px", "v_px"]));
        let strip: Vec<[f32; 2]> = places.into_iter().flatten().map(|place| place.map(|px| px + HALF_PX)).collect();
        (moment, Ok(LineStrips2D::new([strip]).with_colors([colour(side)]).with_radii([2.0_f32])))
    });
    recording.rows(&format!("{CAMERA}/arm/{side}"), in_image)?;
    let in_space = rows().map(|(row, moment)| {
        let places = JOINTS.map(|joint| track.place(row, joint, ["x_m", "y_m", "z_m"]));
        let strip: Vec<[f32; 3]> = places.into_iter().flatten().collect();
        (moment, Ok(LineStrips3D::new([strip]).with_colors([colour(side)]).with_radii([0.015_f32])))
    });
    recording.rows(&format!("world/arm/{side}"), in_space)
}
