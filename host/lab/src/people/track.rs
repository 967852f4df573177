//! Tracks both arms through pictures as `sinew track arm --side both` does.

use super::changes::{Change, SEATED_SHARE, chroma_about};
use super::clips::{RATE_HZ, pictures, reference};
use super::reference::{Palm, Reference};
use super::score::HandScore;
use anyhow::Result;
use image::RgbImage;
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew::track::{ArmStream, SideChoice, StreamFrame, StreamOptions};
use sinew_core::camera::Pixel;
use sinew_core::tracker::arm::Status;
use std::path::Path;

/// Where the hands of both arms are that say `tracking`, left first.
pub type SureHands = [Option<Pixel>; 2];

/// Tracks through `frames` pictures; `picture` gives each.
///
/// # Errors
/// The tracker refuses a picture.
pub fn track<'p>(frames: usize, picture: impl Fn(usize) -> &'p RgbImage) -> Result<Vec<SureHands>> {
    let options = StreamOptions { side: SideChoice::Both, rate_hz: RATE_HZ, ..StreamOptions::default() };
    let mut stream = ArmStream::new(options, SkinModel::from_option(DEFAULT_SKIN)?, picture(0).dimensions())?;
    (0..frames)
        .map(|number| {
            let timestamp_us = (number as f64 * 1.0e6 / RATE_HZ).round() as u64;
            let image = Some(picture(number));
            let answer = stream.step(StreamFrame { number, timestamp_us, image, hands: None, head: None })?;
            Ok(core::array::from_fn(|arm| {
                let estimate = &answer.arms.get(arm)?.estimate;
                let hand = stream.camera().project(&estimate.joints.hand_m);
                hand.filter(|_| estimate.status == Status::Tracking)
            }))
        })
        .collect()
}

/// Scores of a clip after `change`: all its frames, those with both hands together, and those with
/// a hand in front of the face.
///
/// # Errors
/// Clip or reference cannot be read.
pub fn score(clip: &Path, change: Change) -> Result<[HandScore; 3]> {
    let (recorded, mut reference) = (pictures(clip)?, reference(clip)?);
    if change == Change::Seated {
        let rows = recorded.first().map_or(0.0, |picture| SEATED_SHARE * picture.height() as f32);
        reference = reference.into_iter().map(|frame| frame.above(rows)).collect();
    }
    let chroma = face_chroma(&recorded, &reference);
    let changed: Vec<RgbImage> = recorded.iter().map(|picture| change.of(picture, chroma)).collect();
    let hands = track(changed.len(), |frame| &changed[frame])?;
    let mut scores = [HandScore::default(); 3];
    for (hands, reference) in hands.into_iter().zip(&reference) {
        scores[0].add(reference, hands);
        let palms: Vec<Palm> = reference.palms().collect();
        if let [first, second] = palms.as_slice()
            && first.distance(second.centre) < 1.0
        {
            scores[1].add(reference, hands);
        }
        if palms.iter().any(|palm| reference.is_on_face(palm.centre)) {
            scores[2].add(reference, hands);
        }
    }
    Ok(scores)
}

/// Chroma of the first face that the reference has.
fn face_chroma(recorded: &[RgbImage], reference: &[Reference]) -> [f32; 2] {
    let faces = recorded.iter().zip(reference);
    let mut found = faces.filter_map(|(picture, frame)| {
        let (nose, ears_px) = (frame.point("nose")?, frame.ears_px()?);
        Some(chroma_about(picture, (nose.u_px as u32, nose.v_px as u32), (0.25 * ears_px) as u32))
    });
    found.next().unwrap_or_default()
}

/// Scores of a clip that goes forwards and backwards over again: its first `part` frames of
/// `frames`, and the last ones.
///
/// # Errors
/// Clip or reference cannot be read.
pub fn score_at_length(clip: &Path, frames: usize, part: usize) -> Result<[HandScore; 2]> {
    let (recorded, reference) = (pictures(clip)?, reference(clip)?);
    let count = recorded.len().min(reference.len());
    let turn = 2 * count.saturating_sub(1).max(1);
    let frame_of = |number: usize| {
        let along = number % turn;
        if along < count { along } else { turn - along }
    };
    let hands = track(frames, |number| &recorded[frame_of(number)])?;
    let mut scores = [HandScore::default(); 2];
    for (number, hands) in hands.into_iter().enumerate() {
        if number < part {
            scores[0].add(&reference[frame_of(number)], hands);
        }
        if number + part >= frames {
            scores[1].add(&reference[frame_of(number)], hands);
        }
    }
    Ok(scores)
}
