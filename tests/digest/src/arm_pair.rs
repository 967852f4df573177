//! Two arms, 50 particles each, from made-up blobs and edge pixels.

use super::SEED;
use super::bits::Bits;
use core::f32::consts::TAU;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::error::ParameterError;
use sinew_core::math::{Vec3, sin_cos};
use sinew_core::random::Stream;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::{ArmEstimate, ArmImage, ArmModel, ArmOptions, ArmPair, PairFrame, Status};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;

const PARTICLES: usize = 50;
const SIZE_PX: (u32, u32) = (320, 240);
const FRAME_US: u64 = 66_667;
const SHOULDERS_M: [Vec3; 2] = [Vec3::new(0.19, -0.05, 1.4), Vec3::new(-0.19, -0.05, 1.4)];
/// Blobs: two hands, a face, a distractor, a speck that is not a number.
const BLOBS: usize = 5;
/// Edge pixels of each limb.
const LIMB_EDGES: usize = 40;

/// Elbow and hand of each side, metres.
type Arms = [(Vec3, Vec3); 2];

/// Digest of both arms' estimates.
pub fn digest(frames: u32) -> Result<u64, ParameterError> {
    let mut bits = Bits::new();
    track(frames, |estimates| estimates.iter().for_each(|estimate| take(&mut bits, estimate)))?;
    Ok(bits.digest())
}

/// Tracks both arms and hands on what each frame's answers are.
fn track(frames: u32, mut sink: impl FnMut(&[ArmEstimate; 2])) -> Result<(), ParameterError> {
    let camera = Camera::from_field_of_view(SIZE_PX.0, SIZE_PX.1, TAU / 6.0)?;
    let model = |side| {
        let options = ArmOptions { particles: PARTICLES, ..ArmOptions::default() };
        ArmModel::new(camera, SIZE_PX, ArmGeometry::new(side, 0.30, 0.33)?, options)
    };
    let models = [model(Side::Left)?, model(Side::Right)?];
    let models = [&models[0], &models[1]];
    let mut pair = ArmPair::<PARTICLES>::new(models, SHOULDERS_M, SEED)?;
    let (mut blobs, mut edges) = ([HandCandidate::default(); BLOBS], [EdgePixel::default(); 4 * LIMB_EDGES]);
    for frame in 0..u64::from(frames) {
        let arms = [0, 1].map(|side: usize| {
            let (elbow_m, hand_m) = models[side].elbow_and_hand(&SHOULDERS_M[side], &angles_rad(frame, side));
            (elbow_m, hand_m)
        });
        let mut stream = Stream::new(SEED, frame, 3);
        let blob_count = show_blobs(&camera, &arms, frame, &mut stream, &mut blobs);
        let edge_count = show_edges(&camera, &arms, &mut stream, &mut edges);
        let image = ArmImage { candidates: &blobs[..blob_count], edges: &edges[..edge_count] };
        let image = (!frame.is_multiple_of(37)).then_some(image);
        let timestamp_us = frame * FRAME_US + u64::from(stream.below(3000));
        sink(&pair.step(models, &PairFrame { timestamp_us, image, shoulders_m: SHOULDERS_M }));
    }
    Ok(())
}

/// The true pose of an arm.
fn angles_rad(frame: u64, side: usize) -> [f32; 4] {
    let mut stream = Stream::new(SEED, 0, 4 + side as u32);
    [(0.8, 0.4), (0.2, 0.3), (0.4, 0.4), (1.4, 0.5)].map(|(middle, swing)| {
        let (period, start) = (25.0 + 35.0 * stream.uniform(), TAU * stream.uniform());
        middle + swing * sin_cos(start + TAU * (frame % 4096) as f32 / period).0
    })
}

/// Writes the frame's blobs and returns how many there are.
fn show_blobs(
    camera: &Camera,
    arms: &Arms,
    frame: u64,
    stream: &mut Stream,
    blobs: &mut [HandCandidate; BLOBS],
) -> usize {
    let face_m = Vec3::new(0.0, -0.28, 1.4);
    let wanderer_m = Vec3::new(0.5 * sin_cos(frame as f32 / 40.0).0, 0.3, 1.3);
    let places = [arms[0].1, arms[1].1, face_m, wanderer_m];
    let mut count = 0;
    for (index, place) in places.iter().enumerate() {
        // Each hand is hidden for some time, one after the other.
        let hidden = index < 2 && (60 + 20 * index as u64..80 + 20 * index as u64).contains(&(frame % 150));
        let (Some(centre), false) = (camera.project(place), hidden) else { continue };
        let scale = camera.focal_px() / place.z;
        let (long, short) = (0.05 * scale * (1.0 + 0.1 * stream.normal()), 0.035 * scale);
        let tilt = 0.3 * stream.normal();
        let noise = [0; 2].map(|_| stream.normal());
        let moments_px2 = [long * long, tilt * long * short, short * short];
        let centre = Pixel::new(centre.u_px + noise[0], centre.v_px + noise[1]);
        let likelihood = if index < 3 { 0.9 - 0.3 * stream.uniform() } else { 0.3 * stream.uniform() };
        blobs[count] = HandCandidate { centre, moments_px2, area_px: 12.0 * long * short, likelihood };
        count += 1;
    }
    if frame.is_multiple_of(20) {
        blobs[count] = HandCandidate { likelihood: f32::NAN, area_px: 30.0, ..HandCandidate::default() };
        count += 1;
    }
    count
}

/// Writes edge pixels along the limbs, with noise, and returns how many there are.
fn show_edges(camera: &Camera, arms: &Arms, stream: &mut Stream, edges: &mut [EdgePixel; 4 * LIMB_EDGES]) -> usize {
    let mut count = 0;
    for (shoulder_m, (elbow_m, hand_m)) in SHOULDERS_M.iter().zip(arms) {
        for (from_m, to_m) in [(shoulder_m, elbow_m), (elbow_m, hand_m)] {
            let (Some(from), Some(to)) = (camera.project(from_m), camera.project(to_m)) else { continue };
            for _ in 0..LIMB_EDGES {
                let along = stream.uniform();
                let u = from.u_px + along * (to.u_px - from.u_px) + 4.0 * stream.normal();
                let v = from.v_px + along * (to.v_px - from.v_px) + 4.0 * stream.normal();
                if u >= 0.0 && v >= 0.0 && u < SIZE_PX.0 as f32 && v < SIZE_PX.1 as f32 {
                    edges[count] = EdgePixel { u: u as u16, v: v as u16 };
                    count += 1;
                }
            }
        }
    }
    count
}

fn take(bits: &mut Bits, estimate: &ArmEstimate) {
    bits.word(match estimate.status {
        Status::Uncertain => 3,
        Status::Tracking => 2,
        Status::Predicted => 1,
        Status::Lost => 0,
    });
    bits.present(estimate.side == Side::Left);
    bits.vector(&estimate.joints.shoulder_m);
    bits.vector(&estimate.joints.elbow_m);
    bits.vector(&estimate.joints.hand_m);
    bits.numbers(&estimate.angles_rad);
    bits.numbers(&[estimate.hand_std_m, estimate.effective_sample_size, estimate.log_evidence]);
    bits.present(estimate.degenerate);
    bits.number(estimate.hand_likelihood);
    bits.count(estimate.candidate.map_or(0, |index| index + 1));
    bits.count(estimate.dropped_candidates);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_shows_hands_and_hides_them() {
        let (mut seen, mut predicted) = (0, 0);
        track(300, |estimates| {
            seen += estimates.iter().filter(|estimate| estimate.candidate.is_some()).count();
            predicted += estimates.iter().filter(|estimate| estimate.status == Status::Predicted).count();
        })
        .unwrap();
        assert!(seen > 500 && predicted > 10, "{seen}, {predicted} of 600");
    }
}
